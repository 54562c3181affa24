"""stl_tube.py FILE RADIUS LENGTH TURN ...: fails unless a binary STL is one closed shell, the tube of a plane path.

The tube has twelve sides. At each corner, which turns by TURN degrees, the sides meet in the bisecting plane on the inside; a wedge of a
ball, in steps of at most 30 degrees, joins them on the outside. Open ends are flat.
"""
import collections
import math
import struct
import sys

SIDES = 12


def volume_of_tube(radius, length, turns):
    half = [(radius * math.cos(2 * math.pi * k / SIDES), radius * math.sin(2 * math.pi * k / SIDES))
            for k in range(-SIDES // 4, SIDES // 4 + 1)]
    pairs = list(zip(half, half[1:]))
    # The first moment of half of the section, and the integral of its squared width.
    moment = sum((x0 * y1 - x1 * y0) / 2 * (x0 + x1) / 3 for (x0, y0), (x1, y1) in pairs)
    squares = sum((y1 - y0) * (x0 * x0 + x0 * x1 + x1 * x1) / 3 for (x0, y0), (x1, y1) in pairs)
    volume = length * radius ** 2 * SIDES / 2 * math.sin(2 * math.pi / SIDES)
    for turn in turns:
        steps = math.ceil(turn * SIDES / 360 - 1e-9)
        volume += steps * math.sin(math.radians(turn) / steps) / 2 * squares - 2 * moment * math.tan(math.radians(turn) / 2)
    return volume


data = open(sys.argv[1], "rb").read()
radius, length, *turns = map(float, sys.argv[2:])
edges, parent, volume = collections.Counter(), {}, 0


def root(p):
    while parent.setdefault(p, p) != p:
        p = parent[p]
    return p


for at in range(84, len(data), 50):
    a, b, c = (struct.unpack_from("<3f", data, at + 12 + 12 * k) for k in range(3))
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
    for p, q in ((a, b), (b, c), (c, a)):
        edges[p, q] += 1
        parent[root(p)] = root(q)
open_edges = sum(n != 1 or edges[q, p] != 1 for (p, q), n in list(edges.items()))
shells = len({root(p) for p in parent})
expected = volume_of_tube(radius, length, turns)
print(f"{open_edges} edges without one neighbor, {shells} shells, volume {volume}, expected {expected}")
sys.exit(open_edges > 0 or shells != 1 or abs(volume - expected) > 1e-6 * expected)
