"""pov_facing.py FILE: fails if POV-Ray would shade a side of a triangle that its camera does not see.

POV-Ray reverses an interpolated normal that faces away from the ray. At every point of a triangle, the normal must therefore face the
camera if and only if the front of the triangle does. The file has one camera, which looks at meshes.
"""
import math
import re
import sys

LEAN = 15  # degrees between a triangle's normal and one of its corners: flat pieces of a smooth surface


def vectors(text, word):
    block = re.search(r"\b" + word + r" \{(.*?)\}", text, re.S).group(1)
    return [tuple(map(float, v.split(","))) for v in re.findall(r"<(.*?)>", block)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]


text = open(sys.argv[1]).read()
camera = re.search(r"\ncamera \{.*?\n\}", text, re.S).group(0)
location = vectors("x {" + re.search(r"location.*", camera).group(0) + "}", "x")[0]
direction = vectors("x {" + re.search(r"direction.*", camera).group(0) + "}", "x")[0]
parallel = "orthographic" in camera
count, wrong, worst = 0, 0, 0
for mesh in re.findall(r"mesh2 \{.*?\n\}", text, re.S):
    points, normals = vectors(mesh, "vertex_vectors"), vectors(mesh, "normal_vectors")
    shift = re.search(r"translate <(.*?)>", mesh)
    shift = [float(x) for x in shift.group(1).split(",")] if shift else [0, 0, 0]
    points = [[x + s for x, s in zip(p, shift)] for p in points]
    for triangle in vectors(mesh, "face_indices"):
        p, n = [points[int(k)] for k in triangle], [normals[int(k)] for k in triangle]
        rays = [direction if parallel else minus(q, location) for q in p]
        face = cross(minus(p[1], p[0]), minus(p[2], p[0]))
        size, seen = math.hypot(*face), dot(face, rays[0])
        if size == 0 or abs(seen) < 1e-4 * size * math.hypot(*rays[0]):
            continue  # seen edge-on, so it is invisible
        count += 1
        cosines = [dot(a, ray) / math.hypot(*ray) for a in n for ray in rays]
        wrong += any((c > 0) != (seen > 0) for c in cosines)
        worst = max(worst, max(math.degrees(math.acos(min(1, dot(face, a) / size))) for a in n))
print(f"{count} triangles, {wrong} shaded on the other side, one leans by {worst:.1f} degrees")
sys.exit(count == 0 or wrong > 0 or worst > LEAN)
