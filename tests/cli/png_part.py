"""png_part.py WHOLE PART X Y: fails unless a picture is the part of another that begins at column X and row Y."""
import sys

from png_read import read

_, _, channels, whole = read(sys.argv[1])
width, height, _, part = read(sys.argv[2])
left, top = int(sys.argv[3]), int(sys.argv[4])
for y in range(height):
    expected = whole[top + y][left * channels:(left + width) * channels]
    if bytes(part[y]) != bytes(expected):
        sys.exit(f"row {y} differs")
