"""Evaluates both sides of the tables and of the pairs of scripts in docs/from-openscad.md, and compares them.

    python3 openscad_guide.py GUIDE CAG shapes|values|scripts

Run in an empty folder. The rows of tables with the heads `OpenSCAD` and `cag` are shapes if both cells are code and
nothing else: their volumes or areas are compared, and their bounds. The rows of tables with the heads `OpenSCAD value` and `cag value` are
printed. Each block of OpenSCAD is followed by one of cag: their volumes are compared.
"""
import re
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

FACETS = 80
TOLERANCE = 5e-3  # a ball of 80 facets lacks 2e-3 of its volume
NOT_SHAPES = ("$", "use ", "import(", "surface(", "openscad ", "assert(", "echo(")


def cells(line):
    return [c.strip().replace("\\|", "|") for c in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def rows(text, heads):
    """The rows below these heads whose cells are one piece of code each."""
    found, inside = [], False
    for line in text.splitlines():
        if not line.startswith("|"):
            inside = False
        elif cells(line) == heads:
            inside = True
        elif inside and all(re.fullmatch(r"`[^`]+`", c) for c in cells(line)):
            found.append([c[1:-1] for c in cells(line)])
    return found


def scripts(text):
    return re.findall(r"```openscad\n(.*?)```\s+```cag\n(.*?)```", text, re.S)


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def stl_points(path):
    data = open(path, "rb").read()
    if data.startswith(b"solid"):
        numbers = re.findall(rb"vertex (\S+) (\S+) (\S+)", data)
        return [tuple(map(float, p)) for p in numbers]
    (count,) = struct.unpack_from("<I", data, 80)
    corners = [struct.unpack_from("<9f", data, 84 + 50 * i + 12) for i in range(count)]
    return [c[k:k + 3] for c in corners for k in (0, 3, 6)]


def stl_bounds(path):
    axes = list(zip(*stl_points(path)))
    return [min(a) for a in axes] + [max(a) for a in axes]


def stl_volume(path):
    p = stl_points(path)
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
               for a, b, c in zip(p[::3], p[1::3], p[2::3])) / 6


def openscad_volume(name, script):
    open(f"{name}.scad", "w").write(f"$fn = {FACETS};\n{script}\n")
    run("openscad", "-o", f"{name}.stl", f"{name}.scad")
    return stl_volume(f"{name}.stl")


def compare_bounds(pairs):
    """Prints the pairs of (what, found, expected) whose bounds differ. Regions have no height."""
    wrong = 0
    for what, found, expected in pairs:
        half = len(found) // 2
        axes = range(2 if half == 2 or found[2] == found[5] else 3)
        found = [found[k] for k in axes] + [found[half + k] for k in axes]
        expected = [expected[k] for k in axes] + [expected[3 + k] for k in axes]
        if max(abs(a - b) for a, b in zip(found, expected)) > TOLERANCE * max(map(abs, expected)):
            print(f"{what}: cag gives the bounds {found}, and OpenSCAD {expected}")
            wrong = 1
    return wrong


def compare(pairs):
    """Prints the pairs of (what, found, expected) that differ."""
    wrong = [(w, a, b) for w, a, b in pairs if not abs(a - b) <= TOLERANCE * abs(b)]
    for what, found, expected in wrong:
        print(f"{what}: cag gives {found}, and OpenSCAD {expected}")
    print(f"{len(pairs)} pairs")
    return 1 if wrong or not pairs else 0


def main(guide, cag, part):
    text = open(guide).read()
    if part == "values":
        table = rows(text, ["OpenSCAD value", "cag value"])
        open("values.scad", "w").write("".join(f"echo({left});\n" for left, _ in table))
        open("values.cag", "w").write("".join(f"print {right}\n" for _, right in table))
        run("openscad", "-o", "values.echo", "values.scad")
        theirs = [line[len("ECHO: "):].strip('"') for line in open("values.echo").read().splitlines()]
        ours = [line.removesuffix("deg") for line in run(cag, "run", "values.cag").splitlines()]
        wrong = [(left, a, b) for (left, _), a, b in zip(table, ours, theirs) if a != b]
        for left, a, b in wrong:
            print(f"{left}: cag gives {a}, and OpenSCAD {b}")
        print(f"{len(table)} pairs")
        return 1 if wrong or not table or not len(table) == len(ours) == len(theirs) else 0
    with ThreadPoolExecutor(2) as pool:
        if part == "scripts":
            pairs = scripts(text)
            theirs = list(pool.map(openscad_volume, [f"script{i}" for i in range(len(pairs))], [left for left, _ in pairs]))
            for i, (_, right) in enumerate(pairs):
                open(f"script{i}.cag", "w").write(right)
                run(cag, "export", f"script{i}.cag", "-o", f"ours{i}.stl", "--tolerance", "0.002")
            return compare([(left, stl_volume(f"ours{i}.stl"), theirs[i]) for i, (left, _) in enumerate(pairs)])
        table = [r for r in rows(text, ["OpenSCAD", "cag"]) if not r[0].startswith(NOT_SHAPES)]
        open("shapes.cag", "w").write("".join(
            f"s{i} = {right}\nprint type_of(s{i}), if type_of(s{i}) == \"region\" then area(s{i}) else volume(s{i}), "
            f"bounds(s{i}).min, bounds(s{i}).max\n"
            for i, (_, right) in enumerate(table)))
        ours = [re.findall(r"[^\s\[\],]+", line) for line in run(cag, "run", "shapes.cag").splitlines()][:len(table)]
        flat = ["linear_extrude(1) " if kind == "region" else "" for kind, *_ in ours]
        theirs = pool.map(openscad_volume, [f"row{i}" for i in range(len(table))],
                          [f"{f}union() {{ {left}{'' if left.endswith('}') else ';'} }}" for f, (left, _) in zip(flat, table)])
        differ = compare([(left, float(size), v) for (left, _), (_, size, *_), v in zip(table, ours, theirs)])
        return differ | compare_bounds([(left, [float(x) for x in bounds], stl_bounds(f"row{i}.stl"))
                                        for i, ((left, _), (_, _, *bounds)) in enumerate(zip(table, ours))])


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
