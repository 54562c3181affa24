"""Evaluates both sides of the tables and of the pairs of scenes in docs/from-povray.md, and compares them.

    python3 povray_guide.py GUIDE CAG objects|values|scenes

Run in an empty folder. The bounds of the rows with the heads `POV-Ray object` and `cag solid` are compared, after an
exchange of y and z. The rows with the heads `POV-Ray value` and `cag value` are printed. Each block of POV-Ray is
followed by one of cag: their pictures are compared.
"""
import re
import subprocess
import sys

from openscad_guide import rows, run

TOLERANCE = 1e-4  # POV-Ray widens bounds a little
SIZE = (64, 48)
DIFFERENCE = 0.04  # rms of the linear light, which is mostly at the edges of so small a picture


def povray(scene, *options):
    """What the scene prints with #debug."""
    done = subprocess.run(["povray", f"+I{scene}", "-D", "-V", "+GA", *options], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{open(scene).read()}\n{done.stderr}")
    return re.findall(r"^@ (.*)$", done.stderr, re.M)


def report(pairs):
    """Prints the pairs of (what, found, expected), which are lists of numbers, that differ."""
    wrong = [p for p in pairs if len(p[1]) != len(p[2]) or any(abs(a - b) > TOLERANCE * max(1, abs(b)) for a, b in zip(p[1], p[2]))]
    for what, found, expected in wrong:
        print(f"{what}: cag gives {found}, and POV-Ray {expected}")
    print(f"{len(pairs)} pairs")
    return 1 if wrong or not pairs else 0


def numbers(line):
    return [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", line)]


def objects(table, cag):
    scene = "#version 3.7;\n" + "".join(
        f'#declare O = {left}\n#debug concat("@ ", vstr(3, min_extent(O), " ", 0, 6), " ", vstr(3, max_extent(O), " ", 0, 6), "\\n")\n'
        for left, _ in table)
    script = "".join(f"b{i} = bounds({right})\nprint b{i}.min, b{i}.max\n" for i, (_, right) in enumerate(table))
    open("objects.pov", "w").write(scene)
    open("objects.cag", "w").write(script)
    theirs = map(numbers, povray("objects.pov", "+W4", "+H3", "-F"))
    ours = map(numbers, run(cag, "run", "objects.cag").splitlines())
    return report([(left, a, [b[k] for k in (0, 2, 1, 3, 5, 4)]) for (left, _), a, b in zip(table, ours, theirs)])


def values(table, cag):
    open("values.pov", "w").write("#version 3.7;\n" + "".join(f'#debug concat("@ ", str({left}, 0, 6), "\\n")\n' for left, _ in table))
    open("values.cag", "w").write("".join(f"print {right}\n" for _, right in table))
    theirs = povray("values.pov", "+W4", "+H3", "-F")
    ours = run(cag, "run", "values.cag").splitlines()
    return report([(left, numbers(a), numbers(b)) for (left, _), a, b in zip(table, ours, theirs)])


def scenes(text, cag):
    pairs, wrong = re.findall(r"```pov\n(.*?)```\s+```cag\n(.*?)```", text, re.S), 0
    for left, right in pairs:
        open("theirs.pov", "w").write(left)
        open("ours.cag", "w").write(right)
        povray("theirs.pov", f"+W{SIZE[0]}", f"+H{SIZE[1]}", "+FE", "+A0.1", "+Otheirs.exr")
        run(cag, "render", "ours.cag", "-o", "ours.exr", "--size", f"{SIZE[0]}x{SIZE[1]}")
        done = subprocess.run([cag, "compare", "ours.exr", "theirs.exr", "--threshold", "10"], capture_output=True, text=True)
        rms = [float(x) for x in re.findall(r"^[RGB] +(\S+)", done.stdout, re.M)]
        if not rms or max(rms) > DIFFERENCE:
            print(f"{left}: the pictures differ by {rms}\n{done.stdout}{done.stderr}")
            wrong = 1
    print(f"{len(pairs)} pairs")
    return 1 if wrong or not pairs else 0


def main(guide, cag, part):
    text = open(guide).read()
    if part == "objects":
        return objects(rows(text, ["POV-Ray object", "cag solid"]), cag)
    if part == "values":
        return values(rows(text, ["POV-Ray value", "cag value"]), cag)
    return scenes(text, cag)


sys.exit(main(*sys.argv[1:]))
