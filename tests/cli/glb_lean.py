"""glb_lean.py FILE DEGREES: fails if the angle between a triangle of a .glb and the normal at one of its corners exceeds DEGREES."""
import json
import math
import struct
import sys

data, most = open(sys.argv[1], "rb").read(), float(sys.argv[2])
(length,) = struct.unpack_from("<I", data, 12)
scene = json.loads(data[20:20 + length])


def numbers(index):
    a = scene["accessors"][index]
    view = scene["bufferViews"][a["bufferView"]]
    width = {"SCALAR": 1, "VEC3": 3}[a["type"]]
    kind = {5126: "f", 5125: "I", 5123: "H", 5121: "B"}[a["componentType"]]
    at = 28 + length + view.get("byteOffset", 0) + a.get("byteOffset", 0)
    flat = struct.unpack_from(f"<{a['count'] * width}{kind}", data, at)
    return [flat[k:k + width] for k in range(0, len(flat), width)]


count, worst = 0, 0
for mesh in scene["meshes"]:
    for part in mesh["primitives"]:
        if "NORMAL" not in part["attributes"]:
            continue
        points, normals = numbers(part["attributes"]["POSITION"]), numbers(part["attributes"]["NORMAL"])
        index = [k for (k,) in numbers(part["indices"])]
        for t in range(0, len(index), 3):
            a, b, c = (points[k] for k in index[t:t + 3])
            u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
            n = [u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2] for k in range(3)]
            size = math.hypot(*n)
            if size == 0:
                continue
            count += 1
            for k in index[t:t + 3]:
                cosine = sum(x * y for x, y in zip(n, normals[k])) / size
                worst = max(worst, math.degrees(math.acos(max(-1, min(1, cosine)))))
print(f"{count} triangles, one leans by {worst:.1f} degrees")
sys.exit(count == 0 or worst > most)
