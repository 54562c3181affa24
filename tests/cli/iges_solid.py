#!/usr/bin/env python3
"""Checks the solids of an IGES file by the formulas of IGES 5.3, without Open CASCADE.

    iges_solid.py FILE      closes with `N solids, N faces, N traces, error E`

Each curve in the parameters of a surface must lead from the start of its edge to its end, along the edge, on the surface and within the
range of its angles; each loop must close; each edge must be used once in each direction. E is the largest distance in mm.
"""

import math
import sys

TURN = 2 * math.pi
ANGLES = 1e-6  # in degrees: beyond the range


def sub(a, b): return [x - y for x, y in zip(a, b)]
def dot(a, b): return sum(x * y for x, y in zip(a, b))
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
def along(p, *terms): return [x + sum(s * d[i] for s, d in terms) for i, x in enumerate(p)]
def unit(a): return [x / math.sqrt(dot(a, a)) for x in a]


def number(text):
    return float(text.replace("D", "e")) if "." in text else int(text)


def read(path):
    """The entities by their numbers: (type, form, matrix, parameters)."""
    directory, texts, out = {}, {}, {}
    for line in open(path):
        number_, section = int(line[73:80]), line[72]
        if section == "D": directory[number_] = [line[8 * i:8 * i + 8] for i in range(9)]
        if section == "P": texts[int(line[64:72])] = texts.get(int(line[64:72]), "") + line[:64].rstrip()
    for at in directory:
        if at % 2 == 0: continue
        first, second = directory[at], directory[at + 1]
        kind = int(first[0])
        parameters = [] if kind in (406, 314) else [number(x) for x in texts[at].rstrip(";").split(",")]
        assert not parameters or parameters[0] == kind
        out[at] = (kind, int(second[4]), int(first[6]), parameters[1:])
    return out


def basis(knots, degree, t):
    """The index of the first basis function that is not zero, and the values."""
    n = len(knots) - degree - 1
    span = degree
    while span < n - 1 and t >= knots[span + 1]: span += 1
    values = [1.0]
    for d in range(1, degree + 1):
        nxt = [0.0] * (d + 1)
        for i in range(d):
            left, right = knots[span + 1 + i - d], knots[span + 1 + i]
            w = values[i] / (right - left) if right > left else 0
            nxt[i] += (right - t) * w
            nxt[i + 1] += (t - left) * w
        values = nxt
    return span - degree, values


class File:
    def __init__(self, path):
        self.entities = read(path)

    def curve(self, at):
        """(start, end, function of the parameter) of a curve."""
        kind, form, matrix, p = self.entities[at]
        if kind == 110: return 0, 1, lambda t: along(p[:3], (t, sub(p[3:6], p[:3])))
        if kind == 126:
            n, degree = p[0] + 1, p[1]
            knots, weights = p[6:6 + n + degree + 1], p[7 + n + degree:7 + 2 * n + degree]
            points = [p[7 + 2 * n + degree + 3 * i:][:3] for i in range(n)]
            start, end = p[7 + 5 * n + degree:][:2]

            def spline(t):
                first, values = basis(knots, degree, t)
                w = [v * weights[first + i] for i, v in enumerate(values)]
                return [sum(w[i] * points[first + i][k] for i in range(len(w))) / sum(w) for k in range(3)]
            return start, end, spline
        m = self.entities[matrix][3]
        space = lambda x, y, z: [m[4 * i] * x + m[4 * i + 1] * y + m[4 * i + 2] * z + m[4 * i + 3] for i in range(3)]
        if kind == 100:
            z, cx, cy = p[:3]
            a, b = math.hypot(p[3] - cx, p[4] - cy), math.hypot(p[3] - cx, p[4] - cy)
            ends = p[3:7]
        else:
            assert kind == 104 and form == 1 and p[1] == p[3] == p[4] == 0, "another curve: %d" % kind
            z, cx, cy = p[6], 0, 0
            a, b = math.sqrt(-p[5] / p[0]), math.sqrt(-p[5] / p[2])
            ends = p[7:11]
        angle = lambda x, y: math.atan2((y - cy) / b, (x - cx) / a) % TURN
        start, end = angle(*ends[:2]), angle(*ends[2:])
        if end <= start + 1e-12: end += TURN
        return start, end, lambda t: space(cx + a * math.cos(t), cy + b * math.sin(t), z)

    def triple(self, at):
        assert self.entities[at][0] in (116, 123)
        return self.entities[at][3][:3]

    def surface(self, at):
        """(function of the parameters, range of the first or None, of the second or None)."""
        kind, form, matrix, p = self.entities[at]
        if kind == 120:
            axis = self.entities[p[0]][3]
            start, end, generatrix = self.curve(p[1])
            origin, z = axis[:3], unit(sub(axis[3:6], axis[:3]))

            def revolved(u, v):
                d = sub(generatrix(u), origin)
                h = dot(d, z)
                x = along(d, (-h, z))
                return along(origin, (h, z), (math.cos(v), x), (math.sin(v), cross(z, x)))
            return revolved, None, (p[2], p[3])
        if kind == 122:
            start, end, directrix = self.curve(p[0])
            side = sub(p[1:4], directrix(start))
            return lambda u, v: along(directrix(start + u * (end - start)), (v, side)), (0, 1), (0, 1)
        if kind == 128:
            return self.spline_surface(p)
        assert kind in (192, 196, 198) and form == 1, "another surface: %d" % kind
        o = self.triple(p[0])
        z, radii = (self.triple(p[2]), p[1:2]) if kind == 196 else (self.triple(p[1]), p[2:-1])
        x = self.triple(p[-1])
        y = cross(z, x)
        assert abs(dot(x, z)) < 1e-12 and abs(dot(x, x) - 1) < 1e-12 and abs(dot(z, z) - 1) < 1e-12

        def analytic(u, v):
            u, v = math.radians(u), v if kind == 192 else math.radians(v)
            if kind == 192: return along(o, (radii[0] * math.cos(u), x), (radii[0] * math.sin(u), y), (v, z))
            if kind == 198: u, v = -v, u
            r, h = (0, radii[0]) if kind == 196 else radii
            out = r + h * math.cos(v)
            return along(o, (out * math.cos(u), x), (out * math.sin(u), y), (h * math.sin(v), z))
        return analytic, None if kind == 198 else (0, 360), {192: None, 196: (-90, 90), 198: (0, 360)}[kind]

    def spline_surface(self, p):
        nu, nv, du, dv = p[0] + 1, p[1] + 1, p[2], p[3]
        at = 9
        knots_u, at = p[at:at + nu + du + 1], at + nu + du + 1
        knots_v, at = p[at:at + nv + dv + 1], at + nv + dv + 1
        weights, at = p[at:at + nu * nv], at + nu * nv
        points = [p[at + 3 * i:][:3] for i in range(nu * nv)]

        def spline(u, v):
            i0, bu = basis(knots_u, du, u)
            j0, bv = basis(knots_v, dv, v)
            total = [0.0] * 4
            for i, a in enumerate(bu):
                for j, b in enumerate(bv):
                    k = (j0 + j) * nu + i0 + i
                    w = a * b * weights[k]
                    total = [t + w * c for t, c in zip(total, points[k] + [1])]
            return [t / total[3] for t in total[:3]]
        return spline, None, None

    def edge(self, pointer, index):
        """(curve, first vertex, last vertex)."""
        p = self.entities[pointer][3]
        curve, list1, vertex1, list2, vertex2 = p[1 + 5 * (index - 1):][:5]
        return curve, (list1, vertex1), (list2, vertex2)

    def vertex(self, key):
        return self.entities[key[0]][3][1 + 3 * (key[1] - 1):][:3]

    def off_edge(self, at, p, t):
        """The distance of a point from a curve; t: its place, for splines, from 0 to 1."""
        kind, form, matrix, q = self.entities[at]
        start, end, f = self.curve(at)
        if kind == 126: return math.dist(f(start + t * (end - start)), p)
        if kind == 110:
            d = unit(sub(q[3:6], q[:3]))
            return math.dist(along(q[:3], (dot(d, sub(p, q[:3])), d)), p)
        low, high = start, end
        best = min((start + (end - start) * k / 720 for k in range(721)), key=lambda s: math.dist(f(s), p))
        low, high = best - (end - start) / 720, best + (end - start) / 720
        for _ in range(80):
            a, b = low + (high - low) / 3, high - (high - low) / 3
            if math.dist(f(a), p) < math.dist(f(b), p): high = b
            else: low = a
        return math.dist(f(low), p)

    def check_trace(self, surface, trace, edge, forward):
        s, range_u, range_v = surface
        start, end, c = self.curve(trace)
        worst = 0
        for k in range(9):
            u, v, _ = c(start + (end - start) * k / 8)
            for x, allowed in ((u, range_u), (v, range_v)):
                assert not allowed or allowed[0] - ANGLES <= x <= allowed[1] + ANGLES, "%g is out of range" % x
            p = s(u, v)
            if edge: worst = max(worst, self.off_edge(edge, p, k / 8 if forward else 1 - k / 8))
        return worst, s(*c(start)[:2]), s(*c(end)[:2])

    def check(self):
        worst, faces, traces, solids, used = 0, 0, 0, 0, {}
        for at, (kind, form, matrix, p) in self.entities.items():
            if kind == 186: solids += 1
            if kind != 510: continue
            faces += 1
            plane = self.entities[p[0]][0] == 190
            surface = None if plane else self.surface(p[0])
            for loop in p[3:3 + p[1]]:
                q, ends, i = self.entities[loop][3], [], 1
                for _ in range(q[0]):
                    point, pointer, index, forward, n = q[i:i + 5]
                    edge = None if point else self.edge(pointer, index)
                    first, last = ((pointer, index),) * 2 if point else edge[1:] if forward else edge[2:0:-1]
                    ends.append((self.vertex(first), self.vertex(last)))
                    if edge: used.setdefault((pointer, index), []).append((forward, at))
                    assert plane or n == 1
                    for k in range(n):
                        off, a, b = self.check_trace(surface, q[i + 6 + 2 * k], edge and edge[0], forward)
                        worst = max(worst, off, math.dist(a, ends[-1][0]), math.dist(b, ends[-1][1]))
                        traces += 1
                    i += 5 + 2 * n
                for k in range(len(ends)): worst = max(worst, math.dist(ends[k][0], ends[k - 1][1]))
        for edge, uses in used.items(): self.check_uses(edge, uses)
        print("%d solids, %d faces, %d traces, error %.2g" % (solids, faces, traces, worst))
        return worst

    def check_uses(self, edge, uses):
        """Outward, an edge has one use in each direction."""
        outward = {}
        for kind, form, matrix, p in self.entities.values():
            if kind == 514: outward.update((p[1 + 2 * i], p[2 + 2 * i]) for i in range(p[0]))
        assert sorted(forward == outward[face] for forward, face in uses) == [False, True], "edge %s: %s" % (edge, uses)


if __name__ == "__main__":
    sys.exit(File(sys.argv[1]).check() > 1e-5)
