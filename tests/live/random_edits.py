#!/usr/bin/env python3
"""Random edits of real scripts: after every few edits, the server must answer as one that is given the final text, the text that it formats and
the edits that it proposes must fit the client's text, and its memory must not grow.

    random_edits.py PROGRAM EDITS [SEED]
"""

import glob
import os
import random
import sys
import tempfile

from client import FULL, Client, ServerError, uri_of

FRAGMENTS = ["(", ")", "[", "]", "{", "}", "\"", "`", ",", ":", " = ", "\n", "\n  ", " |> ", "..", ".", "//", "/*", "*/", "///", " + ", "θ", "😀", "é", "\t",
             "x", "sphere(10)", "show ", "print ", "param p = 3 in 1..9\n", "import std.materials as mat\n", "mat.", "if a then b else c", "[for i in 0..3: i]",
             "f(a, b = 2) = {\n  c = a + b\n  c\n}\n", "30deg", "2.5cm", "\\u{3b8}", "\r\n", "{x}", "assert true\n", "=>", "not ", "\u0001"]
QUESTIONS = ["hover", "completion", "definition", "references", "documentHighlight", "signatureHelp", "prepareRename", "documentSymbol", "foldingRange",
             "selectionRange", "documentLink", "inlayHint", "documentColor", "formatting", "rangeFormatting", "codeAction", "codeLens", "onTypeFormatting"]


def memory(client):
    with open(f"/proc/{client.process.pid}/status") as status:
        return int(next(line for line in status if line.startswith("VmRSS")).split()[1])


def params_of(client, uri, method, place, other):
    text = client.texts[uri]
    at, to = client.position(uri, place), client.position(uri, other)
    params = {"textDocument": {"uri": uri}, "position": at, "range": {"start": at, "end": to}, "positions": [at], "options": {"tabSize": 2, "insertSpaces": True},
              "context": {"diagnostics": [], "includeDeclaration": True}, "ch": text[place - 1:place] if place else "\n"}
    return params


def answers(client, uri):
    """What is compared: everything about the document as a whole, and some places."""
    whole = {"textDocument": {"uri": uri}}
    out = {"diagnostics": client.wait_for(uri)}
    for method in ["documentSymbol", "foldingRange", "documentColor", "documentLink", "codeLens", "formatting"]:
        out[method] = client.ask("textDocument/" + method, {**whole, "options": {}})
    out["words"] = client.ask("textDocument/semanticTokens/full", whole)["data"]
    n = len(client.texts[uri])
    for place in range(0, n, max(1, n // 7)):
        for method in ["hover", "completion", "references", "codeAction", "selectionRange", "signatureHelp"]:
            out[method, place] = client.ask("textDocument/" + method, params_of(client, uri, method, place, place))
    return out


def edit(rng, text, others):
    start = rng.randrange(len(text) + 1)
    kind = rng.random()
    if kind < 0.35:
        return start, start, rng.choice(FRAGMENTS)
    if kind < 0.6:
        return start, min(len(text), start + rng.choice([1, 1, 1, 2, 5, 20])), ""
    if kind < 0.75:
        return start, min(len(text), start + rng.choice([1, 3, 10])), rng.choice(FRAGMENTS)
    if kind < 0.8:
        return start, min(len(text), start + rng.randrange(400)), ""
    other = rng.choice(others)
    cut = rng.randrange(len(other))
    return start, min(len(text), start + rng.randrange(60)), other[cut:cut + rng.randrange(1, 120)]


def main():
    program, count = sys.argv[1], int(sys.argv[2])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    rng = random.Random(seed)
    paths = sorted(glob.glob("examples/*.cag") + glob.glob("stdlib/*.cag"))
    originals = [open(path, encoding="utf-8").read() for path in paths]
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as cache:
        uris = [uri_of(os.path.join(folder, f"s{i}.cag")) for i in range(len(paths))]
        environment = {"XDG_CACHE_HOME": cache}
        capabilities = {**FULL, "general": {"positionEncodings": [rng.choice(["utf-16", "utf-8"])]}}
        client = Client(program, folder, capabilities, environment=environment)
        for uri, text in zip(uris, originals):
            client.open(uri, text)
        done, compared, after_warm_up = 0, 0, None
        while done < count:
            i = rng.randrange(len(uris))
            uri = uris[i]
            for _ in range(rng.randrange(1, 6)):
                edits = []
                for _ in range(rng.choice([1, 1, 1, 2, 4])):
                    # Each edit refers to the text that those before have left.
                    client.change(uri, [edit(rng, client.texts[uri], originals)], full=rng.random() < 0.05)
                    done += 1
                if rng.random() < 0.7:
                    n = len(client.texts[uri])
                    place = rng.randrange(n + 1)
                    method = rng.choice(QUESTIONS)
                    other = min(n, place + rng.randrange(50))
                    client.ask("textDocument/" + method, params_of(client, uri, method, place, other), timeout=120)
                if rng.random() < 0.1:
                    n = len(client.texts[uri])
                    try:
                        client.ask("textDocument/rename", {**params_of(client, uri, "rename", rng.randrange(n + 1), n), "newName": rng.choice(["renamed", "x", "sphere", "1", "in"])})
                    except ServerError as error:
                        assert error.code == -32803, error
            if rng.random() < 0.12:
                fresh = Client(program, folder, capabilities, environment=environment)
                for other in uris:
                    fresh.open(other, client.texts[other])
                expected, found = answers(fresh, uri), answers(client, uri)
                for key in expected:
                    if expected[key] != found[key]:
                        print(f"seed {seed}, after {done} edits: {key} of {uri} is", found[key], "instead of", expected[key], sep="\n")
                        with open("/tmp/random_edits.cag", "w", encoding="utf-8") as out:
                            out.write(client.texts[uri])
                        return 1
                assert fresh.end() == 0
                compared += 1
            if rng.random() < 0.08 or len(client.texts[uri]) > 30000:
                client.change(uri, [(0, len(client.texts[uri]), originals[i])])
                done += 1
            if after_warm_up is None and done > count / 4:
                after_warm_up = memory(client)
        growth = memory(client) / after_warm_up
        assert client.end() == 0
        print(f"{done} edits, {compared} comparisons, memory {memory_text(after_warm_up)} * {growth:.2f}")
        return 0 if growth < 1.5 else 1


def memory_text(kilobytes):
    return f"{kilobytes / 1024:.0f} MB"


if __name__ == "__main__":
    sys.exit(main())
