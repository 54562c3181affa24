#!/usr/bin/env python3
"""Reads damaged pictures: each is read, or refused with an error of the script.

    pictures.py PROGRAM COUNT [SEED]      closes with `N passed, N failed, N skipped`

A batch of pictures is one test. The pictures of a batch that fails are kept.
"""

import os
import random
import shutil
import subprocess
import sys
import tempfile

BATCH = 50
HERE = os.path.dirname(os.path.abspath(__file__))
SOURCES = ["../language/images/ramp.exr", "../language/images/colors.exr", "../scenes/csg.png"]


def damaged(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 4, 16])):
        # Most of what can go wrong is in the head of a file.
        at = rng.randrange(min(len(data), rng.choice([64, 400, len(data)])))
        what = rng.random()
        if what < 0.6:
            data[at] = rng.choice([0, 255, 127, 128, rng.randrange(256)])
        elif what < 0.8:
            del data[at : at + rng.randrange(1, 20)]
        elif what < 0.9:
            del data[at + 1 :]
        else:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 9)))
        if not data:
            data = bytearray(b"x")
    return data


def read_batch(program, folder, names):
    with open(os.path.join(folder, "read.cag"), "w") as f:
        for name in names:
            f.write(f'print attempt(() => len(pixels(read_image("{name}"))), err => err.reason)\n')
    done = subprocess.run([program, "run", "--max-memory", "512M", "--max-time", "60", "read.cag"], cwd=folder, capture_output=True, text=True, errors="replace")
    good = done.returncode == 0 and len(done.stdout.splitlines()) == len(names)
    return None if good else f"status {done.returncode}: {done.stderr[-2000:]}"


def main():
    program, count = os.path.abspath(sys.argv[1]), int(sys.argv[2])
    rng = random.Random(sys.argv[3] if len(sys.argv) > 3 else "1")
    sources = [open(os.path.join(HERE, s), "rb").read() for s in SOURCES]
    endings = [os.path.splitext(s)[1] for s in SOURCES]
    passed = failed = 0
    for _ in range(0, count, BATCH):
        folder = tempfile.mkdtemp(prefix="cag-pictures-")
        names = []
        for k in range(BATCH):
            which = rng.randrange(len(sources))
            names.append(f"p{k}{endings[which]}")
            with open(os.path.join(folder, names[-1]), "wb") as f:
                f.write(damaged(sources[which], rng))
        problem = read_batch(program, folder, names)
        if problem:
            failed += 1
            print(f"FAILED: pictures in {folder}: {problem}")
        else:
            passed += 1
            shutil.rmtree(folder)
    print(f"{passed} passed, {failed} failed, 0 skipped")
    return failed > 0


sys.exit(main())
