#!/usr/bin/env python3
"""Input that no client should send: each gets an error, or is ignored, and the server goes on. The last line is `N passed, N failed, N skipped`.

    hostile.py PROGRAM [WRAPPER ...]      WRAPPER runs the program, as `valgrind -q` does
"""

import json
import os
import subprocess
import sys
import tempfile
import traceback

from client import Client, ServerError, uri_of

PROGRAM = os.path.abspath(sys.argv[1])
PASSED = FAILED = 0


def run(data):
    """The answers of a server that is given these bytes and then the end of the file, and its exit status."""
    done = subprocess.run([*sys.argv[2:], PROGRAM, "lsp"], input=data, capture_output=True, timeout=120)
    out, answers = done.stdout, []
    while out:
        head, out = out.split(b"\r\n\r\n", 1)
        length = int(head.split(b":")[1])
        answers.append(json.loads(out[:length]))
        out = out[length:]
    assert done.returncode in (0, 1), (done.returncode, done.stderr[-2000:])
    return answers


def message(body):
    body = body if isinstance(body, bytes) else json.dumps(body).encode()
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


INITIALIZE = message({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"capabilities": {}}})
PROBE = message({"jsonrpc": "2.0", "id": "probe", "method": "no/such"})


def check(name, function):
    global PASSED, FAILED
    try:
        function()
        PASSED += 1
    except Exception:
        FAILED += 1
        print(f"FAILED {name}")
        print("  " + "\n  ".join(traceback.format_exc().strip().split("\n")[-6:]))


def gets_error(data, code=-32700, goes_on=True):
    answers = run(INITIALIZE + data + (PROBE if goes_on else b""))
    codes = [a["error"]["code"] for a in answers if "error" in a]
    assert codes == [code] + ([-32601] if goes_on else []), answers


def ignored(data):
    answers = run(INITIALIZE + data + PROBE)
    assert [a["id"] for a in answers if "id" in a] == [1, "probe"], answers


def frames():
    for name, data, code, goes_on in [
            ("a header without a length", b"Content-Type: x\r\n\r\n", -32700, True),
            ("a length that is no number", b"Content-Length: ten\r\n\r\n", -32700, True),
            ("a negative length", b"Content-Length: -5\r\n\r\n", -32700, True),
            ("two lengths", b"Content-Length: 2\r\nContent-Length: 2\r\n\r\n", -32700, True),
            ("a line that is no header", b"GET / HTTP/1.1\r\n\r\n", -32700, True),
            ("a header of a megabyte", b"X: " + b"y" * 1000000 + b"\r\nContent-Length: z\r\n\r\n", -32700, True),
            ("a huge length", b"Content-Length: 99999999999999999999\r\n\r\n{}", -32700, False),
            ("a length of a terabyte", b"Content-Length: 1000000000000\r\n\r\n{}", -32700, False),
            ("a message that ends early", b"Content-Length: 100\r\n\r\n{}", -32700, False),
            ("a header that ends early", b"Content-Len", -32700, False),
            ("no JSON", message(b"{nonsense"), -32700, True),
            ("an empty message", message(b""), -32700, True),
            ("two values", message(b"{}{}"), -32700, True),
            ("invalid UTF-8", message(b"{\"method\":\"\xff\xfe\"}"), -32700, True),
            ("UTF-8 of a surrogate", message(b"{\"method\":\"\xed\xa0\x80\"}"), -32700, True),
            ("half a surrogate pair", message(b"{\"method\":\"\\ud800\"}"), -32700, True),
            ("a zero byte", message(b"{\"a\":\"\x00\"}"), -32700, True),
            ("a hundred thousand brackets", message(b"[" * 100000), -32700, True),
            ("a list", message([]), -32600, True),
            ("a number", message(b"3"), -32600, True),
            ("an object without a method", message({"id": 4}), -32600, True),
            ("a method that is a number", message({"id": 4, "method": 5}), -32600, True),
            ("a second initialize", message({"id": 4, "method": "initialize", "params": {}}), -32600, True)]:
        check(name, lambda: gets_error(data, code, goes_on))
    check("nothing at all", lambda: run(b""))
    check("blank lines", lambda: ignored(b"\r\n\r\n\n"))
    check("a notification that is unknown", lambda: ignored(message({"method": "$/unknown", "params": [1]})))
    check("an answer that nobody waits for", lambda: ignored(message({"id": 77, "result": {}})))
    check("a cancellation of nothing", lambda: ignored(message({"method": "$/cancelRequest", "params": {"id": 99}})))


METHODS = ["completion", "hover", "signatureHelp", "definition", "references", "documentHighlight", "prepareRename", "rename", "documentSymbol", "foldingRange",
           "selectionRange", "documentLink", "inlayHint", "documentColor", "colorPresentation", "formatting", "rangeFormatting", "onTypeFormatting", "codeAction",
           "codeLens", "semanticTokens/full", "semanticTokens/full/delta", "semanticTokens/range"]
ODD = [None, 3, "x", [], {}, {"textDocument": None}, {"textDocument": {"uri": 5}}, {"textDocument": {"uri": "file:///no/such.cag"}, "position": {"line": 0, "character": 0}}]
FAR = [{"line": 0, "character": 10 ** 9}, {"line": 10 ** 9, "character": 0}, {"line": 2 ** 40, "character": 2 ** 40}, {"line": -1, "character": -1}, {"line": "1", "character": None}, {},
       {"line": 1e300, "character": 0.5}]


def documents():
    with tempfile.TemporaryDirectory() as folder:
        client = Client(PROGRAM, folder, environment={"XDG_CACHE_HOME": folder}, wrap=sys.argv[2:])
        uri = uri_of(os.path.join(folder, "a.cag"))
        client.open(uri, "f(x) = x + 1\nprint f(2)\n")

        def asked(method, params):
            try:
                client.ask(method, params, timeout=120)
            except ServerError:
                pass

        def odd_params():
            for method in METHODS:
                for params in ODD:
                    asked("textDocument/" + method, params)
            for params in ODD + [{"query": 5}, {"command": {}, "arguments": 3}]:
                asked("workspace/symbol", params)
                asked("workspace/executeCommand", params)

        def far_positions():
            for method in METHODS:
                for place in FAR:
                    asked("textDocument/" + method, {"textDocument": {"uri": uri}, "position": place, "positions": [place], "range": {"start": place, "end": place}, "newName": "y"})
                    asked("textDocument/" + method, {"textDocument": {"uri": uri}, "range": {"start": {"line": 1, "character": 0}, "end": place}})

        def odd_changes():
            for changes in [None, 3, [], [3], [{}], [{"text": 5}], [{"range": {}, "text": "x"}], [{"range": {"start": FAR[3], "end": FAR[3]}, "text": "x"}],
                            [{"range": {"start": {"line": 1, "character": 0}, "end": {"line": 0, "character": 0}}, "text": "x"}]]:
                for version in [None, "x", 1e300, -4]:
                    client.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": version}, "contentChanges": changes})
            for note in ["didOpen", "didChange", "didSave", "didClose"]:
                for params in ODD:
                    client.tell("textDocument/" + note, params)
            for params in ODD + [{"changes": [{"uri": "file:///x.cag", "type": "y"}, 4]}, {"event": {"added": [{"uri": "file:///no/such"}, 3], "removed": 5}}]:
                client.tell("workspace/didChangeWatchedFiles", params)
                client.tell("workspace/didChangeWorkspaceFolders", params)
                client.tell("workspace/didChangeConfiguration", params)
            # The document is as it was.
            answer = client.ask("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 0}}, timeout=120)
            assert "f(x)" in answer["contents"]["value"], answer

        def far_change_appends():
            client.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": 9}, "contentChanges": [{"range": {"start": FAR[1], "end": FAR[2]}, "text": "z = 1\n"}]})
            names = [s["name"] for s in client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}}, timeout=120)]
            assert names == ["f", "z"], names

        def odd_texts():
            for text in ["\0", "a\0b = 1\n", "\u0001", "\ufeffx = 1\n", "\r\r\n", "(" * 20000, "{" * 3000, "\"{" * 3000, "x = 1 +" * 5000, "/*" * 5000, "a." * 5000, "not " * 20000,
                         "import a\n" * 2000, "x=" * 3000, "[for i in " * 2000, "\\u{", "`", "\"\\", "x = " + "9" * 100000, "é" * 50000, "x" * 200000, "print 1\n" * 30000]:
                client.change(uri, [(0, 0, text)], full=True) if False else client.tell(
                    "textDocument/didChange", {"textDocument": {"uri": uri, "version": 10}, "contentChanges": [{"text": text}]})
                for method in ["completion", "hover", "semanticTokens/full", "documentSymbol", "foldingRange", "formatting", "codeAction", "signatureHelp"]:
                    asked("textDocument/" + method, {"textDocument": {"uri": uri}, "position": {"line": 0, "character": min(len(text), 999)}, "context": {},
                                                     "range": {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 5}}})

        def zero_bytes_keep_their_width():
            client.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": 11}, "contentChanges": [{"text": "// \0\0 \\u0000\nx = 1\n"}]})
            client.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": 12}, "contentChanges": [
                {"range": {"start": {"line": 0, "character": 3}, "end": {"line": 0, "character": 12}}, "text": "yy"}]})
            names = [s["name"] for s in client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}}, timeout=120)]
            assert names == ["x"], names
            answer = client.ask("textDocument/foldingRange", {"textDocument": {"uri": uri}}, timeout=120)
            assert answer == [], answer

        for function in [odd_params, far_positions, odd_changes, far_change_appends, odd_texts, zero_bytes_keep_their_width]:
            check(function.__name__.replace("_", " "), function)
        check("the server is still well", lambda: (client.end() == 0) or (_ for _ in ()).throw(AssertionError("exit status")))
        client.process.kill()


frames()
documents()
print(f"{PASSED} passed, {FAILED} failed, 0 skipped")
sys.exit(FAILED > 0)
