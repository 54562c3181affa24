#!/usr/bin/env python3
"""Measures the language server in a file of 5,000 lines: lsp.py PROGRAM. Prints the best and the median time of each answer, and the time from a key
stroke to the diagnostics, as the client sees them."""

import os
import statistics
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "live"))
from client import Client, uri_of  # noqa: E402

ROUNDS = 30


def script():
    lines = ["import std.materials as mat"]
    while len(lines) < 5000:
        i = len(lines)
        lines += [f"/// Part {i}.", f"part_{i}(width, height = {i}) = box([width, height, {i % 7 + 1}]) |> translate([{i}, 0, 0])", f"size_{i} = {i} * 2mm + sin(30deg)",
                  f"show part_{i}(size_{i}, height: 3) |> material(mat.glazed(\"teal\"))"]
    return "\n".join(lines[:5000]) + "\n"


def main():
    times = {}

    def timed(name, work):
        start = time.perf_counter()
        work()
        times.setdefault(name, []).append(time.perf_counter() - start)

    with tempfile.TemporaryDirectory() as folder:
        client = Client(sys.argv[1], folder, environment={"XDG_CACHE_HOME": folder})
        uri = uri_of(os.path.join(folder, "long.cag"))
        client.open(uri, script())
        client.wait_for(uri)
        at = client.texts[uri].index("translate([2481")
        for i in range(ROUNDS):
            # The stroke and the answer include the check of the text before.
            timed("key stroke to diagnostics", lambda: (client.change(uri, [(at, at, "x")]), client.wait_for(uri)))
            client.change(uri, [(at, at + 1, "")])
            place = {"textDocument": {"uri": uri}, "position": client.position(uri, at + 3)}
            timed("completion after a key stroke", lambda: client.ask("textDocument/completion", place))
            client.wait_for(uri)
            timed("completion", lambda: client.ask("textDocument/completion", place))
            timed("completion without a letter", lambda: client.ask("textDocument/completion", {**place, "position": client.position(uri, at + 10)}))
            timed("hover", lambda: client.ask("textDocument/hover", place))
            timed("signature help", lambda: client.ask("textDocument/signatureHelp", {**place, "position": client.position(uri, at + 13)}))
            timed("references", lambda: client.ask("textDocument/references", {**place, "context": {"includeDeclaration": True}}))
            timed("semantic words, all", lambda: client.ask("textDocument/semanticTokens/full", {"textDocument": {"uri": uri}}))
            timed("symbols, all", lambda: client.ask("textDocument/documentSymbol", {"textDocument": {"uri": uri}}))
        client.end()
    aims = {"key stroke to diagnostics": "< 50 ms", "completion after a key stroke": "< 20 ms", "completion without a letter": "< 20 ms"}
    for name, all_times in times.items():
        print(f"{'lsp, ' + name:<44} {1000 * min(all_times):9.1f} ms   median {1000 * statistics.median(all_times):6.1f} ms{'':<25} {'aim ' + aims[name] if name in aims else ''}")


main()
