#!/usr/bin/python3
"""Prints the area of each glyph of a font with quadratic outlines, in units of the font: areas.py FONT > areas.txt

Needs python3-fonttools. The lines are `glyph area`; glyphs without an area are left out.

The signed area of a contour is a sum of rational numbers, one for each of its Beziers, and is exact. It is the area of the glyph if no point
has a winding number other than 0 and 1. Where contours overlap, the Beziers are cut where they cross each other, to 50 digits, and only
pieces with an outside on one of their sides are added.
"""

import sys
from decimal import Decimal, getcontext
from fractions import Fraction

from fontTools.pens.basePen import decomposeQuadraticSegment
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.ttLib import TTFont

getcontext().prec = 50
TINY = Decimal(10) ** -40


def exact(point):
    return tuple(Fraction(c) for c in point)


def contours_of(glyphs, name):
    """The contours of a glyph, each a list of Beziers (start, control, end). Lines have their middle as control point."""
    pen = DecomposingRecordingPen(glyphs)
    glyphs[name].draw(pen)
    contours = []
    for what, points in pen.value:
        if what == "moveTo":
            contours.append([])
            start = last = exact(points[0])
        elif what == "lineTo":
            to = exact(points[0])
            add_line(contours[-1], last, to)
            last = to
        elif what == "qCurveTo":
            if points[-1] is None:  # a contour without points on it
                p, q = exact(points[-2]), exact(points[0])
                contours.append([])
                start = last = tuple((a + b) / 2 for a, b in zip(p, q))
                points = tuple(points[:-1]) + (last,)
            for control, to in decomposeQuadraticSegment([exact(p) for p in points]):
                contours[-1].append((last, exact(control), exact(to)))
                last = exact(to)
        elif what == "closePath":
            add_line(contours[-1], last, start)
    return [c for c in contours if c]


def add_line(contour, a, b):
    if a != b:
        contour.append((a, tuple((x + y) / 2 for x, y in zip(a, b)), b))


def cross(p, q):
    return p[0] * q[1] - p[1] * q[0]


def area_of(bezier):
    """The integral of (x dy - y dx) / 2."""
    p, c, q = bezier
    return (2 * cross(p, c) + 2 * cross(c, q) + cross(p, q)) / 6


# --- Overlaps ---


def point_at(b, t):
    s = 1 - t
    return tuple(s * s * b[0][k] + 2 * s * t * b[1][k] + t * t * b[2][k] for k in (0, 1))


def slope_at(b, t):
    return tuple(2 * ((1 - t) * (b[1][k] - b[0][k]) + t * (b[2][k] - b[1][k])) for k in (0, 1))


def piece_of(b, t0, t1):
    """The Bezier from t0 to t1, by its blossom."""
    value = lambda s, t: tuple((1 - s) * (1 - t) * b[0][k] + (s * (1 - t) + t * (1 - s)) * b[1][k] + s * t * b[2][k] for k in (0, 1))
    return value(t0, t0), value(t0, t1), value(t1, t1)


def boxes_meet(a, b):
    return all(min(p[k] for p in a) <= max(p[k] for p in b) and min(p[k] for p in b) <= max(p[k] for p in a) for k in (0, 1))


def meet(a, b):
    """The pairs of parameters at which two Beziers meet."""
    found = []
    half = Decimal("0.5")

    def divide(s0, s1, t0, t1):
        p, q = piece_of(a, s0, s1), piece_of(b, t0, t1)
        if not boxes_meet(p, q):
            return
        if s1 - s0 > Decimal("0.01"):
            s, t = (s0 + s1) * half, (t0 + t1) * half
            for u in ((s0, s), (s, s1)):
                for v in ((t0, t), (t, t1)):
                    divide(*u, *v)
            return
        s, t = (s0 + s1) * half, (t0 + t1) * half
        for _ in range(60):
            x, y = point_at(a, s), point_at(b, t)
            u, v = slope_at(a, s), slope_at(b, t)
            w = (y[0] - x[0], y[1] - x[1])
            bottom = cross(u, v)
            if bottom == 0:
                return  # parallel
            ds, dt = cross(w, v) / bottom, cross(w, u) / bottom
            s, t = s + ds, t + dt
            if abs(s) > 2 or abs(t) > 2:
                return
            if abs(ds) < TINY and abs(dt) < TINY:
                break
        else:
            return
        if 0 <= s <= 1 and 0 <= t <= 1 and all(abs(s - f) > TINY * 1000 for f, _ in found):
            found.append((s, t))

    divide(Decimal(0), Decimal(1), Decimal(0), Decimal(1))
    return found


def winding(beziers, x, y):
    """The winding number of the outlines around a point that is not on them."""
    number = 0
    for p, c, q in beziers:
        a, b, e = p[1] - 2 * c[1] + q[1], 2 * (c[1] - p[1]), p[1] - y
        if abs(a) < TINY:
            roots = [-e / b] if b else []
        else:
            d = b * b - 4 * a * e
            roots = [(-b - d.sqrt()) / (2 * a), (-b + d.sqrt()) / (2 * a)] if d >= 0 else []
        for t in roots:
            if 0 <= t < 1 and point_at((p, c, q), t)[0] > x:
                number += 1 if 2 * a * t + b > 0 else -1
    return number


def decimals(bezier):
    return tuple(tuple(Decimal(c.numerator) / Decimal(c.denominator) for c in p) for p in bezier)


def area_of_overlapping(contours):
    beziers = [decimals(b) for c in contours for b in c]
    owner = [i for i, c in enumerate(contours) for _ in c]
    cuts = [{Decimal(0), Decimal(1)} for _ in beziers]
    for i, a in enumerate(beziers):
        for k in range(i):
            if owner[i] != owner[k] and boxes_meet(a, beziers[k]):
                for s, t in meet(a, beziers[k]):
                    cuts[i].add(s)
                    cuts[k].add(t)
    total = Decimal(0)
    crossed = any(len(c) > 2 for c in cuts)
    for b, where in zip(beziers, cuts):
        where = sorted(where)
        for s, t in zip(where, where[1:]):
            if t - s < Decimal(10) ** -20:
                continue
            # A point of the piece that is not its middle, because horizontal lines through middles may meet corners.
            at = s + (t - s) * Decimal("0.4375312")
            x, y = point_at(b, at)
            dx, dy = slope_at(b, at)
            far = Decimal(10) ** -12 / (dx * dx + dy * dy).sqrt()
            left, right = (winding(beziers, x - k * dy * far, y + k * dx * far) for k in (1, -1))
            if (left == 0) != (right == 0):
                total += area_of(piece_of(b, s, t)) * (1 if left else -1)
    return total, crossed


def main():
    font = TTFont(sys.argv[1])
    glyphs = font.getGlyphSet()
    for number, name in enumerate(font.getGlyphOrder()):
        contours = contours_of(glyphs, name)
        simple = -sum(area_of(b) for c in contours for b in c)  # TrueType outlines run clockwise
        united, crossed = area_of_overlapping(contours)
        whole = Decimal(simple.numerator) / Decimal(simple.denominator)
        area = united if crossed or abs(united - whole) > Decimal("1e-9") else whole
        if area:
            print(number, f"{area:.17g}")


main()
