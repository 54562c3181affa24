#!/usr/bin/python3
"""Writes areas.txt and shapes.txt, the second source for tests/geom/letter_test.c.

areas.txt: a line for each glyph of the compiled-in fonts: the font, the number of the glyph, and the area within its outlines in units of
the font. It is the sum over the lines and quadratic curves that fontTools reads from the table glyf, with exact fractions. TrueType: filled
outlines run clockwise, holes counter-clockwise. What outlines that cross each other, such as a cedilla and its letter, have in common counts
once: its area is that of polygons along the curves (GEOS, by shapely) with N and 2 N sides per curve, extrapolated to infinitely many.

shapes.txt: for each text, a line with the font, the direction, and the text, and a line with what hb-shape prints: the numbers, offsets, and
advances of the glyphs.

Needs python3-fonttools, python3-shapely, and libharfbuzz-bin. Run it in the root of the project: /usr/bin/python3 tests/data/fonts/make.py
"""
import subprocess
from fractions import Fraction

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont
from shapely.geometry import LineString, Polygon
from shapely.ops import polygonize, unary_union

FOLDER = "tests/data/fonts"
STYLES = ["Regular", "Bold", "Italic", "BoldItalic"]
TEXTS = [
    ("ltr", "AVATAR To We. Ya, LTd"),
    ("ltr", "The quick brown fox jumps over the lazy dog"),
    ("ltr", "fi fl ffi office"),
    ("ltr", "e\u0301 o\u0308\u0323 A\u030a n\u0303 Z\u030c"),
    ("ltr", "\u00e9\u00f6\u1ebd \u0141\u00d3D\u0179 \u00c6\u0152 \u20ac25 \u00bd"),
    ("ltr", "\u0395\u03bb\u03bb\u03b7\u03bd\u03b9\u03ba\u03ac"),
    ("ltr", "\u041a\u0438\u0440\u0438\u043b\u043b\u0438\u0446\u0430"),
    ("rtl", "\u05e9\u05dc\u05d5\u05dd"),
    ("rtl", "\u05e9\u05c1\u05b8\u05dc\u05d5\u05b9\u05dd"),
    ("rtl", "\u05d1\u05b0\u05bc\u05e8\u05b5\u05d0\u05e9\u05b4\u05c1\u05d9\u05ea"),
    ("ttb", "AVA\u05d0"),
]


class AreaPen(BasePen):
    def __init__(self, glyphs):
        super().__init__(glyphs)
        self.area = Fraction(0)

    def _moveTo(self, p):
        self.start = p

    def add(self, *points):
        p = [tuple(Fraction(c) for c in q) for q in points]
        cross = lambda a, b: a[0] * b[1] - a[1] * b[0]
        if len(p) == 2:
            self.area += cross(p[0], p[1]) / 2
        else:  # the integral of (x dy - y dx) / 2 along a quadratic curve
            self.area += (2 * cross(p[0], p[1]) + 2 * cross(p[1], p[2]) + cross(p[0], p[2])) / 6

    def _lineTo(self, p):
        self.add(self._getCurrentPoint(), p)

    def _qCurveToOne(self, p, q):
        self.add(self._getCurrentPoint(), p, q)

    def _closePath(self):
        if self._getCurrentPoint() != self.start:
            self.add(self._getCurrentPoint(), self.start)


class PolygonPen(BasePen):
    def __init__(self, glyphs, sides):
        super().__init__(glyphs)
        self.contours, self.sides = [], sides

    def _moveTo(self, p):
        self.contours.append([p])

    def _lineTo(self, p):
        self.contours[-1].append(p)

    def _qCurveToOne(self, p, q):
        o = self._getCurrentPoint()
        for i in range(1, self.sides + 1):
            t = i / self.sides
            self.contours[-1].append(tuple((1 - t) ** 2 * o[k] + 2 * t * (1 - t) * p[k] + t * t * q[k] for k in (0, 1)))

    def _closePath(self):
        pass


def polygons(glyphs, name, sides):
    pen = PolygonPen(glyphs, sides)
    glyphs[name].draw(pen)
    return [Polygon(c) for c in pen.contours if len(c) > 2]


def cross(glyphs, name):
    p = polygons(glyphs, name, 8)
    return any(a.exterior.intersects(b.exterior) for i, a in enumerate(p) for b in p[:i])


def shared_area(glyphs, name, sides):
    """The area that is counted more than once."""
    p = polygons(glyphs, name, sides)
    sign = [-1 if q.exterior.is_ccw else 1 for q in p]
    total = 0
    for face in polygonize(unary_union([LineString(q.exterior.coords) for q in p])):
        winding = sum(s for s, q in zip(sign, p) if q.contains(face.representative_point()))
        total += face.area * (winding - (winding != 0))
    return total


with open(f"{FOLDER}/areas.txt", "w") as out:
    for style in STYLES:
        font = TTFont(f"fonts/Sans-{style}.ttf")
        glyphs = font.getGlyphSet()
        for number, name in enumerate(font.getGlyphOrder()):
            pen = AreaPen(glyphs)
            glyphs[name].draw(pen)
            area = float(-pen.area)
            if cross(glyphs, name):
                coarse, fine = shared_area(glyphs, name, 300), shared_area(glyphs, name, 600)
                area -= fine + (fine - coarse) / 3
            out.write(f"{style} {number} {area!r}\n")

with open(f"{FOLDER}/shapes.txt", "w") as out:
    for style in STYLES:
        for direction, text in TEXTS:
            shaped = subprocess.run(
                ["hb-shape", "--no-glyph-names", "--no-clusters", "--language=en", f"--direction={direction}", f"fonts/Sans-{style}.ttf", text],
                capture_output=True, text=True, check=True).stdout.strip()
            out.write(f"{style} {direction} {text}\n{shaped}\n")
