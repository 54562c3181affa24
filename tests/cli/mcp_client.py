"""mcp_client.py CAG: a client of the Model Context Protocol that tries `cag mcp`, in a folder with scripts of its own.

Prints a line for each check that fails, and `N checks, N failed`. The exit status is 1 if any fails.
"""
import base64
import json
import math
import os
import queue
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

CAG = os.path.abspath(sys.argv[1])
LONGEST = 60  # seconds to wait for an answer; the machine may be busy
checks = failed = 0


def check(what, good):
    global checks, failed
    checks += 1
    if not good:
        failed += 1
        print("FAILED:", what)


class Server:
    def __init__(self, *options, version="2025-06-18"):
        self.process = subprocess.Popen([CAG, "mcp", *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.lines = queue.Queue()
        self.seen = []
        self.number = 0
        threading.Thread(target=self.read, daemon=True).start()
        if version:
            self.opening = self.ask("initialize", {"protocolVersion": version, "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}})
            self.notify("notifications/initialized")

    def read(self):
        for line in self.process.stdout:
            self.lines.put(line)
        self.lines.put(None)

    def write(self, data):
        self.process.stdin.write(data if isinstance(data, bytes) else data.encode())
        self.process.stdin.flush()

    def send(self, message):
        self.write(json.dumps(message) + "\n")

    def next(self):
        line = self.lines.get(timeout=LONGEST)
        if line is None:
            return None
        return json.loads(line)

    def answer(self, number):
        """The answer to a request; other messages are kept in `seen`."""
        while True:
            m = self.next()
            if m is None or (isinstance(m, dict) and m.get("id") == number and "method" not in m):
                return m
            self.seen.append(m)

    def request(self, method, params=None, number=None):
        self.number += 1
        number = number or self.number
        m = {"jsonrpc": "2.0", "id": number, "method": method}
        if params is not None:
            m["params"] = params
        self.send(m)
        return number

    def ask(self, method, params=None):
        return self.answer(self.request(method, params))

    def notify(self, method, params=None):
        m = {"jsonrpc": "2.0", "method": method}
        if params is not None:
            m["params"] = params
        self.send(m)

    def call(self, tool, **arguments):
        return self.ask("tools/call", {"name": tool, "arguments": arguments})

    def result(self, tool, **arguments):
        return self.call(tool, **arguments).get("result", {})

    def raw(self, data):
        self.write(data)
        return self.next()

    def close(self):
        self.process.stdin.close()
        status = self.process.wait(timeout=LONGEST)
        error = self.process.stderr.read().decode()
        check("nothing is written to standard error: " + error[:300], error == "")
        return status


def code(m):
    return m.get("error", {}).get("code")


def texts(result):
    return "\n".join(c["text"] for c in result.get("content", []) if c["type"] == "text")


def pictures(result):
    return [base64.b64decode(c["data"], validate=True) for c in result["content"] if c["type"] == "image" and c["mimeType"] == "image/png"]


def size(png):
    return struct.unpack(">II", png[16:24]) if png[:8] == b"\x89PNG\r\n\x1a\n" else None


def valid(value, schema):
    """Whether a value fulfils a schema, as far as the tools' schemas go."""
    kinds = {"string": str, "number": (int, float), "integer": int, "boolean": bool, "object": dict, "array": list}
    return isinstance(value, kinds[schema["type"]])


def lifecycle():
    s = Server(version=None)
    check("ping works before initialization", s.ask("ping") == {"jsonrpc": "2.0", "id": 1, "result": {}})
    for asked, given in [("2025-06-18", "2025-06-18"), ("2025-03-26", "2025-03-26"), ("2024-11-05", "2024-11-05"),
                         ("2099-01-01", "2025-06-18"), ("nonsense", "2025-06-18")]:
        r = s.ask("initialize", {"protocolVersion": asked, "capabilities": {}, "clientInfo": {"name": "t", "version": "1"}})["result"]
        check(f"revision {asked}", r["protocolVersion"] == given)
    check("the server has tools", "tools" in r["capabilities"] and r["serverInfo"]["name"] == "cag" and r["instructions"])
    check("initialization needs a version", code(s.ask("initialize", {})) == -32602)
    s.notify("notifications/initialized")
    tools = s.ask("tools/list")["result"]["tools"]
    check("the tools", [t["name"] for t in tools] == ["check", "run", "views", "section", "measure", "documentation", "examples"])
    for t in tools:
        schema = t["inputSchema"]
        check(f"schema of {t['name']}", schema["type"] == "object" and all(p["description"] for p in schema["properties"].values()))
        check(f"required arguments of {t['name']}", set(schema.get("required", [])) <= set(schema["properties"]))
    s.send({"jsonrpc": "2.0", "id": "a text", "method": "ping"})
    check("an id may be a text", s.next() == {"jsonrpc": "2.0", "id": "a text", "result": {}})
    check("the end of the input ends the server", s.close() == 0)


def scripts():
    s = Server()
    r = s.result("run", text="param n = 3 in 1..9\nprint n * n\nb = sphere(n)\nshow b", params={"n": 4})
    c = r.get("structuredContent", {})
    check("run", r.get("isError") is False and c["output"] == "16\n" and c["status"] == "ok" and c["shown"] == ["b: sphere, radius 4"])
    check("the output is text, too", "16" in texts(r))
    r = s.result("run", file="vase.cag", params={"height": 50, "wide": True, "word": "hello"})
    check("params of each type", r["structuredContent"]["output"] == "50 true hello\n")
    r = s.result("run", file="parts/uses.cag")
    check("imports", r["structuredContent"]["output"] == "7\n")
    r = s.result("run", text="show sphere(0)\n")
    d = r["structuredContent"]["diagnostics"][0]
    check("an error of a script", r["isError"] and d["severity"] == "error" and d["line"] == 1 and d["code"] == "E0314" and d["message"] in texts(r))
    r = s.result("run", text="print 1\nassert false, \"no\"")
    check("what is printed before an error", r["isError"] and r["structuredContent"]["output"] == "1\n")
    r = s.result("run", file="vase.cag", params={"heigt": 1})
    check("an unknown param", r["isError"] and "heigt" in texts(r))
    r = s.result("check", text="show spher(1)\nprint 1 +")
    check("check finds errors", r["isError"] and "did you mean `sphere`?" in texts(r) and len(r["structuredContent"]["diagnostics"]) >= 1)
    r = s.result("check", text="show sphere(1)")
    check("check finds none", not r["isError"] and r["structuredContent"]["diagnostics"] == [])
    r = s.result("run", text="for_all = [for i in 0..100000: i]\nprint [for i in 0..2: for_all]")
    check("much output is cut", len(r["structuredContent"]["output"]) <= 256 * 1024 and r["structuredContent"]["truncated"])
    r = s.result("measure", text="ball = sphere(3)\nshow box(1)", name="ball")
    part = r["structuredContent"]["parts"][0]
    check("measure", math.isclose(part["volume"], 36 * math.pi, rel_tol=1e-14) and part["watertight"] and json.loads(texts(r))["parts"][0] == part)
    check("measure: an unknown name", s.result("measure", text="a = 1", name="b")["isError"])
    check("the server ends", s.close() == 0)


def drawings():
    s = Server()
    r = s.result("views", file="vase.cag", width=96, height=64)
    check("views", [size(p) for p in pictures(r)] == [(96, 64)] * 4 and r["structuredContent"]["views"] == ["iso", "front", "top", "right"])
    same = s.result("views", file="vase.cag", width=96, height=64, views=["front"])
    check("a view is that of the list", pictures(same)[0] == pictures(r)[1])
    cut = s.result("views", file="vase.cag", width=96, height=64, views=["front"], section="z=20")
    check("a view of a section differs", pictures(cut)[0] != pictures(same)[0])
    r = s.result("views", file="vase.cag", views=["nowhere"], width=32, height=32)
    check("an unknown view", r["isError"] and "unknown camera `nowhere`" in texts(r))
    r = s.result("section", text="show sphere(10)", plane="z=4", width=64, height=64, outlines=True)
    part = r["structuredContent"]["measures"]["parts"][0]
    check("section", len(pictures(r)) == 1 and abs(part["volume"] / (math.pi * (4000 / 3 - 288)) - 1) < 3e-3)
    check("outlines", "A 9.16515139 9.16515139" in r["structuredContent"]["outlines"])  # sqrt(84)
    r = s.result("section", text="show sphere(10)", plane="z=99", outlines=True, width=32, height=32)
    check("a plane beside everything", r["isError"] and "reach from -10 to 10" in texts(r))
    check("temporary files are removed", not [f for f in os.listdir(os.environ["TMPDIR"]) if f.startswith("cag-")])
    s.close()


def documents():
    s = Server()
    check("documentation", "torus(major, minor)" in texts(s.result("documentation", name="torus")))
    check("documentation of a code", "E0201" in texts(s.result("documentation", name="E0201")))
    check("the overview", len(texts(s.result("documentation"))) > 1000)
    check("nothing is documented", s.result("documentation", name="nix")["isError"])
    e = s.result("examples", words="gear", limit=2)["structuredContent"]["examples"]
    check("examples", 1 <= len(e) <= 2 and "gear" in e[0]["text"])
    check("the cookbook", len(s.result("examples")["structuredContent"]["examples"]) > 20)
    check("no example", "no example" in texts(s.result("examples", words="zzzz qqqq")))
    # An example is a script that runs.
    check("an example runs", not s.result("run", text=s.result("examples", words="gear wheel")["structuredContent"]["examples"][0]["text"])["isError"])
    s.close()


def wrong():
    s = Server()
    check("an unknown method", code(s.ask("resources/list")) == -32601)
    check("an unknown tool", code(s.call("nix")) == -32602)
    for what, arguments in {
        "an unknown argument": {"text": "", "fil": 1}, "no script": {}, "two scripts": {"text": "", "file": "vase.cag"},
        "a wrong type": {"text": 3}, "params of a wrong type": {"text": "", "params": [1]}, "a param of a wrong type": {"text": "", "params": {"a": [1]}},
    }.items():
        check(what, code(s.call("run", **arguments)) == -32602)
    for what, arguments in {
        "a width that is too large": {"width": 1e9}, "a width of a wrong kind": {"width": 64.5}, "an empty list": {"views": []},
        "too many views": {"views": ["top"] * 17}, "views of a wrong type": {"views": [1]}, "an unknown quality": {"quality": "best"},
        "a wrong section": {"section": "z"}, "an infinite section": {"section": "z=inf"}, "a text section": {"section": "z=1; rm"},
    }.items():
        check(what, code(s.call("views", text="show sphere(1)", **arguments)) == -32602)
    check("a missing argument", code(s.call("section", text="show sphere(1)")) == -32602)
    check("arguments that are a list", code(s.ask("tools/call", {"name": "run", "arguments": []})) == -32602)
    check("a call without a name", code(s.ask("tools/call", {})) == -32602)
    check("a call without params", code(s.ask("tools/call")) == -32602)
    # Files outside of the folder
    messages = set()
    for path in ["/etc/passwd", "../secret.cag", "parts/../../secret.cag", "/nonexistent/x.cag", "link.cag", "missing.cag", "", "x" * 100000, ".", "vase.cag/x"]:
        m = s.call("run", file=path)
        check(f"a file outside: {path[:30]}", code(m) == -32602 or m["result"]["isError"])
        if len(path) > 1:
            messages.add(m.get("error", {}).get("message", "").replace(path[:200], "PATH"))
    check(f"the message does not tell whether a file outside exists: {messages}", len(messages - {""}) == 1)
    r = s.result("run", text='print read_text("../secret.cag")')
    check("a script cannot read outside", r["isError"] and "secret" not in r["structuredContent"]["output"])
    s.close()


def hostile():
    s = Server()
    for line in [b"nonsense\n", b"{\n", b'{"jsonrpc":"2.0","id":1,"method":"ping"\n', b"\xff\xfe\n", b'{"a":"\xc3"}\n', b'"\\u0000"\n', b"\x00\n",
                 b'{"jsonrpc":"2.0","id":1,"method":"ping"} trailing\n', b"[" * 100000 + b"\n"]:
        m = s.raw(line)
        check(f"not JSON: {line[:40]}", code(m) == -32700 and m["id"] is None)
    for message in [1, "text", None, True, {}, {"id": 1}, {"jsonrpc": "1.0", "id": 1, "method": "ping"}, {"jsonrpc": "2.0", "id": 1},
                    {"jsonrpc": "2.0", "id": 1, "method": 5}, {"jsonrpc": "2.0", "id": [1], "method": "ping"}, {"jsonrpc": "2.0", "id": None, "method": "ping"},
                    {"jsonrpc": "2.0", "id": 1, "method": "ping", "params": [1]}, []]:
        check(f"not a request: {message}", code(s.raw(json.dumps(message) + "\n")) == -32600)
    check("no batches in this revision", code(s.raw('[{"jsonrpc":"2.0","id":1,"method":"ping"}]\n')) == -32600)
    s.write(b"\n  \r\n")  # blank lines are ignored
    s.notify("notifications/nothing")
    s.notify("notifications/cancelled", {"requestId": 12345})
    s.notify("notifications/cancelled")
    s.send({"jsonrpc": "2.0", "id": 99, "result": {}})
    check("a huge line", code(s.raw(b'{"jsonrpc":"2.0","id":1,"method":"' + b"x" * (17 << 20) + b'"}\n')) == -32600)
    check("a long line", s.raw(json.dumps({"jsonrpc": "2.0", "id": 7, "method": "ping", "params": {"x": "y" * (8 << 20)}}) + "\n")["result"] == {})
    for piece in [b'{"jsonrpc":"2.0",', b'"id":8,"meth', b'od":"ping"}\r', b"\n"]:
        s.write(piece)
        time.sleep(0.02)
    check("a line in pieces", s.next() == {"jsonrpc": "2.0", "id": 8, "result": {}})
    check("a deep script", s.result("run", text="print " + "(" * 100000 + "1" + ")" * 100000)["isError"])
    check("still alive", s.ask("ping")["result"] == {})
    s.write(b'{"jsonrpc":"2.0","id":9,"method":"ping"}')  # the last line has no end
    s.process.stdin.close()
    check("a last line without its end", s.next() == {"jsonrpc": "2.0", "id": 9, "result": {}})
    check("status", s.process.wait(timeout=LONGEST) == 0)


ENDLESS = "f(n) = f(n + 1)\nprint f(0)"


def cancelling():
    s = Server()
    slow = s.request("tools/call", {"name": "run", "arguments": {"text": ENDLESS}})
    waiting = s.request("tools/call", {"name": "run", "arguments": {"text": "print 1"}})
    other = s.request("tools/call", {"name": "run", "arguments": {"text": "print 2"}})
    check("a ping is answered while a call runs", s.ask("ping")["result"] == {})
    s.notify("notifications/cancelled", {"requestId": waiting, "reason": "test"})
    s.notify("notifications/cancelled", {"requestId": slow})
    m = s.answer(other)
    check("calls after a cancelled one", m["result"]["structuredContent"]["output"] == "2\n")
    check("cancelled calls have no answer", not s.seen)
    # Too many calls
    slow = s.request("tools/call", {"name": "run", "arguments": {"text": ENDLESS}})
    numbers = [s.request("tools/call", {"name": "run", "arguments": {"text": "print 3"}}) for _ in range(70)]
    refused = [code(s.next()) for _ in range(5)]
    check(f"at most 64 calls wait: {refused}", refused == [-32000] * 5)
    s.notify("notifications/cancelled", {"requestId": slow})
    check("the others are answered", s.answer(numbers[0])["result"]["structuredContent"]["output"] == "3\n")
    s.close()
    s = Server()
    m = s.ask("tools/call", {"name": "views", "arguments": {"file": "vase.cag", "quality": "normal", "width": 64, "height": 48, "views": ["iso", "front"]},
                             "_meta": {"progressToken": "token"}})
    steps = [n["params"] for n in s.seen if n["method"] == "notifications/progress"]
    check("progress is reported", steps and all(n["progressToken"] == "token" and n["total"] == 100 for n in steps))
    check("progress increases", all(a["progress"] < b["progress"] for a, b in zip(steps, steps[1:])) and steps[-1]["progress"] <= 100)
    s.seen.clear()
    s.result("views", file="vase.cag", views=["top"])
    check("no progress unless asked for", not s.seen)
    # Ctrl-C
    s.request("tools/call", {"name": "run", "arguments": {"text": ENDLESS}})
    time.sleep(0.2)
    s.process.send_signal(signal.SIGTERM)
    check("Ctrl-C ends a call", s.process.wait(timeout=LONGEST) == 130)
    # The client is gone
    gone = subprocess.Popen([CAG, "mcp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    gone.stdout.close()
    try:
        gone.stdin.write(b'{"jsonrpc":"2.0","id":1,"method":"ping"}\n')
        gone.stdin.close()
    except BrokenPipeError:
        pass
    check("a client that is gone", gone.wait(timeout=LONGEST) == 3)


def limits():
    s = Server("--max-time", "1", "--max-memory", "64M")
    r = s.result("run", text=ENDLESS)
    check("the time limit", r["isError"] and r["structuredContent"]["status"] == "limit" and "time limit" in texts(r))
    r = s.result("run", text="print len([for i in 0..<1e9: [i]])")
    check("the memory limit", r["isError"] and r["structuredContent"]["status"] == "limit")
    s.close()


def batches():
    s = Server(version="2025-03-26")
    s.send([{"jsonrpc": "2.0", "id": 1, "method": "ping"}, {"jsonrpc": "2.0", "method": "notifications/initialized"},
            {"jsonrpc": "2.0", "id": 2, "method": "tools/call", "params": {"name": "run", "arguments": {"text": "print 5"}}}, 7])
    m = s.next()
    check("a batch", isinstance(m, list) and sorted(str(a["id"]) for a in m) == ["1", "2", "None"])
    s.send([{"jsonrpc": "2.0", "method": "notifications/initialized"}])
    check("an empty batch", code(s.raw("[]\n")) == -32600)
    s.send([{"jsonrpc": "2.0", "id": 3, "method": "tools/call", "params": {"name": "run", "arguments": {"text": ENDLESS}}},
            {"jsonrpc": "2.0", "id": 4, "method": "ping"}])
    s.notify("notifications/cancelled", {"requestId": 3})
    m = s.next()
    check("a cancelled call of a batch", [a["id"] for a in m] == [4])
    s.close()


def main():
    with tempfile.TemporaryDirectory() as above:
        os.environ["TMPDIR"] = above + "/tmp"
        os.mkdir(above + "/tmp")
        os.makedirs(above + "/models/parts")
        os.chdir(above + "/models")
        open("../secret.cag", "w").write("print \"secret\"\n")
        os.symlink("../secret.cag", "link.cag")
        open("vase.cag", "w").write('param height = 40\nparam wide = false\nparam word = "x"\nprint height, wide, word\n'
                                    "show revolve(bspline([[10, 0], [16, height / 3], [8, height * 2 / 3], [12, height]]))\n")
        open("parts/seven.cag", "w").write("x = 7\n")
        open("parts/uses.cag", "w").write('import "seven.cag" as s\nprint s.x\n')
        for part in [lifecycle, scripts, drawings, documents, wrong, hostile, cancelling, limits, batches]:
            try:
                part()
            except Exception as e:
                check(f"{part.__name__}: {type(e).__name__}: {e}", False)
        os.chdir("/")
    print(f"{checks} checks, {failed} failed")
    return failed > 0


sys.exit(main())
