#!/usr/bin/python3
"""Prints the glyphs of texts and their places, as other programs find them: shapes.py > shapes.txt, in the folder of the project.

Needs libharfbuzz-bin (hb-shape), libfribidi-bin (fribidi), python3-fonttools, fonts-dejavu-core, and fonts-urw-base35. A line is

    FONT | DIRECTION | TEXT as code points | GLYPH X Y ... | ADVANCE

with lengths in units of the font. `fribidi` finds the levels and the visual order of the text, fontTools the scripts, and hb-shape shapes
each run of one level and one script.
"""

import json
import subprocess
from unicodedata import combining

from fontTools.unicodedata import script as script_of

DEJAVU = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"
NIMBUS = "/usr/share/fonts/opentype/urw-base35/NimbusSans-Regular.otf"
STYLES = ["fonts/Sans-Regular.ttf", "fonts/Sans-Bold.ttf", "fonts/Sans-Italic.ttf", "fonts/Sans-BoldItalic.ttf"]

KERNED = ["AVATo We", "LTyA", "P.,A", "11 - 1", "ГУТА", "ΑΥΤΑ"]
MARKED = ["e\u0301", "q\u0308", "x\u0300\u0301", "m\u0323\u0302n", "ế"]
BOTH = ["abc אבג 123 (דה) x", "שנת 2024 (א)", "[א] b", "אב-12%", "a.ב.c", "א (b) ג", "12 אב 34", "שָׁלוֹם עוֹלָם", "כֹּל (1)"]
ARABIC = ["السلام عليكم", "العربية 123", "لا لله", "مُحَمَّد", "abc (عربي) x"]


def output(*command, text):
    return subprocess.run(command, input=text + "\n", capture_output=True, text=True, check=True).stdout


def scripts_of(text):
    """Punctuation and marks have the script of the letter before, or else that of the first letter."""
    found, last = [], None
    for c in text:
        own = script_of(c)
        if own not in ("Zyyy", "Zinh", "Zzzz"):
            last = own
        found.append(last)
    first = next((s for s in found if s), "Zyyy")
    return [s or first for s in found]


def visual_order(levels):
    """Rule L2 of Unicode Standard Annex 9. In contrast to `fribidi`, marks stay behind their letters: the shaper places them."""
    order = list(range(len(levels)))
    for level in range(max(levels), 0, -1):
        i = 0
        while i < len(order):
            k = i
            while k < len(order) and levels[order[k]] >= level:
                k += 1
            order[i:k] = reversed(order[i:k])
            i = max(k, i + 1)
    return order


def runs_of(text, direction):
    """The runs in visual order, each (start, end, level, script)."""
    if direction == "ttb":
        order, levels = range(len(text)), [0] * len(text)
    else:
        options = ["--" + direction] if direction != "auto" else []
        lines = output("fribidi", "--nopad", "--nobreak", "--novisual", "--vtol", "--levels", *options, text=text).splitlines()
        seen, levels = ([int(n) for n in line.split()] for line in lines)
        order = visual_order(levels)
        assert order == seen or any(combining(c) for c in text)
    scripts = scripts_of(text)
    runs = []
    for i in order:
        step = -1 if levels[i] % 2 else 1
        if runs and i == runs[-1][-1] + step and levels[i] == levels[runs[-1][0]] and scripts[i] == scripts[runs[-1][0]]:
            runs[-1].append(i)
        else:
            runs.append([i])
    return [(min(r), max(r) + 1, levels[r[0]], scripts[r[0]]) for r in runs]


def shape(font, text, direction):
    glyphs, pen = [], 0
    for start, end, level, script in runs_of(text, direction):
        way = direction if direction == "ttb" else "rtl" if level % 2 else "ltr"
        flags = ["--bot"] * (start == 0) + ["--eot"] * (end == len(text))
        found = output("hb-shape", "--output-format=json", "--no-glyph-names", f"--direction={way}", f"--script={script}", "--language=en",
                       f"--text-before={text[:start]}", f"--text-after={text[end:]}", *flags, f"--text={text[start:end]}", font, text="")
        for g in json.loads(found):
            x, y = g["dx"], g["dy"]
            if way == "ttb":
                y, pen = y - pen, pen - g["ay"]
            else:
                x, pen = x + pen, pen + g["ax"]
            glyphs.append(f"{g['g']} {x} {y}")
    points = " ".join(f"{ord(c):04X}" for c in text)
    print(f"{font} | {direction} | {points} | {' '.join(glyphs)} | {pen}")


def main():
    for font in STYLES:
        for text in KERNED + MARKED + BOTH:
            shape(font, text, "auto")
    for text in BOTH:
        shape(STYLES[0], text, "rtl")
        shape(STYLES[0], text, "ltr")
    shape(STYLES[0], "Ab c", "ttb")
    for font, texts in ((DEJAVU, KERNED[:3] + MARKED + BOTH + ARABIC + ["office ffl fi"]), (NIMBUS, KERNED[:3] + ["fi fl"])):
        for text in texts:
            shape(font, text, "auto")
    for text in ARABIC:
        shape(DEJAVU, text, "ltr")


main()
