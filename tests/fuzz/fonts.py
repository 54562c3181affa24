#!/usr/bin/env python3
"""Sets texts in damaged fonts: each is used, or refused with an error of the script.

    fonts.py PROGRAM COUNT [SEED]      closes with `N passed, N failed, N skipped`

A batch of fonts is one test. The fonts of a batch that fails are kept.
"""

import glob
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile

BATCH = 25
HERE = os.path.dirname(os.path.abspath(__file__))
# Fonts of the project, and of the system where it has them: cubic outlines, Arabic letters, and collections.
SOURCES = [os.path.join(HERE, s) for s in ("../language/geometry/fonts/Squares.ttf", "../language/geometry/fonts/Squares.otf",
                                           "../language/geometry/fonts/Squares.ttc", "../../fonts/Sans-Regular.ttf", "../../fonts/Sans-BoldItalic.ttf")]
SYSTEM = ["/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf", "/usr/share/fonts/opentype/urw-base35/NimbusSans-Regular.otf",
          "/usr/share/fonts/opentype/urw-base35/Z003-MediumItalic.otf"]
TEXT = "AOX fi TV AVA\\u{301} \\u{5d0}\\u{5b8}1(x)"


def tables(data):
    """The places of the tables of a font, or nothing if there are none that can be read."""
    if len(data) < 12 or data[:4] == b"ttcf":
        return []
    found = []
    for k in range(struct.unpack(">H", data[4:6])[0]):
        record = data[12 + 16 * k : 28 + 16 * k]
        if len(record) == 16:
            found.append((record[:4], *struct.unpack(">II", record[8:])))
    return found


def place(data, rng):
    """A byte of the directory, of the head of a table, or of anything."""
    kind = rng.random()
    found = tables(data)
    if kind < 0.2 or not found:
        return rng.randrange(min(len(data), 400))
    _, start, length = rng.choice(found)
    if kind < 0.9 and length and start < len(data):
        return min(len(data) - 1, start + rng.randrange(min(length, rng.choice([16, 64, length]))))
    return rng.randrange(len(data))


def damaged(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 4, 16, 64])):
        at = place(data, rng)
        what = rng.random()
        if what < 0.7:
            data[at] = rng.choice([0, 1, 255, 127, 128, rng.randrange(256)])
        elif what < 0.85 and at + 2 <= len(data):
            data[at : at + 2] = rng.choice([b"\xff\xff", b"\x7f\xff", b"\x80\x00", b"\x00\x01"])
        elif what < 0.9:
            del data[at : at + rng.randrange(1, 20)]
        elif what < 0.94:
            del data[at + 1 :]
        else:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9)))
        if not data:
            data = bytearray(b"x")
    return data


def use_batch(program, folder, names):
    with open(os.path.join(folder, "use.cag"), "w") as f:
        f.write("use(name, text) = attempt(() => area(lettering(text, font: name, width: 20)), err => err.reason)\n")
        for name in names:
            f.write(f'print use("{name}", "{TEXT}"), use("{name}", "AX"), use("{name}", "fi")\n')
    options = ["--max-memory", "512M", "--max-time", "60"]
    try:
        done = subprocess.run([program, "run", *options, "use.cag"], cwd=folder, capture_output=True, text=True, errors="replace", timeout=180)
    except subprocess.TimeoutExpired:
        return "it hangs"
    good = done.returncode == 0 and len(done.stdout.splitlines()) == len(names)
    return None if good else f"status {done.returncode}: {done.stderr[-2000:]}"


def main():
    program, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    rng = random.Random(sys.argv[3] if len(sys.argv) > 3 else "1")
    files = SOURCES + [s for s in SYSTEM if os.path.exists(s)]
    sources = [open(s, "rb").read() for s in files]
    passed = failed = 0
    for _ in range(0, count, BATCH):
        folder = tempfile.mkdtemp(prefix="cag-fonts-")
        names = []
        for k in range(BATCH):
            which = rng.randrange(len(sources))
            names.append(f"f{k}{os.path.splitext(files[which])[1]}")
            with open(os.path.join(folder, names[-1]), "wb") as f:
                f.write(damaged(sources[which], rng))
        problem = use_batch(program, folder, names)
        if problem:
            failed += 1
            print(f"FAILED: fonts in {folder}: {problem}")
        else:
            passed += 1
            shutil.rmtree(folder)
    print(f"{passed} passed, {failed} failed, 0 skipped")
    return failed > 0


sys.exit(main())
