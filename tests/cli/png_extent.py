"""png_extent.py PICTURE LEAST MOST: fails unless the dark part covers a fraction between these of the picture, horizontally or vertically."""
import sys

from png_read import read

width, height, channels, rows = read(sys.argv[1])
least, most = float(sys.argv[2]), float(sys.argv[3])
dark = [(x, y) for y, row in enumerate(rows) for x in range(width) if row[x * channels] < 128]
xs, ys = [x for x, _ in dark] or [0], [y for _, y in dark] or [0]
span = max((max(xs) - min(xs) + 1) / width, (max(ys) - min(ys) + 1) / height)
print(f"the shape spans {span:.2f} of the picture, expected {least}..{most}")
sys.exit(not least <= span <= most)
