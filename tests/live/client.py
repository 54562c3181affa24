"""A client of the language server: starts `cag lsp`, sends messages, and keeps the texts of the documents that it opens."""

import json
import os
import queue
import subprocess
import threading
import urllib.parse


class ServerError(Exception):
    def __init__(self, error):
        super().__init__(error["message"])
        self.code = error["code"]


def uri_of(path):
    return "file://" + urllib.parse.quote(path)


def path_of(uri):
    return urllib.parse.unquote(urllib.parse.urlparse(uri).path)


FULL = {
    "general": {"positionEncodings": ["utf-16"]},
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True}},
        "documentSymbol": {"hierarchicalDocumentSymbolSupport": True},
        "hover": {"contentFormat": ["markdown"]},
    },
    "window": {"showDocument": {"support": True}},
}


class Client:
    def __init__(self, program, folder=None, capabilities=None, options=None, arguments=(), environment=None, wrap=()):
        env = dict(os.environ, **(environment or {}))
        self.process = subprocess.Popen([*wrap, program, "lsp", *arguments], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=env)
        self.inbox, self.next_id, self.notes, self.texts, self.versions = queue.Queue(), 0, [], {}, {}
        self.diagnostics = {}
        threading.Thread(target=self.read, daemon=True).start()
        if folder is False:
            return
        self.capabilities = self.ask("initialize", {
            "processId": os.getpid(), "rootUri": uri_of(folder) if folder else None,
            "capabilities": FULL if capabilities is None else capabilities, "initializationOptions": options or {}})["capabilities"]
        self.utf8 = self.capabilities.get("positionEncoding") == "utf-8"
        self.tell("initialized", {})

    # --- messages ---

    def read(self):
        out = self.process.stdout
        while True:
            length = None
            while True:
                line = out.readline()
                if not line:
                    self.inbox.put(None)
                    return
                if line == b"\r\n":
                    break
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            self.inbox.put(json.loads(out.read(length)))

    def send_bytes(self, data):
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.send_bytes(b"Content-Length: %d\r\n\r\n" % len(body) + body)

    def tell(self, method, params):
        self.send({"method": method, "params": params})

    def begin(self, method, params):
        self.next_id += 1
        self.send({"id": self.next_id, "method": method, "params": params})
        return self.next_id

    def take(self, timeout=30):
        """The next message; notes are kept, and requests of the server answered."""
        message = self.inbox.get(timeout=timeout)
        if message is None:
            raise EOFError("the server has ended")
        if "method" in message:
            self.notes.append(message)
            if "id" in message:
                self.send({"id": message["id"], "result": None})
            if message["method"] == "textDocument/publishDiagnostics":
                self.diagnostics[message["params"]["uri"]] = message["params"]
        return message

    def answer(self, number, timeout=30):
        while True:
            message = self.take(timeout)
            if "method" not in message and message.get("id") == number:
                if "error" in message:
                    raise ServerError(message["error"])
                return message["result"]

    def ask(self, method, params, timeout=30):
        return self.answer(self.begin(method, params), timeout)

    # --- documents ---

    def open(self, uri, text):
        self.texts[uri], self.versions[uri] = text, 1
        self.diagnostics.pop(uri, None)
        self.tell("textDocument/didOpen", {"textDocument": {"uri": uri, "languageId": "cag", "version": 1, "text": text}})

    def change(self, uri, edits, full=False):
        """edits: (start, end, text) with offsets in characters of the text as the edits before have left it."""
        changes = []
        for start, end, new in edits:
            text = self.texts[uri]
            changes.append({"text": text[:start] + new + text[end:]} if full else
                           {"range": {"start": self.position(uri, start), "end": self.position(uri, end)}, "text": new})
            self.texts[uri] = text[:start] + new + text[end:]
        self.versions[uri] += 1
        self.tell("textDocument/didChange", {"textDocument": {"uri": uri, "version": self.versions[uri]}, "contentChanges": changes})

    def replace(self, uri, old, new):
        start = self.texts[uri].index(old)
        self.change(uri, [(start, start + len(old), new)])

    def close(self, uri):
        self.tell("textDocument/didClose", {"textDocument": {"uri": uri}})

    def units(self, text):
        return len(text.encode()) if self.utf8 else len(text.encode("utf-16-le")) // 2

    def position(self, uri, offset):
        text = self.texts[uri][:offset]
        line = text.count("\n")
        return {"line": line, "character": self.units(text[text.rfind("\n") + 1:])}

    def offset(self, uri, position, text=None):
        text = self.texts[uri] if text is None else text
        start = 0
        for _ in range(position["line"]):
            start = text.index("\n", start) + 1
        end = start
        while self.units(text[start:end]) < position["character"]:
            end += 1
        return end

    def at(self, uri, mark, inside=0):
        """The parameters of a request at the text `mark`, plus `inside` characters."""
        return {"textDocument": {"uri": uri}, "position": self.position(uri, self.texts[uri].index(mark) + inside)}

    def part(self, uri, span, text=None):
        """The text of a range."""
        text = self.texts[uri] if text is None else text
        return text[self.offset(uri, span["start"], text):self.offset(uri, span["end"], text)]

    def apply(self, uri, edits, text=None):
        """The text after edits, none of which may overlap."""
        text = self.texts[uri] if text is None else text
        spans = sorted(((self.offset(uri, e["range"]["start"], text), self.offset(uri, e["range"]["end"], text), e["newText"]) for e in edits), reverse=True)
        for start, end, new in spans:
            text = text[:start] + new + text[end:]
        return text

    def wait_for(self, uri, version=None, timeout=30):
        """The diagnostics of a version of a document (the current one)."""
        version = self.versions.get(uri) if version is None else version
        while uri not in self.diagnostics or (version and self.diagnostics[uri].get("version") != version):
            self.take(timeout)
        return self.diagnostics[uri]["diagnostics"]

    def wait_note(self, method, timeout=30):
        while True:
            for i, note in enumerate(self.notes):
                if note["method"] == method:
                    return self.notes.pop(i)["params"]
            self.take(timeout)

    def end(self):
        self.ask("shutdown", None)
        self.tell("exit", None)
        return self.process.wait(timeout=30)
