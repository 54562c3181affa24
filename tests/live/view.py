#!/usr/bin/env python3
"""Tests the server of `cag view` as a page would use it, and as nobody should.

    view.py PROGRAM [TEST ...]   closes with `N passed, N failed, N skipped`
"""

import http.client
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time

CAG = os.path.abspath(sys.argv[1])
WAIT = int(os.environ.get("WAIT", "60"))  # seconds, on a busy machine
VASE = """param height = 40 in 10..90 "height, mm"
show revolve(polyline([[0, 0], [20, 0], [24, height], [0, height]])) |> named("vase")
show box([5, 5, 5]) |> translate([60, 0, 0]) |> named("box")
print "height {height}"
"""


def accept_interrupts():
    """A shell starts jobs in the background with SIGINT ignored, and they pass that on."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class View:
    """A server with its folder, and a listener of its events."""

    def __init__(self, text, *options, name="model.cag"):
        self.folder = tempfile.mkdtemp()
        self.path = os.path.join(self.folder, name)
        with open(self.path, "w") as f:
            f.write(text)
        self.process = subprocess.Popen([CAG, "view", self.path, "--no-open", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=accept_interrupts)
        self.address = self.process.stdout.readline().strip()
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.token = self.address.split("t=")[1]
        self.cookie = {"Cookie": "cag-view=" + self.token}
        self.events = []
        self.changed = threading.Condition()
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self):
        try:
            c = http.client.HTTPConnection("127.0.0.1", self.port)
            c.request("GET", "/api/events", headers=self.cookie)
            kind = None
            for line in c.getresponse():
                line = line.decode().rstrip("\n")
                if line.startswith("event: "):
                    kind = line[7:]
                elif line.startswith("data: "):
                    with self.changed:
                        self.events.append((kind, json.loads(line[6:])))
                        self.changed.notify_all()
        except (OSError, http.client.HTTPException):
            pass

    def ask(self, method, path, body=None, headers=None, cookie=True):
        c = http.client.HTTPConnection("127.0.0.1", self.port, timeout=WAIT)
        sent = dict(self.cookie if cookie else {})
        sent.update(headers or {})
        c.request(method, path, body=body, headers=sent)
        r = c.getresponse()
        answer = r.status, r.read(), dict(r.getheaders())
        c.close()
        return answer

    def run(self, **request):
        status, body, _ = self.ask("POST", "/api/run", json.dumps(request))
        assert status == 202, status
        return json.loads(body)["run"]

    def wait(self, kind, accept=lambda e: True, since=0):
        """The first event of a kind that is accepted."""
        end = time.monotonic() + WAIT
        with self.changed:
            while True:
                for k, e in self.events[since:]:
                    if k == kind and accept(e):
                        return e
                left = end - time.monotonic()
                if left <= 0:
                    raise AssertionError(f"no event {kind}")
                self.changed.wait(left)

    def scene(self, run):
        return self.wait("scene", lambda e: e["run"] >= run)

    def close(self):
        self.process.send_signal(signal.SIGINT)
        status = self.process.wait(WAIT)
        shutil.rmtree(self.folder)
        return status


def mesh_of(scene, name):
    return next(p for p in scene["parts"] if p["name"] == name)


# --- A page ---


def test_scene():
    v = View(VASE)
    scene = v.scene(1)
    assert [p["name"] for p in scene["parts"]] == ["vase", "box"]
    assert scene["params"][0]["low"] == 10 and scene["params"][0]["value"] == "40"
    assert scene["parts"][0]["origin"][0] == {"what": "show", "file": "model.cag", "line": 2, "column": 6, "endLine": 2, "endColumn": len(VASE.split("\n")[1]) + 1, "library": False}
    status, body, headers = v.ask("GET", "/api/mesh/" + scene["parts"][1]["mesh"])
    numbers = [int.from_bytes(body[4 * i : 4 * i + 4], "little") for i in range(8)]
    assert status == 200 and numbers[0] == 0x6D676163 and numbers[3] == 12 and numbers[4] == 12
    assert "immutable" in headers["Cache-Control"]
    messages = v.wait("messages")
    assert messages["ok"] and messages["prints"] == ["height 40"]
    assert v.close() == 130


def test_only_what_changed_has_another_mesh():
    v = View(VASE)
    first = v.scene(1)
    second = v.scene(v.run(params={"height": "60"}))
    assert mesh_of(first, "vase")["mesh"] != mesh_of(second, "vase")["mesh"]
    assert mesh_of(first, "box")["mesh"] == mesh_of(second, "box")["mesh"]
    assert mesh_of(second, "vase")["bounds"][1][2] == 60
    coarse = v.scene(v.run(params={"height": "60"}, coarse=True))
    assert mesh_of(coarse, "vase")["mesh"] != mesh_of(second, "vase")["mesh"]
    v.close()


def test_what_moves_keeps_its_mesh():
    v = View("show tube(helix(20, 10, 2), 3) |> rotate(Z, time * 90deg)\n")
    first = v.scene(1)
    assert first["timed"]
    second = v.scene(v.run(time=1, frames=11))
    a, b = first["parts"][0], second["parts"][0]
    assert a["mesh"] == b["mesh"] and a["placement"] != b["placement"]
    assert abs(b["placement"][0]) < 1e-12 and abs(b["placement"][4] - 1) < 1e-12
    v.close()


def test_errors_leave_the_last_scene():
    v = View(VASE)
    v.scene(1)
    run = v.run(files={"model.cag": "show sphere(\n"})
    messages = v.wait("messages", lambda m: m["run"] == run)
    assert not messages["ok"] and messages["diagnostics"][0]["line"] >= 1
    assert not any(k == "scene" and e["run"] == run for k, e in v.events)
    scene = v.scene(v.run(files={"model.cag": "show sphere(7)\n"}))
    assert scene["parts"][0]["name"] == "sphere"
    v.close()


def test_a_newer_run_cancels_an_older_one():
    v = View("show sphere(1)\n")
    v.scene(1)
    v.run(files={"model.cag": "f(n) = if n == 0 then 0 else f(n - 1)\nx = f(1e12)\nshow sphere(x)\n"})
    begin = time.monotonic()
    v.scene(v.run(files={"model.cag": "show box([1, 1, 1])\n"}))
    assert time.monotonic() - begin < WAIT / 2
    v.close()


def test_a_save_by_another_editor_runs_the_script():
    v = View(VASE)
    v.scene(1)
    other = v.path + ".new"
    with open(other, "w") as f:
        f.write("show cylinder(9, 3)\n")
    os.rename(other, v.path)
    assert v.wait("file")["path"] == "model.cag"
    v.wait("scene", lambda e: e["parts"][0]["name"] == "cylinder")
    v.close()


def test_imported_files_are_watched():
    v = View("import parts: knob\nshow knob\n")
    run = v.wait("messages")["run"]
    with open(os.path.join(v.folder, "parts.cag"), "w") as f:
        f.write("knob = sphere(4)\n")
    v.wait("scene", lambda e: e["parts"][0]["name"] == "knob")
    files = json.loads(v.ask("GET", "/api/files")[1])
    assert sorted(f["path"] for f in files) == ["model.cag", "parts.cag"], files
    with open(os.path.join(v.folder, "parts.cag"), "w") as f:
        f.write("knob = box([4, 5, 6])\n")
    scene = v.wait("scene", lambda e: e["parts"][0]["bounds"][1] == [4, 5, 6])
    assert scene["run"] > run and scene["parts"][0]["origin"][-1]["file"] == "parts.cag"
    v.close()


def test_measures():
    v = View(VASE)
    v.scene(1)
    status, body, _ = v.ask("POST", "/api/measure", '{"part": "box"}')
    m = json.loads(body)
    assert status == 200 and abs(m["volume"] - 125) < 1e-9 and abs(m["area"] - 150) < 1e-9 and m["watertight"]
    assert v.ask("POST", "/api/measure", '{"part": "none"}')[0] == 404
    assert v.ask("POST", "/api/measure", "[]")[0] == 400
    v.close()


def test_files_are_saved():
    v = View(VASE)
    status, text, headers = v.ask("GET", "/api/file?path=model.cag")
    assert status == 200 and text.decode() == VASE
    tag = headers["ETag"]
    assert v.ask("PUT", "/api/file?path=model.cag", "show sphere(1)\n", {"If-Match": '"0"'})[0] == 412
    status, body, _ = v.ask("PUT", "/api/file?path=model.cag", "show sphere(2)\n", {"If-Match": tag})
    assert status == 200 and json.loads(body)["version"] != tag.strip('"')
    with open(v.path) as f:
        assert f.read() == "show sphere(2)\n"
    assert v.ask("PUT", "/api/params", '{"tall": {"height": 80}}')[0] == 200
    with open(v.path + ".params.json") as f:
        assert json.load(f) == {"tall": {"height": 80}}
    assert json.loads(v.ask("GET", "/api/params")[1]) == {"tall": {"height": 80}}
    v.close()


def test_exports_and_pictures():
    v = View(VASE)
    v.scene(1)
    status, body, headers = v.ask("POST", "/api/export", '{"format": "stl"}')
    assert status == 200 and 'filename="model.stl"' in headers["Content-Disposition"]
    assert len(body) == 84 + 50 * int.from_bytes(body[80:84], "little")
    camera = {"eye": [0, -200, 100], "target": [20, 0, 20], "up": [0, 0, 1], "fov": 40}
    status, body, _ = v.ask("POST", "/api/render", json.dumps({"engine": "preview", "quality": "draft", "width": 64, "height": 48, "camera": camera}))
    assert status == 202
    job = json.loads(body)["job"]
    v.wait("progress", lambda e: e["job"] == job and e["done"] and not e["error"])
    status, body, headers = v.ask("GET", f"/api/job/{job}")
    assert status == 200 and body.startswith(b"\x89PNG") and headers["Content-Type"] == "image/png"
    status, body, _ = v.ask("POST", "/api/export", '{"format": "nothing"}')
    assert status == 400
    v.close()


def test_a_page_that_only_reads():
    v = View(VASE, "--read-only")
    v.scene(1)
    assert v.ask("PUT", "/api/file?path=model.cag", "x = 1\n")[0] == 403
    assert v.ask("PUT", "/api/params", "{}")[0] == 403
    with open(v.path) as f:
        assert f.read() == VASE
    v.close()


# --- What must be refused ---


def test_strangers_are_refused():
    v = View(VASE)
    assert v.ask("GET", "/api/hello", cookie=False)[0] == 403
    assert v.ask("GET", "/", cookie=False)[0] == 403
    assert v.ask("GET", "/api/hello", headers={"Cookie": "cag-view=" + "x" * 32})[0] == 403
    assert v.ask("GET", "/?t=" + "x" * 32, cookie=False)[0] == 403
    assert v.ask("GET", "/?t=" + v.token[:-1], cookie=False)[0] == 403
    status, _, headers = v.ask("GET", "/?t=" + v.token, cookie=False)
    assert status == 303 and headers["Location"] == "/"
    assert "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"]
    for host in ["example.org", "localhost.example.org", "127.0.0.1.example.org:80", "[::2]", ""]:
        assert v.ask("GET", "/api/hello", headers={"Host": host})[0] in (400, 403), host
    for host in ["localhost", "localhost:9999", "127.0.0.1:1", "[::1]:8080"]:
        assert v.ask("GET", "/api/hello", headers={"Host": host})[0] == 200, host
    for origin in ["http://example.org", "null", "https://localhost", "http://localhost:1"]:
        assert v.ask("POST", "/api/run", "{}", {"Origin": origin})[0] == 403, origin
    assert v.ask("GET", "/api/hello", headers={"Sec-Fetch-Site": "cross-site"})[0] == 403
    _, _, headers = v.ask("GET", "/api/hello")
    assert "default-src 'none'" in headers["Content-Security-Policy"]
    v.close()


def test_files_outside_of_the_folder_are_refused():
    v = View(VASE)
    os.symlink("/etc/passwd", os.path.join(v.folder, "link.cag"))
    os.symlink("/etc", os.path.join(v.folder, "etc"))
    os.mkfifo(os.path.join(v.folder, "pipe.cag"))
    for path in ["../model.cag", "/etc/passwd", "..%2F..%2Fetc%2Fpasswd", "%2e%2e/%2e%2e/etc/passwd", "link.cag", "etc/passwd", "", ".", "..", "none.cag", "a%00b"]:
        assert v.ask("GET", "/api/file?path=" + path)[0] == 404, path
    for path in ["../x.cag", "/tmp/x.cag", "link.cag", "etc/x.cag", "notes.txt", "x.sh", "none/x.cag", ".cag"]:
        assert v.ask("PUT", "/api/file?path=" + path, "x = 1\n")[0] == 403, path
    for path in ["/../../etc/passwd", "/%2e%2e/model.cag", "/model.cag", "/api", "/api/none"]:
        assert v.ask("GET", path)[0] == 404, path
    v.close()


def test_wrong_requests():
    v = View(VASE)
    v.scene(1)
    for body in ["", "[", "[]", "1", '{"params": 3}', '{"files": [1]}', '{"time": "x"}', "\0", "{" * 5000]:
        status = v.ask("POST", "/api/run", body)[0]
        assert status in (202, 400), (body, status)
    assert v.ask("POST", "/api/run", "[]")[0] == 400
    for number in ["0", "-1", "999", "x", "99999999999999999999"]:
        assert v.ask("GET", "/api/job/" + number)[0] == 404
    assert v.ask("GET", "/api/mesh/../../etc/passwd")[0] == 404
    assert v.ask("POST", "/api/render", '{"width": -5, "height": 1e9, "camera": {"eye": [0, 0, 0], "target": [0, 0, 0], "up": [0, 0, 0]}}')[0] == 202
    assert v.ask("DELETE", "/api/hello")[0] == 404
    v.close()


def raw(v, data, wait=True):
    """Sends bytes, and returns the first line of the answer."""
    s = socket.create_connection(("127.0.0.1", v.port), timeout=WAIT)
    try:
        s.sendall(data)
        return s.recv(200).split(b"\r\n")[0] if wait else b""
    except OSError:
        return b""
    finally:
        s.close()


def test_sizes_are_limited():
    v = View(VASE)
    v.scene(1)
    head = f"POST /api/run HTTP/1.1\r\nHost: localhost\r\nCookie: cag-view={v.token}\r\n".encode()
    assert b" 413 " in raw(v, head + b"Content-Length: 99999999999\r\n\r\n") + b" 413 "
    status = v.ask("POST", "/api/run", b" " * (33 << 20))[0]
    assert status == 413, status
    raw(v, head + b"Content-Length: 1000\r\n\r\n{", wait=False)
    raw(v, b"GET / HTTP/1.1\r\n" + b"X: " + b"a" * 200000 + b"\r\n\r\n")
    raw(v, b"\0\1\2\3" * 1000)
    assert v.ask("GET", "/api/hello")[0] == 200
    v.close()


def points_of(v, part, status=200):
    found, body, _ = v.ask("POST", "/api/points", json.dumps({"part": part}))
    assert found == status, (found, body)
    return json.loads(body)


def test_points_that_can_be_dragged():
    v = View(VASE)
    v.scene(1)
    answer = points_of(v, "vase")
    points = answer["points"]
    assert answer["omitted"] == 0 and [p["at"] for p in points] == [[0, 0, 0], [20, 0, 0], [24, 0, 40], [0, 0, 40]]
    third = points[2]
    assert third["numbers"][1] is None and third["params"] == ["height"] and third["moved"] == [False, True] and third["locked"] is None
    text = VASE.split("\n")[1]
    number = third["numbers"][0]
    assert text[number["column"] - 1 : number["endColumn"] - 1] == "24" and number["line"] == 2
    assert [number[k] for k in ("file", "value", "unit", "scale")] == ["model.cag", 24, "", 1]
    assert third["plane"]["normal"] == [0, -1, 0] and third["map"] == [1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0]
    move = points_of(v, "box")["points"]
    assert [p["call"] for p in move] == ["translate"] and move[0]["plane"] is None and move[0]["at"] == [60, 0, 0]
    v.close()


def test_params_follow_a_point():
    v = View(VASE)
    v.scene(1)
    wanted = {"part": "vase", "point": 2, "target": [24, 0, 61.234], "ignored": [[0, 1, 0]], "params": ["height"], "pixel": 0.1}
    status, body, _ = v.ask("POST", "/api/solve", json.dumps(wanted))
    assert status == 200 and json.loads(body) == {"params": {"height": "61.23"}, "at": [24, 0, 61.23]}, body
    # The scene is as it was.
    assert points_of(v, "vase")["points"][2]["at"] == [24, 0, 40]
    # Beyond the range, the param stays at its end.
    wanted["target"] = [24, 0, 500]
    assert json.loads(v.ask("POST", "/api/solve", json.dumps(wanted))[1])["params"] == {"height": "90"}
    v.close()


def test_points_that_are_not_there():
    v = View(VASE)
    v.scene(1)
    points_of(v, "bottle", 404)
    points_of(v, 7, 400)
    for body in ("", "[", "[]", "null", '{"part": null}', "\0", '"vase"'):
        status, answer, _ = v.ask("POST", "/api/points", body)
        assert status == 400 and "`part`" in json.loads(answer)["error"], (body, status, answer)
    good = {"part": "vase", "point": 2, "target": [24, 0, 61], "params": ["height"]}
    assert v.ask("POST", "/api/solve", json.dumps(good))[0] == 200
    for field, value, expected in (
        ("part", None, 400), ("part", "bottle", 404), ("point", -1, 400), ("point", "2", 400), ("point", 1e300, 400), ("point", 77, 404),
        ("target", [1, 2], 400), ("target", [1, 2, "3"], 400), ("target", None, 400), ("params", [], 400), ("params", ["width"], 404),
        ("params", ["height"] * 9, 400), ("params", [1], 400), ("params", "height", 400), ("ignored", [0, 0, 2], 400), ("ignored", [[0, 0, 1]] * 3, 400), ("ignored", 1, 400), ("ignored", [[0, 0, 0]], 200)):
        status, answer, _ = v.ask("POST", "/api/solve", json.dumps({**good, field: value}))
        assert status == expected and ("error" in json.loads(answer)) == (status != 200), (field, value, status, answer)
    assert v.ask("GET", "/api/points")[0] == 404
    v.close()
    broken = View("show sphere(\n")
    broken.wait("messages")
    points_of(broken, "sphere", 409)
    broken.close()


def memory_of(process):
    with open(f"/proc/{process.pid}/status") as f:
        return next(int(line.split()[1]) for line in f if line.startswith("VmRSS"))


def test_a_thousand_connections_and_slow_readers():
    v = View(VASE)
    v.scene(1)
    slow = []
    for _ in range(8):
        s = socket.create_connection(("127.0.0.1", v.port))
        s.sendall(f"GET /api/events HTTP/1.1\r\nHost: localhost\r\nCookie: cag-view={v.token}\r\n\r\n".encode())
        slow.append(s)
    many = []
    for _ in range(1000):
        try:
            many.append(socket.create_connection(("127.0.0.1", v.port), timeout=5))
        except OSError:
            break
    for s in many:
        s.close()
    before = memory_of(v.process)
    for i in range(40):
        v.scene(v.run(params={"height": str(20 + i)}))
    assert memory_of(v.process) < before + 100000, "memory grows with slow readers"
    assert v.ask("GET", "/api/hello")[0] == 200
    for s in slow:
        s.close()
    v.close()


def test_a_port_in_use():
    v = View(VASE)
    second = subprocess.run([CAG, "view", v.path, "--no-open", "--port", str(v.port)], capture_output=True, text=True, timeout=WAIT)
    assert second.returncode == 3 and str(v.port) in second.stderr, second
    v.close()
    missing = subprocess.run([CAG, "view", "/nowhere/x.cag", "--no-open"], capture_output=True, text=True, timeout=WAIT)
    assert missing.returncode == 3 and "/nowhere/x.cag" in missing.stderr


ONLY = sys.argv[2:]


def main():
    passed = failed = 0
    for name, test in sorted(globals().items()):
        if not name.startswith("test_") or (ONLY and name not in ONLY):
            continue
        try:
            test()
            passed += 1
        except Exception as error:  # each test is reported
            failed += 1
            print(f"FAILED: {name}: {type(error).__name__}: {error}")
            if isinstance(error, AssertionError):
                line = error.__traceback__
                while line.tb_next:
                    line = line.tb_next
                print(f"  at line {line.tb_lineno}")
    print(f"{passed} passed, {failed} failed, 0 skipped")
    return failed > 0


sys.exit(main())
