"""png_blur.py PICTURE APERTURE FOCUS DISTANCE FOV SHARE: fails unless a vertical edge at the distance is smeared as by a thin lens.

The standard deviation of the smear, in pixels, must be within SHARE of a quarter of the disc's diameter.
"""
import math
import sys

from png_read import light, read

path, numbers = sys.argv[1], [float(x) for x in sys.argv[2:]]
aperture, focus, distance, fov, share = numbers
width, height, channels, rows = read(path)
profile = [sum(light(row[x * channels]) for row in rows) / height for x in range(width)]
steps = [profile[x + 1] - profile[x] for x in range(width - 1)]
total = sum(steps)
middle = sum(x * s for x, s in enumerate(steps)) / total
found = math.sqrt(sum((x - middle) ** 2 * s for x, s in enumerate(steps)) / total)
disc = aperture * abs(distance - focus) / distance / (2 * focus * math.tan(math.radians(fov / 2))) * width
print(f"the smear is {found:.3f} pixels, expected {disc / 4:.3f}")
sys.exit(abs(found - disc / 4) > share * disc / 4)
