"""png_specks.py PICTURE: fails if single pixels are darker than both of their neighbors, horizontally or vertically."""
import sys

from png_read import read

NOTICED = 12  # of 255
width, height, channels, rows = read(sys.argv[1])


def green(x, y):
    return rows[y][x * channels + (1 if channels > 2 else 0)]


specks = [(x, y) for y in range(1, height - 1) for x in range(1, width - 1)
          if min(green(x - 1, y), green(x + 1, y)) - green(x, y) > NOTICED
          or min(green(x, y - 1), green(x, y + 1)) - green(x, y) > NOTICED]
print(f"{len(specks)} dark specks, such as at {specks[:4]}")
sys.exit(len(specks) > 0)
