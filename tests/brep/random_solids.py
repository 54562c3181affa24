#!/usr/bin/env python3
"""Changes random solids of 2 to 12 primitives: fillets, chamfers, shells, offsets, and drafts.

    random_solids.py CAG [SOLIDS [SEED [FIRST]]]   closes with `N passed, N failed, N skipped`

FIRST is the number of the first solid to try, from 0, so that several runs can share the solids of a seed.

Each change gives a watertight mesh, the same volume by the mesh as by the faces, and a volume within bounds that follow from the areas,
lengths, and angles of the solid; or it is an error that is said to be one of this kind. The table counts both.
"""

import json
import math
import os
import random
import subprocess
import sys
import tempfile
import time

CAG = os.path.abspath(sys.argv[1])
SOLIDS = int(sys.argv[2]) if len(sys.argv) > 2 else 10
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 1
FIRST = int(sys.argv[4]) if len(sys.argv) > 4 else 0
# Errors that a change may end in.
NAMED = ("no-blend", "no-boundary", "value", "thickness-too-large", "empty-shape", "limit")
VERBOSE = "RANDOM_VERBOSE" in os.environ
SECONDS = float(os.environ.get("RANDOM_SECONDS", 60))  # for one change; more is counted as a limit
LAYER = 3e-4  # tolerance of meshes in place of exact results, as a fraction of the size

HEAD = """import std.select
G = %s
told(H) = json({volume: volume(H), area: area(H), tight: is_watertight(tessellate(H)), mesh: volume(tessellate(H)), what: "{H}"})
"""


def primitive(rng):
    """A primitive of about 10 mm, and its smallest size."""
    a, b = rng.uniform(3, 10), rng.uniform(3, 10)
    shape, size = rng.choice((
        ("box([%.3f, %.3f, %.3f], centered: true)" % (a, b, (a + b) / 2), min(a, b)),
        ("cylinder(%.3f, %.3f, centered: true)" % (a, b / 2), min(a, b)),
        ("cone(%.3f, %.3f, centered: true)" % (a, b / 2), min(a, b)),
        ("sphere(%.3f)" % (a / 2), a),
        ("torus(%.3f, %.3f)" % (a / 2 + 1, a / 8 + 0.5), a / 4 + 1),
    ))
    # Half of them lie along the axes, as in parts that people make.
    if rng.random() < 0.5:
        shape = "rotate(%s, [%.3f, %.3f, %.3f], %.2fdeg)" % (shape, *(rng.uniform(-1, 1) for _ in range(3)), rng.uniform(5, 175))
    elif rng.random() < 0.5:
        shape = "rotate(%s, %s, 90deg)" % (shape, rng.choice("XY"))
    return "translate(%s, [%.3f, %.3f, %.3f])" % (shape, *(rng.uniform(-5, 5) for _ in range(3))), size


def solid(rng):
    text, size = primitive(rng)
    for _ in range(rng.randint(1, 11)):
        other, its = primitive(rng)
        text = "%s(%s, %s)" % (rng.choice(("union", "union", "difference")), text, other)
        size = min(size, its)
    return text, size


def run(folder, script):
    """What the script prints, as JSON; or the reason of the error; or None if it crashed or hung."""
    path = os.path.join(folder, "solid.cag")
    with open(path, "w") as file:
        file.write(script)
    try:
        done = subprocess.run([CAG, "run", "-q", "--max-time", "%g" % SECONDS, path], capture_output=True, text=True, timeout=SECONDS + 30)
    except subprocess.TimeoutExpired:
        return "hung"
    if done.returncode == 5:
        return "limit"
    if done.returncode:
        return "status %d: %s" % (done.returncode, done.stderr[:300])
    return json.loads(done.stdout) if done.stdout[:1] in "{[" else done.stdout.strip()


def facts(folder, text):
    # The set operation itself would be measured by its mesh.
    return run(folder, HEAD % text + 'E = attempt(() => exact(G), _ => G)\nprint attempt(() => json({volume: volume(E), area: area(E), exact: "{E}", height: bounds(G).size.z, size: norm(bounds(G).size), flat: len(filter(faces_of(G), select.vertical)), '
               'corners: len(corners_of(G)), edges: [for e in edges_of(E): {kind: e.kind, length: e.length, angle: e.angle / 1deg, bend: e.bend}]}), err => err.reason)')


def angle_between(edge):
    """The angle between the faces, from 0 to pi, at the middle of the edge."""
    return math.radians(min(edge["angle"], 360 - edge["angle"]))


def is_even(edge):
    """Whether the angle between the faces is the same along the edge."""
    return edge["kind"] in ("line", "circle")


def section(edge, r, chamfer, sharpest):
    """The largest area of a section that the ball of radius r does not reach, or a chamfer takes."""
    if edge["bend"] == "smooth":
        return 0
    angle = angle_between(edge)
    if chamfer:
        return r * r / 2 * (math.sin(angle) if is_even(edge) else 1)
    if not is_even(edge):
        angle = min(angle, sharpest)
    return r * r * (1 / math.tan(max(angle, 0.02) / 2) - (math.pi - angle) / 2)


def blend_bounds(known, r, chamfer):
    # Where the angle varies along an edge, it is supposed to reach that of the sharpest edge of this kind.
    sharpest = min((angle_between(edge) for edge in known["edges"] if not is_even(edge) and edge["bend"] != "smooth"), default=math.pi)
    most = 2 * sum(edge["length"] * section(edge, r, chamfer, sharpest) for edge in known["edges"]) + 10 * r**3 * known["corners"]
    return known["volume"] - most, known["volume"] + most


def changes(rng, known, size):
    """Name, expression, and bounds of the volume of each change."""
    r, t = rng.uniform(0.005, 0.03) * size, rng.uniform(0.02, 0.06) * size
    volume, area = known["volume"], known["area"]
    # Half of the edges, the longest ones.
    sharp = [edge["length"] for edge in known["edges"] if edge["bend"] != "smooth"]
    longest = 'e => e.bend != "smooth" and e.length >= %.9f' % (sorted(sharp)[len(sharp) // 2] * (1 - 1e-9)) if sharp else "none"
    lean = area * known["height"] * math.tan(math.radians(2))
    all_of_them = (
        ("fillet", "fillet(G, %.4f, edges: %s)" % (r, longest), blend_bounds(known, r, False)),
        ("chamfer", "chamfer(G, %.4f, edges: %s)" % (r, longest), blend_bounds(known, r, True)),
        ("shell", "shell(G, %.4f)" % t, (0, min(volume, 2 * area * t))),
        ("offset", "offset(G, %.4f)" % t, (volume, volume + 2 * area * t + 20 * t**3)),
        ("draft", "draft(G, 2deg, select.vertical, at: centroid(G))", (volume - lean, volume + lean)),
    )
    # Spheres and tori have no edges, and tilted solids nothing to draft.
    return [c for c in all_of_them if (sharp or c[0] not in ("fillet", "chamfer")) and (known["flat"] or c[0] != "draft")]


def is_exact(what):
    return what.startswith("exact")


def judge(told, bounds, known):
    """None if the result is right."""
    if isinstance(told, str):
        return None if told in NAMED else told
    if not told["tight"]:
        return "the mesh is not watertight"
    slack = 1e-9 * bounds[1] if is_exact(told["what"]) and is_exact(known["exact"]) else LAYER * known["size"] * known["area"]
    if not bounds[0] - slack <= told["volume"] <= bounds[1] + slack:
        return "the volume %.6g is not in %.6g .. %.6g" % (told["volume"], *bounds)
    # The mesh is within 1/1000 of the size.
    if abs(told["mesh"] - told["volume"]) > 0.1 * told["area"]:
        return "the mesh has the volume %.6g, the faces %.6g" % (told["mesh"], told["volume"])
    return None


def main():
    if not os.access(os.path.join(os.path.dirname(CAG), "cag-brep"), os.X_OK) and "CAG_BREP" not in os.environ:
        print("skipped: cag-brep is missing (Open CASCADE is not installed)")
        print("0 passed, 0 failed, 1 skipped")
        return 0
    rng = random.Random(SEED)
    table, wrong, passed = {}, [], 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(SOLIDS):
            text, size = solid(rng)
            state = random.Random(rng.random())
            if number < FIRST:
                continue
            known = facts(folder, text)
            if isinstance(known, str):
                outcome = known if known in NAMED else "WRONG"
                table.setdefault("exact", []).append((outcome, 0))
                wrong += [] if known in NAMED else [(number, "exact", known, text)]
                continue
            table.setdefault("exact", []).append(("done" if is_exact(known["exact"]) else "no-boundary", 0))
            for name, expression, bounds in changes(state, known, size):
                began = time.time()
                told = run(folder, HEAD % text + "print attempt(() => told(%s), err => err.reason)" % expression)
                fault = judge(told, bounds, known)
                if VERBOSE:
                    print(number, name, told if isinstance(told, str) else told["what"], "%.1f s" % (time.time() - began), fault or "", flush=True)
                outcome = "WRONG" if fault else told if isinstance(told, str) else "tier B" if is_exact(told["what"]) else "tier C"
                table.setdefault(name, []).append((outcome, time.time() - began))
                passed += not fault
                if fault:
                    wrong.append((number, name, fault, "%s of %s" % (expression, text)))
    outcomes = sorted({outcome for rows in table.values() for outcome, _ in rows})
    print("%-8s" % "" + "".join("%14s" % outcome for outcome in outcomes) + "%14s" % "seconds, most")
    for name, rows in table.items():
        print("%-8s" % name + "".join("%14d" % sum(o == outcome for o, _ in rows) for outcome in outcomes)
              + "%14.1f" % max(seconds for _, seconds in rows))
    for number, name, fault, what in wrong:
        print("FAILED: solid %d, %s: %s: %s" % (number, name, fault, what))
    print("%d passed, %d failed, 0 skipped" % (passed, len(wrong)))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
