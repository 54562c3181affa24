#!/usr/bin/env python3
"""Rounds edges of random solids without the kernel: fillets and chamfers by the ball on the mesh.

    rolled_solids.py CAG [SOLIDS [SEED]]   closes with `N passed, N failed, N skipped`

Solids are those of random_solids.py. The radius is small; all edges are rounded, or the longest half of them. A result must be watertight, and
its volume within the bounds that follow from the lengths and angles of the edges; or it is an error that is said to be one of this
kind. The table counts results and the reasons of errors. ROLLED_SHOW=1 prints each of them with its script.
"""

import collections
import os
import random
import sys
import tempfile
import time

sys.argv += ["10", "1"][len(sys.argv) - 2:] if len(sys.argv) < 4 else []
CAG, SOLIDS, SEED = os.path.abspath(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
os.environ["CAG_BREP"] = "/nonexistent"
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import random_solids as base  # noqa: E402

SHOW = "ROLLED_SHOW" in os.environ
NAMED = ("no-blend", "no-boundary", "rounding-too-large", "value", "limit")


def reason_of(told):
    return told.split("|")[0] if isinstance(told, str) else "done"


def judge(told, bounds, slack):
    if isinstance(told, str):
        return None if reason_of(told) in NAMED else told
    if not told["tight"]:
        return "the mesh is not watertight"
    if not bounds[0] - slack <= told["mesh"] <= bounds[1] + slack:
        return "the volume %.6g is not in %.6g .. %.6g" % (told["mesh"], *bounds)
    return None


def changes(rng, known, size):
    r = rng.uniform(0.01, 0.04) * size
    sharp = sorted(e["length"] for e in known["edges"] if e["bend"] != "smooth")
    longest = sharp[len(sharp) // 2] * (1 - 1e-9) if sharp else 0
    half = 'e => e.bend != "smooth" and e.length >= %.9f' % longest
    return (("fillet all", "fillet(G, %.4f)" % r, base.blend_bounds(known, r, False)),
            ("fillet half", "fillet(G, %.4f, edges: %s)" % (r, half), base.blend_bounds(known, r, False)),
            ("chamfer half", "chamfer(G, %.4f, edges: %s)" % (r, half), base.blend_bounds(known, r, True)))


HEAD = """import std.select
G = %s
told(H) = json({tight: is_watertight(tessellate(H)), mesh: volume(tessellate(H))})
"""
# The solid is measured by the mesh from which its edges are found.
FACTS = ("T = tessellate(G, tolerance: 1.5e-4 * norm(bounds(G).size)); "
         "print attempt(() => json({volume: volume(T), area: area(T), corners: len(corners_of(G)), "
         "edges: [for e in edges_of(G): {length: e.length, angle: e.angle / 1deg, bend: e.bend}]}), err => err.reason)")


def main():
    rng = random.Random(SEED)
    table, wrong, passed = collections.defaultdict(collections.Counter), [], 0
    slowest = collections.defaultdict(float)
    with tempfile.TemporaryDirectory() as folder:
        for number in range(SOLIDS):
            text, size = base.solid(rng)
            state = random.Random(rng.random())
            known = base.run(folder, HEAD % text + FACTS)
            if isinstance(known, str):
                table["edges"][known] += 1
                if known not in ("empty-shape", "limit"):
                    wrong.append((number, "edges", known, text))
                continue
            if not known["edges"]:
                table["edges"]["none"] += 1
                continue
            table["edges"]["done"] += 1
            for name, expression, bounds in changes(state, known, size):
                began = time.time()
                told = base.run(folder, HEAD % text + 'print attempt(() => told(%s), err => err.reason + "|" + err.message)' % expression)
                seconds = time.time() - began
                slowest[name] = max(slowest[name], seconds)
                fault = judge(told, bounds, 1e-4 * known["area"])
                table[name]["WRONG" if fault else reason_of(told)] += 1
                passed += not fault
                if SHOW:
                    print("%d %s: %s %.1f s %s\n    %s of %s" % (number, name, told if isinstance(told, str) else "done", seconds,
                                                              fault or "", expression, text), flush=True)
                if fault:
                    wrong.append((number, name, fault, "%s of %s" % (expression, text)))
    for name, counts in table.items():
        print("%-14s %s; %.1f s at most" % (name, ", ".join("%s %d" % item for item in counts.most_common()), slowest[name]))
    for number, name, fault, what in wrong:
        print("FAILED: solid %d, %s: %s: %s" % (number, name, fault, what))
    print("%d passed, %d failed, 0 skipped" % (passed, len(wrong)))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
