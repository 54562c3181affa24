# Images as outputs and inputs: exports, files that are read again, damaged files, limits, and expected images.

script image.cag 'ramp = image(4, 2, (x, y) => (x + 4*y)/7)
show ramp'
script several.cag 'depth = image(3, 2, (x, y) => [x/3, y/7, none])
show depth, named(image([[0, 2]]), "mask")
show [depth, sphere(1)]'

it 'run tells of the images that a script shows'
try run several.cag
status 0
says 'depth: image, 3 x 2, channels r, g, b'
says 'mask: image, 2 x 1'

it 'the only image is exported as .exr and .png'
try export image.cag -o a.exr
status 0
prints_nothing
begins_with a.exr 762f3101
try export image.cag -o a.png
status 0
begins_with a.png 89504e47
no_temporaries .

it 'an export to standard output needs a format'
try export image.cag -o - --format exr
status 0
cmp -s out a.exr || wrong 'other bytes than in the file'

it 'of several images, --image selects one'
try export several.cag -o b.exr
status 2
says 'shows 3 images, expected one'
says 'select one by --image: depth, mask, depth.2'
is_missing b.exr
try export several.cag -o b.exr --image deepth
status 2
says 'shows no image named `deepth`'
try export several.cag -o b.exr --image depth
status 0
try export several.cag -o mask.png --image mask --range 0..4 --bits 16
status 0

it 'what was exported is read again: 32-bit floats to the bit'
script floats.cag 'values = [0.1, -1e30, 1e-45, 3.4028234e38, 16777217, 1/3, 0, none]
made = image(8, 1, (x, y) => [values[x], x, y])
show made'
try export floats.cag -o floats.exr
status 0
script again.cag 'show named(read_image("floats.exr"), "made")'
try export again.cag -o again.exr
status 0
cmp -s floats.exr again.exr || wrong 'the files differ'
try eval 'pixels(read_image("floats.exr", channels: ["r"]))'
status 0
prints_exactly '[[0.10000000149011612, -1.0000000150474662e30, 1.401298464324817e-45, 3.4028234663852886e38, 16777216, 0.3333333432674408, 0, none]]'

it 'channels keep their names and their order'
script names.cag 'show image([[[1, 2, 3, 4]]], channels: ["z", "R", "", "a"])'
try export names.cag -o names.exr
status 0
try eval '[read_image("names.exr").channels, pixels(read_image("names.exr"))]'
status 0
prints '["z", "R", "", "a"]'
prints '[[[1, 2, 3, 4]]]'

it 'codes of a .png are fractions of the largest'
try eval '[pixels(255*read_image("a.png"))[1], pixels(65535*read_image("mask.png"))]'
status 0
prints '[146, 182, 219, 255]'
prints '[[0, 32768]]'

it 'a picture that another program made' python3
cat > png.py << 'END'
import struct, zlib

def png(name, kind, bits, width, rows, more=b""):
    def chunk(tag, data):
        return struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))
    head = struct.pack(">IIBBBBB", width, len(rows), bits, kind, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows))
    with open(name, "wb") as f:
        f.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + more + chunk(b"IDAT", data) + chunk(b"IEND", b""))

def palette(*colors):
    data = bytes(x for c in colors for x in c)
    return struct.pack(">I", len(data)) + b"PLTE" + data + struct.pack(">I", zlib.crc32(b"PLTE" + data))

png("bits1.png", 0, 1, 4, [[0b10100000], [0b01010000]])
png("gray16.png", 0, 16, 1, [[0x12, 0x34]])
png("alpha.png", 4, 8, 1, [[51, 255]])
png("rgb.png", 2, 8, 1, [[0, 51, 255]])
png("palette.png", 3, 8, 2, [[1, 0]], palette((255, 0, 0), (0, 51, 255)))
png("huge.png", 0, 8, 131072, [[0]] * 2)
END
python3 png.py
try eval '[pixels(read_image("bits1.png")), pixels(65535*read_image("gray16.png"))]'
status 0
prints '[[1, 0, 1, 0], [0, 1, 0, 1]]'
prints '[[4660]]'
try eval '[pixels(read_image("alpha.png")), pixels(read_image("rgb.png")), pixels(read_image("palette.png"))]'
status 0
prints '[[[0.2, 1]]]'
prints '[[[0, 0.2, 1]]]'
prints '[[[0, 0.2, 1], [1, 0, 0]]]'
try eval 'read_image("huge.png")'
status 1
says 'cannot read'

it 'options that do not apply'
try export image.cag -o a.stl --image ramp
status 2
says '--image does not apply to a .stl file'
try export image.cag -o a2.exr --range 0..1
status 2
says '--range does not apply to a .exr file'
try export image.cag -o a2.exr --bits 8
status 2
for wrong in 1 1..0 0..0 a..b 0.. ..1 '' nan..1; do
  try export image.cag -o a2.png --range "$wrong"
  status 2
  says "'$wrong'"
done
try export image.cag -o a2.png --bits 12
status 2
says '8 and 16'
is_missing a2.png

it 'other formats have no image, and images no other formats'
try export image.cag -o a.stl
status 1
says 'shows no shape'
says 'to export an image'
try render image.cag -o r.png
status 1
says 'to export an image'
script two.cag 'show image([[[1, 2]]])'
try export two.cag -o two.png
status 2
says 'a PNG has 1, 3, or 4 channels, the image has 2'
is_missing two.png

it 'shapes beside images are exported as before'
try export several.cag -o several.stl
status 0
exists several.stl

it 'files that are no images'
echo hello > hello.png
: > empty.exr
mkdir folder.png
try eval 'read_image("hello.png")'
status 1
says 'expected an EXR or PNG picture'
try eval 'read_image("empty.exr")'
status 1
says 'the file is empty'
try eval 'read_image("folder.png")'
status 1
try eval 'read_image("none.png")'
status 1
says 'none.png'
try eval 'read_image("../none.png")'
status 1
says 'outside'

it 'damaged files are errors, never crashes' python3
cat > damage.py << 'END'
import random, subprocess, sys
random.seed(7)
cag = sys.argv[1]
bad = 0
for name in sys.argv[2:]:
    whole = open(name, "rb").read()
    for k in range(12):
        data = bytearray(whole)
        if k % 2:
            data = data[:random.randrange(len(data))]
        else:
            for _ in range(1 + k):
                data[random.randrange(len(data))] = random.randrange(256)
        open("damaged", "wb").write(data)
        r = subprocess.run([cag, "eval", "--max-memory=512M", "--max-time=10", 'read_image("damaged")'], capture_output=True)
        if r.returncode not in (0, 1, 5):
            print(name, k, r.returncode)
            bad += 1
sys.exit(bad > 0)
END
python3 damage.py "$CAG" a.png mask.png palette.png floats.exr names.exr > damage.out || wrong "$(cat damage.out)"

it 'images keep the limits'
try eval --max-memory 64M 'enlarge(image([[1]]), 4000)'
status 5
says 'memory limit'
try eval --max-memory 64M 'image(131072, 1000, (x, y) => 0)'
status 5
try eval --max-time 0.2 'image(20000, 5000, (x, y) => x + y)'
status 5
says 'time limit'
script large.cag 'show enlarge(image([[1]]), 3000)'
try export large.cag -o large.exr --max-memory 90M
status 5
is_missing large.exr
try export large.cag -o large.exr
status 0
try eval --max-memory 64M 'read_image("large.exr")'
status 5
says 'memory limit'

it 'an expected image is compared'
script expects.cag 'param k = 1
a = image([[0, 0.5*k], [1, none]])
show a
// expect image: expected.exr
// expect image a: expected.png'
try test expects.cag
status 1
prints 'expected.exr'
try test expects.cag --update
status 0
exists expected.exr
exists expected.png
try test expects.cag
status 0
try test expects.cag -D k=1.5
status 1
prints 'the image a is not as expected.exr: 1 of 4 numbers differ, by up to 0.25'
script wrong.cag 'show image([[1]])
// expect image: expected.exr'
try test wrong.cag
status 1
prints 'has 1 x 1 pixels, but expected.exr has 2 x 2'
script unnamed.cag 'show image([[1]])
// expect image b: expected.exr'
try test unnamed.cag
status 1
prints 'shows no image named `b`'
