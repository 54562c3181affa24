"""png_blur.py PICTURE APERTURE FOCUS DISTANCE FOV FRACTION [level]: fails unless an edge at the distance is blurred as by a thin lens.

The edge is vertical in the middle of the picture, or, with `level`, horizontal in the middle of a square one. The standard deviation of
the blur, in pixels, must be a quarter of the disk's diameter, with a relative tolerance of FRACTION. The location of the edge may deviate
by twice that.
"""
import math
import sys

from png_read import light, read

path, numbers = sys.argv[1], [float(x) for x in sys.argv[2:7]]
aperture, focus, distance, fov, share = numbers
width, height, channels, rows = read(path)
lines = [[light(row[x * channels]) for x in range(width)] for row in rows]
if "level" in sys.argv[7:]:
    lines = list(zip(*lines))
length = len(lines[0])
profile = [sum(line[x] for line in lines) / len(lines) for x in range(length)]
steps = [profile[x + 1] - profile[x] for x in range(length - 1)]
total = sum(steps)
middle = sum((x + 1) * s for x, s in enumerate(steps)) / total
found = math.sqrt(sum((x + 1 - middle) ** 2 * s for x, s in enumerate(steps)) / total)
disc = aperture * abs(distance - focus) / distance / (2 * focus * math.tan(math.radians(fov / 2))) * length
print(f"the smear is {found:.3f} pixels, expected {disc / 4:.3f}, at {middle:.3f}, expected {length / 2}")
sys.exit(abs(found - disc / 4) > share * disc / 4 or abs(middle - length / 2) > 2 * share * disc / 4)
