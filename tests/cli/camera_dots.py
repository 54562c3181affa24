"""camera_dots.py PICTURE.png PIXELS: fails if the dots of a picture are not at the pixels that a file has as a list.

The dots are white on black. A pixel's linear brightness is the covered part of it, so the brightness-weighted mean of the
pixels around a dot is its center. Pixel [u, v] is measured from the upper left corner of the picture, v down.
"""
import json
import sys

import png_read

TOLERANCE = 2e-4  # of the width
REACH = 6  # pixels: dots are smaller, and farther from each other

width, height, channels, rows = png_read.read(sys.argv[1])
expected = json.load(open(sys.argv[2]))
worst = 0
for u, v in expected:
    weight = x = y = 0
    for r in range(max(0, int(v) - REACH), min(height, int(v) + REACH + 1)):
        for c in range(max(0, int(u) - REACH), min(width, int(u) + REACH + 1)):
            w = png_read.light(rows[r][channels * c])
            weight, x, y = weight + w, x + w * (c + 0.5), y + w * (r + 0.5)
    if weight < 3:
        sys.exit(f"there is no dot at [{u}, {v}]")
    worst = max(worst, abs(x / weight - u), abs(y / weight - v))
print(f"{len(expected)} dots, at most {worst:.4f} pixels from where they should be")
sys.exit(len(expected) == 0 or worst > TOLERANCE * width)
