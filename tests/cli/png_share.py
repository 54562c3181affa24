"""png_share.py PICTURE red|green|blue: prints the share of pixels in which this channel is at least twice each of the others."""
import sys

from png_read import read

width, height, channels, rows = read(sys.argv[1])
k = ["red", "green", "blue"].index(sys.argv[2])
count = 0
for row in rows:
    for x in range(width):
        pixel = row[x * channels:x * channels + 3]
        count += all(pixel[k] >= 2 * pixel[j] and pixel[k] > 0 for j in range(3) if j != k)
print(count / (width * height))
