#!/usr/bin/python3
"""Makes the fonts of this folder, with python3-fonttools: make.py, in this folder.

They have few glyphs of simple shapes, in 1000 units per em, and no H: the height of capitals is 0.7 em.

    A   a square of 600             O   a ring of 4 + 4 curves, without exact circles
    X   two overlapping bars        f i rectangles, of which "fi" has a wider one
    ~   an accent, U+0301           T V rectangles, kerned by -200

`Squares.ttf` has quadratic curves, `Squares.otf` cubic ones, and `Squares.ttc` both kinds of O: that of Squares.ttf and a wider font.
"""

from fontTools.feaLib.builder import addOpenTypeFeaturesFromString
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.t2CharStringPen import T2CharStringPen
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib.ttCollection import TTCollection

ADVANCES = {".notdef": 500, "space": 500, "A": 700, "O": 700, "X": 700, "f": 300, "i": 200, "f_i": 450, "T": 600, "V": 600, "acute": 0}
CHARACTERS = {0x20: "space", 0x41: "A", 0x4F: "O", 0x58: "X", 0x66: "f", 0x69: "i", 0x54: "T", 0x56: "V", 0x301: "acute"}
FEATURES = "feature liga { sub f i by f_i; } liga; feature kern { pos T V -200; } kern;"


def rectangle(pen, x0, y0, x1, y1):
    pen.moveTo((x0, y0))
    for p in ((x0, y1), (x1, y1), (x1, y0)):
        pen.lineTo(p)
    pen.closePath()


def ring(pen, r, control, clockwise, cubic):
    """A closed curve around (300, 300) whose control points are at `control` beside the ends (cubic), or in the corners."""
    ends = [(r, 0), (0, r), (-r, 0), (0, -r)]
    if clockwise:
        ends.reverse()
    place = lambda p: (300 + p[0], 300 + p[1])
    pen.moveTo(place(ends[0]))
    for a, b in zip(ends, ends[1:] + ends[:1]):
        near = lambda p, q: tuple(u + v * control // r for u, v in zip(p, q))
        if cubic:
            pen.curveTo(place(near(a, b)), place(near(b, a)), place(b))
        else:
            pen.qCurveTo(place((a[0] + b[0], a[1] + b[1])), place(b))
    pen.closePath()


def draw(pen, name, cubic, wide):
    if name == "A":
        rectangle(pen, 0, 0, 600 + wide, 600)
    elif name == "O":
        ring(pen, 300, 166, True, cubic)
        ring(pen, 200, 110, False, cubic)
    elif name == "X":
        rectangle(pen, 0, 200, 600, 400)
        rectangle(pen, 200, 0, 400, 600)
    elif name == "acute":
        rectangle(pen, -400, 650, -300, 700)
    elif name not in (".notdef", "space"):
        rectangle(pen, 0, 0, ADVANCES[name] - 50, 500 if name == "i" else 700)


def make(cubic, wide=0):
    names = list(ADVANCES)
    font = FontBuilder(1000, isTTF=not cubic)
    font.setupGlyphOrder(names)
    font.setupCharacterMap(CHARACTERS)
    glyphs = {}
    for name in names:
        pen = T2CharStringPen(ADVANCES[name], None) if cubic else TTGlyphPen(None)
        draw(pen, name, cubic, wide)
        glyphs[name] = pen.getCharString() if cubic else pen.glyph()
    if cubic:
        font.setupCFF("Squares", {}, glyphs, {})
    else:
        font.setupGlyf(glyphs)
    font.setupHorizontalMetrics({n: (ADVANCES[n] + (wide if n == "A" else 0), -400 if n == "acute" else 0) for n in names})
    font.setupHorizontalHeader(ascent=800, descent=-200, lineGap=100)
    font.setupNameTable({"familyName": "Squares", "styleName": "Regular"})
    font.setupOS2(sTypoAscender=800, sTypoDescender=-200, sTypoLineGap=100)
    font.setupPost(keepGlyphNames=False)
    addOpenTypeFeaturesFromString(font.font, FEATURES)
    font.font["head"].created = font.font["head"].modified = 0
    font.font.recalcTimestamp = False
    return font.font


make(False).save("Squares.ttf")
make(True).save("Squares.otf")
collection = TTCollection()
collection.fonts = [make(False), make(False, wide=400)]
collection.save("Squares.ttc")
