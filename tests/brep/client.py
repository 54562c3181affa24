"""A client of cag-brep: starts it, sends requests, and reads the boundaries that it answers with (interp/kernel/protocol.h).

Curves and surfaces of boundaries can be evaluated, and `check_boundary` checks what all boundaries promise.
"""

import math
import os
import struct
import subprocess

PROTOCOL = 3
HELLO, RESULT, FAILURE = 1, 2, 3
EVALUATE, FILLET, CHAMFER, SHELL, OFFSET, DRAFT, SPLIT, IMPRINT, READ_STEP, READ_IGES = range(16, 26)
FAIL_INPUT, FAIL_METHOD, FAIL_CHECK, FAIL_EMPTY, FAIL_FILE = range(1, 6)
NONE = 0xFFFFFFFF
BOX, SPHERE, CYLINDER, TORUS, PRISM, REVOLUTION, HALF_SPACE, FACES, BODY, UNION, DIFFERENCE, INTERSECTION = range(1, 13)
POINT, LINE, CIRCLE, ELLIPSE, SPLINE_CURVE = range(5)
PLANE, CYLINDRICAL, CONICAL, SPHERICAL, TOROIDAL, SPLINE, REVOLVED, EXTRUDED = range(1, 9)
IDENTITY = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)


# --- writing ---

def u32(*values):
    return struct.pack("=%dI" % len(values), *values)


def f64(*values):
    return struct.pack("=%dd" % len(values), *values)


def text(value):
    value = value.encode() if isinstance(value, str) else value
    return u32(len(value)) + value


def moved(x, y, z):
    return (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z)


def solid(kind, fields, placement=IDENTITY):
    return u32(kind) + fields + f64(*placement)


def box(x, y, z, placement=IDENTITY):
    return solid(BOX, f64(x, y, z), placement)


def sphere(radius, placement=IDENTITY):
    return solid(SPHERE, f64(radius), placement)


def cylinder(height, bottom, top=None, placement=IDENTITY):
    return solid(CYLINDER, f64(height, bottom, bottom if top is None else top), placement)


def torus(major, minor, placement=IDENTITY):
    return solid(TORUS, f64(major, minor), placement)


def operation(kind, *solids, placement=IDENTITY):
    return solid(kind, u32(len(solids)) + b"".join(solids), placement)


def union(*solids, placement=IDENTITY):
    return operation(UNION, *solids, placement=placement)


def difference(*solids, placement=IDENTITY):
    return operation(DIFFERENCE, *solids, placement=placement)


def intersection(*solids, placement=IDENTITY):
    return operation(INTERSECTION, *solids, placement=placement)


def body(part, placement=IDENTITY):
    return solid(BODY, text(part.body), placement)


def line(start, end):
    """A line with its range, in a plane or in space."""
    length = math.dist(start, end)
    direction = [(b - a) / length for a, b in zip(start, end)]
    return u32(LINE) + f64(*start, *direction) + f64(0, length)


def arc(center, radius, first, last, x=(1, 0), y=(0, 1)):
    return u32(CIRCLE) + f64(*center, *x, *y, radius) + f64(first, last)


def ellipse(center, a, b, first, last):
    return u32(ELLIPSE) + f64(*center, 1, 0, 0, 1, a, b) + f64(first, last)


def spline(degree, points, knots, weights=None, span=None):
    fields = u32(SPLINE_CURVE, degree, bool(weights), len(points))
    for i, point in enumerate(points):
        fields += f64(*point) + (f64(weights[i]) if weights else b"")
    return fields + f64(*knots) + f64(*(span or (knots[0], knots[-1])))


def polygon(*points):
    return [line(a, b) for a, b in zip(points, points[1:] + points[:1])]


def region(*loops):
    return u32(len(loops)) + b"".join(u32(len(loop)) + b"".join(loop) for loop in loops)


def prism(area, along, placement=IDENTITY):
    return solid(PRISM, area + f64(*along), placement)


def revolution(area, first=0, last=2 * math.pi, placement=IDENTITY):
    return solid(REVOLUTION, area + f64(first, last), placement)


def flat_face(frame, area):
    return u32(1) + f64(*frame) + area


def spline_face(p, q, net, knots_u, knots_v, weights=None):
    fields = u32(0, SPLINE, p, q, bool(weights), len(net), len(net[0]))
    for i, row in enumerate(net):
        for k, point in enumerate(row):
            fields += f64(*point) + (f64(weights[i][k]) if weights else b"")
    return fields + f64(*knots_u, *knots_v)


def faces(*of, tolerance=1e-6, placement=IDENTITY):
    return solid(FACES, u32(len(of)) + b"".join(of) + f64(tolerance), placement)


# --- reading ---

class Fields:
    def __init__(self, data):
        self.data, self.at = data, 0

    def read(self, code, n=1):
        size = struct.calcsize("=" + code)
        values = struct.unpack_from("=%d%s" % (n, code), self.data, self.at)
        self.at += n * size
        return values if n != 1 else values[0]

    def u32(self):
        return self.read("I")

    def f64(self, n=1):
        return self.read("d", n)

    def text(self):
        size = self.u32()
        self.at += size
        return self.data[self.at - size:self.at]


def add(a, b, factor=1.0):
    return tuple(x + factor * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    size = math.sqrt(dot(a, a))
    return tuple(x / size for x in a)


def basis(knots, degree, t):
    """The span of t and the B-spline functions that are not 0 there (de Boor)."""
    n = len(knots) - degree - 1
    t = min(max(t, knots[degree]), knots[n])
    span = degree
    while span < n - 1 and knots[span + 1] <= t:
        span += 1
    values = [1.0]
    for p in range(1, degree + 1):
        following = [0.0] * (p + 1)
        for i in range(p):
            low, high = knots[span - p + 1 + i], knots[span + 1 + i]
            part = values[i] / (high - low)
            following[i] += (high - t) * part
            following[i + 1] += (t - low) * part
        values = following
    return span, values


class Curve:
    def __init__(self, fields, dimension):
        self.kind, self.dimension = fields.u32(), dimension
        vector = lambda: fields.f64(dimension)
        if self.kind == LINE:
            self.origin, self.direction = vector(), vector()
        elif self.kind in (CIRCLE, ELLIPSE):
            self.center, self.x, self.y = vector(), vector(), vector()
            self.a = fields.f64()
            self.b = self.a if self.kind == CIRCLE else fields.f64()
        elif self.kind == SPLINE_CURVE:
            self.degree, self.rational, n = fields.u32(), fields.u32(), fields.u32()
            self.points, self.weights = [], []
            for _ in range(n):
                self.points.append(vector())
                self.weights.append(fields.f64() if self.rational else 1.0)
            self.knots = fields.f64(n + self.degree + 1)
            assert all(self.knots[i] <= self.knots[i + 1] for i in range(len(self.knots) - 1)), "knots decrease"
            assert self.knots[0] == self.knots[self.degree] and self.knots[n] == self.knots[-1], "not clamped"
        else:
            assert self.kind == POINT and dimension == 3, "kind of curve %d" % self.kind

    def at(self, t):
        if self.kind == LINE:
            return add(self.origin, self.direction, t)
        if self.kind in (CIRCLE, ELLIPSE):
            return add(add(self.center, self.x, self.a * math.cos(t)), self.y, self.b * math.sin(t))
        span, values = basis(self.knots, self.degree, t)
        total, weight = (0.0,) * self.dimension, 0.0
        for i, value in enumerate(values):
            k = span - self.degree + i
            total = add(total, self.points[k], value * self.weights[k])
            weight += value * self.weights[k]
        return tuple(x / weight for x in total)


class Surface:
    def __init__(self, fields):
        self.kind = fields.u32()
        if self.kind in (PLANE, CYLINDRICAL, CONICAL, SPHERICAL, TOROIDAL):
            self.origin, self.x, self.y, self.z = (fields.f64(3) for _ in range(4))
            assert math.dist(cross(self.x, self.y), self.z) < 1e-12, "the frame is not right-handed"
        if self.kind in (CYLINDRICAL, SPHERICAL):
            self.radius = fields.f64()
        elif self.kind == CONICAL:
            self.radius, self.angle = fields.f64(2)
        elif self.kind == TOROIDAL:
            self.radius, self.minor = fields.f64(2)
        elif self.kind == SPLINE:
            self.p, self.q, self.rational, nu, nv = fields.read("I", 5)
            self.net, self.weights = [], []
            for _ in range(nu):
                row, weights = [], []
                for _ in range(nv):
                    row.append(fields.f64(3))
                    weights.append(fields.f64() if self.rational else 1.0)
                self.net.append(row)
                self.weights.append(weights)
            self.knots_u, self.knots_v = fields.f64(nu + self.p + 1), fields.f64(nv + self.q + 1)
            for knots, degree in ((self.knots_u, self.p), (self.knots_v, self.q)):
                assert knots[0] == knots[degree] and knots[-1] == knots[-degree - 1], "not clamped"
        elif self.kind == REVOLVED:
            self.origin, self.z = fields.f64(3), fields.f64(3)
            self.curve = Curve(fields, 3)
            self.first, self.last = fields.f64(2)
        elif self.kind == EXTRUDED:
            self.z = fields.f64(3)
            self.curve = Curve(fields, 3)
            self.first, self.last = fields.f64(2)
        else:
            assert self.kind == PLANE, "kind of surface %d" % self.kind

    def at(self, u, v):
        if self.kind == PLANE:
            return add(add(self.origin, self.x, u), self.y, v)
        if self.kind == SPLINE:
            a, us = basis(self.knots_u, self.p, u)
            b, vs = basis(self.knots_v, self.q, v)
            total, weight = (0.0,) * 3, 0.0
            for i, x in enumerate(us):
                for k, y in enumerate(vs):
                    w = x * y * self.weights[a - self.p + i][b - self.q + k]
                    total, weight = add(total, self.net[a - self.p + i][b - self.q + k], w), weight + w
            return tuple(x / weight for x in total)
        if self.kind == EXTRUDED:
            return add(self.curve.at(u), self.z, v)
        if self.kind == REVOLVED:
            arm = add(self.curve.at(v), self.origin, -1)
            along = dot(arm, self.z)
            across = add(arm, self.z, -along)
            turned = add(tuple(x * math.cos(u) for x in across), cross(self.z, across), math.sin(u))
            return add(add(self.origin, self.z, along), turned)
        radius, height = {
            CYLINDRICAL: lambda: (self.radius, v),
            CONICAL: lambda: (self.radius + v * math.sin(self.angle), v * math.cos(self.angle)),
            SPHERICAL: lambda: (self.radius * math.cos(v), self.radius * math.sin(v)),
            TOROIDAL: lambda: (self.radius + self.minor * math.cos(v), self.minor * math.sin(v)),
        }[self.kind]()
        round_about = add(tuple(x * math.cos(u) for x in self.x), self.y, math.sin(u))
        return add(add(self.origin, round_about, radius), self.z, height)

    def periods(self):
        full = 2 * math.pi
        return (full if self.kind in (CYLINDRICAL, CONICAL, SPHERICAL, TOROIDAL, REVOLVED) else None,
                full if self.kind == TOROIDAL else None)


class Edge:
    def __init__(self, fields):
        self.curve = Curve(fields, 3)
        self.first, self.last = fields.f64(2)
        self.start, self.end = fields.u32(), fields.u32()
        self.tolerance = fields.f64()


class Use:
    def __init__(self, fields):
        self.edge, self.reversed = fields.u32(), fields.u32()
        self.trace = Curve(fields, 2)


class Face:
    def __init__(self, fields):
        self.surface = Surface(fields)
        self.reversed = fields.u32()
        self.bounds = fields.f64(4)
        self.tolerance = fields.f64()
        self.loops = [[Use(fields) for _ in range(fields.u32())] for _ in range(fields.u32())]


class Part:
    """A solid of a result."""

    def __init__(self, fields):
        self.name = fields.text().decode()
        self.color = fields.f64(3) if fields.u32() else None
        self.original = fields.u32()
        if self.original != NONE:
            self.placement = fields.f64(12)
            return
        self.body = fields.text()
        self.volume, self.area = fields.f64(2)
        self.centroid = fields.f64(3)
        self.corners = [fields.f64(3) for _ in range(fields.u32())]
        self.edges = [Edge(fields) for _ in range(fields.u32())]
        self.faces = [Face(fields) for _ in range(fields.u32())]
        self.shells = [[fields.u32() for _ in range(fields.u32())] for _ in range(fields.u32())]

    def kinds(self, kind):
        """The indices of faces of a kind of surface."""
        return [i for i, face in enumerate(self.faces) if face.surface.kind == kind]

    def edge_kinds(self, kind):
        return [i for i, edge in enumerate(self.edges) if edge.curve.kind == kind]

    def middle(self, edge):
        edge = self.edges[edge]
        return edge.curve.at((edge.first + edge.last) / 2) if edge.curve.kind != POINT else self.corners[edge.start]

    def edge_near(self, *point):
        return min(range(len(self.edges)), key=lambda i: math.dist(self.middle(i), point))

    def plane_at(self, normal, distance):
        """The face of the plane normal . p = distance."""
        found = [i for i in self.kinds(PLANE) if abs(abs(dot(self.faces[i].surface.z, normal)) - 1) < 1e-9
                 and abs(dot(self.faces[i].surface.origin, normal) - distance) < 1e-6]
        assert len(found) == 1, "%d faces of the plane" % len(found)
        return found[0]

    def faces_of(self, edge):
        return [i for i, face in enumerate(self.faces) for loop in face.loops for use in loop if use.edge == edge]


class BrepFailure(Exception):
    def __init__(self, fields):
        self.reason, self.what = fields.u32(), fields.text().decode()
        self.edge, self.limit = fields.u32(), fields.f64()
        super().__init__("failure %d: %s" % (self.reason, self.what))


class Helper:
    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        kind, fields = self.receive()
        assert kind == HELLO
        self.protocol, self.version, self.kernel = fields.u32(), fields.text().decode(), fields.text().decode()

    def receive(self):
        head = self.process.stdout.read(16)
        assert len(head) == 16, "cag-brep ended"
        kind, size = struct.unpack("=2Q", head)
        data = self.process.stdout.read(size)
        assert len(data) == size, "cag-brep ended"
        return kind, Fields(data)

    def ask_raw(self, kind, data):
        self.process.stdin.write(struct.pack("=2Q", kind, len(data)) + data)
        self.process.stdin.flush()
        return self.receive()

    def ask(self, kind, *data):
        """The solids of the result, whose boundaries are checked."""
        answer, fields = self.ask_raw(kind, b"".join(data))
        if answer == FAILURE:
            raise BrepFailure(fields)
        assert answer == RESULT
        parts = [Part(fields) for _ in range(fields.u32())]
        assert fields.at == len(fields.data), "bytes after the result"
        for i, part in enumerate(parts):
            if part.original == NONE:
                check_boundary(part)
            else:
                assert part.original < i and parts[part.original].original == NONE
        return parts

    def one(self, kind, *data):
        parts = self.ask(kind, *data)
        assert len(parts) == 1, "%d solids" % len(parts)
        return parts[0]

    def fails(self, kind, *data):
        answer, fields = self.ask_raw(kind, b"".join(data))
        assert answer == FAILURE, "the request did not fail"
        failure = BrepFailure(fields)
        assert failure.what, "the failure has no message"
        return failure

    def close(self):
        self.process.stdin.close()
        return self.process.wait(timeout=20)


# --- what all boundaries promise ---

def polygon_area(points):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2


def trace_points(part, use, n):
    edge = part.edges[use.edge]
    points = [use.trace.at(edge.first + (edge.last - edge.first) * i / n) for i in range(n + 1)]
    return points[::-1] if use.reversed else points


def check_boundary(part):
    size = max(math.dist(a, b) for a in part.corners[:20] for b in part.corners) or 1
    size = max([size] + [math.dist(part.middle(i), part.corners[0]) for i in range(len(part.edges))])
    assert part.volume > 0 and part.area > 0
    uses = {}
    for edge in part.edges:
        if edge.curve.kind == POINT:
            assert edge.start == edge.end
            continue
        assert edge.first < edge.last
        near = edge.tolerance * 2 + 1e-6 * size
        assert math.dist(edge.curve.at(edge.first), part.corners[edge.start]) <= near, "an edge misses its first corner"
        assert math.dist(edge.curve.at(edge.last), part.corners[edge.end]) <= near, "an edge misses its last corner"
    volume = 0.0
    for face in part.faces:
        surface = face.surface
        assert face.loops, "a face has no loops"
        u0, u1, v0, v1 = face.bounds
        assert u0 < u1 and v0 < v1
        periods = surface.periods()
        area, points_of_loops = 0.0, []
        for loop in face.loops:
            assert loop, "a loop has no uses"
            points = []
            for i, use in enumerate(loop):
                edge = part.edges[use.edge]
                uses.setdefault(use.edge, []).append(use.reversed)
                piece = trace_points(part, use, 24)
                # The trace and the edge agree in space.
                for k, (u, v) in enumerate(piece):
                    fraction = k / 24
                    t = edge.first + (edge.last - edge.first) * (1 - fraction if use.reversed else fraction)
                    expected = part.corners[edge.start] if edge.curve.kind == POINT else edge.curve.at(t)
                    gap = math.dist(surface.at(u, v), expected)
                    assert gap <= edge.tolerance + face.tolerance + 1e-9 * size, "a trace is %g from its edge" % gap
                # The loop goes on where the last use ended, up to a period.
                following = trace_points(part, loop[(i + 1) % len(loop)], 1)[0]
                for axis, period in enumerate(periods):
                    jump = abs(following[axis] - piece[-1][axis])
                    if period:
                        jump = abs(jump - round(jump / period) * period)
                    room = (u1 - u0, v1 - v0)[axis]
                    seam = surface.kind in (SPLINE, EXTRUDED) and abs(jump - room) < 1e-3 * room
                    # Corners may be as far from the ends as the tolerance of the edges.
                    loose = edge.tolerance + part.edges[loop[(i + 1) % len(loop)].edge].tolerance
                    assert jump <= 1e-4 * room + 1e-6 + loose or seam, "a loop jumps by %g in the parameters" % jump
                following_corner = part.edges[loop[(i + 1) % len(loop)].edge]
                end = edge.start if use.reversed else edge.end
                start = following_corner.end if loop[(i + 1) % len(loop)].reversed else following_corner.start
                assert end == start, "a loop does not join at a corner"
                points += piece[:-1]
            area += polygon_area(points)
            points_of_loops.append(points)
        # The face is on the left of its loops, or on their right if it is reversed.
        assert (area > 0) != bool(face.reversed), "the face is on the wrong side of its loops"
        outer = abs(polygon_area(points_of_loops[0]))
        assert all(abs(polygon_area(points)) <= outer * 1.001 for points in points_of_loops), "the outer loop is not first"
        for points in points_of_loops:
            for u, v in points:
                assert u0 - 1e-3 * (u1 - u0) <= u <= u1 + 1e-3 * (u1 - u0), "a trace leaves the bounds"
                assert v0 - 1e-3 * (v1 - v0) <= v <= v1 + 1e-3 * (v1 - v0), "a trace leaves the bounds"
    for index in range(len(part.edges)):
        directions = sorted(uses.get(index, []))
        if part.edges[index].curve.kind == POINT:
            assert len(directions) == 1, "a degenerate edge has %d uses" % len(directions)
        else:
            assert directions == [0, 1], "an edge has the uses %s" % directions
    assert sorted(i for shell in part.shells for i in shell) == list(range(len(part.faces))), "shells and faces"
    return volume


def outward(part, index, u=None, v=None):
    """The outward normal of a face in the middle of its bounds, and the point there."""
    face = part.faces[index]
    u0, u1, v0, v1 = face.bounds
    u, v = (u0 + u1) / 2 if u is None else u, (v0 + v1) / 2 if v is None else v
    h, k = 1e-5 * (u1 - u0), 1e-5 * (v1 - v0)
    at = face.surface.at
    du = add(at(u + h, v), at(u - h, v), -1)
    dv = add(at(u, v + k), at(u, v - k), -1)
    normal = unit(cross(du, dv))
    return (tuple(-x for x in normal) if face.reversed else normal), at(u, v)
