"""Compares the silhouettes of the two renderers, for each example that has a picture.

    python3 tests/bench/silhouettes.py build/cag [SCRIPT...]

Both draw the shapes, as far as the ground does not hide them, with a square of 4 x 4 rays for each pixel. The table
shows the area that the shapes cover in either picture, in pixels; the area that they cover in only one; and the
overlap, which is the area that they cover in both divided by that in either. Lens and motion blur are not part of a
silhouette.
"""
import glob
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import zlib

SIZE = (480, 270)
SIDE = 4  # rays of a pixel, across and down


def exr_header(data):
    at, header = 8, {}
    while data[at]:
        end = data.index(0, at)
        name, at = data[at:end].decode(), end + 1
        at = data.index(0, at) + 1
        (size,) = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return header, at + 1


def exr_channels(raw):
    at, names = 0, []
    while raw[at]:
        end = raw.index(0, at)
        names.append(raw[at:end].decode())
        at = end + 17
    return names


def exr_unpacked(data, size):
    """The bytes of a block of compression ZIP: differences, and even bytes before odd ones."""
    if len(data) == size:
        return data
    raw = bytearray(zlib.decompress(data))
    for i in range(1, size):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (size + 1) // 2
    out = bytearray(size)
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


def preview_coverage(path, ground_names):
    """How many rays of each pixel meet parts other than the ground, by the Cryptomatte ids of the picture."""
    data = open(path, "rb").read()
    header, at = exr_header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names = exr_channels(header["channels"])
    manifest = json.loads(next(v for k, v in header.items() if k.endswith("/manifest")))
    grounds = {id for name, id in manifest.items() if name in ground_names}
    ranks = [(names.index(f"CryptoObject0{k}.{id}"), names.index(f"CryptoObject0{k}.{cover}"))
             for k in range(3) for id, cover in ("rg", "ba")]
    lines = 16
    blocks = (height + lines - 1) // lines
    counts = bytearray(width * height)
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 + 1 - y)
        raw = exr_unpacked(data[offset + 8:offset + 8 + size], rows * len(names) * width * 4)
        for row in range(rows):
            def values(channel, kind):
                return struct.unpack_from(f"<{width}{kind}", raw, 4 * width * (row * len(names) + channel))
            cover = [0.0] * width
            for id, part in ranks:
                for x, (k, c) in enumerate(zip(values(id, "I"), values(part, "f"))):
                    if c > 0 and k != 0 and f"{k:08x}" not in grounds:
                        cover[x] += c
            line = (y - y0 + row) * width
            counts[line:line + width] = bytes(round(c * SIDE * SIDE) for c in cover)
    return counts


def povray_coverage(path):
    """The same from a picture in which each pixel is one ray, white where it meets a shape."""
    data = open(path, "rb").read()
    fine = SIZE[0] * SIDE
    pixels = data[-3 * fine * SIZE[1] * SIDE::3]
    counts = bytearray()
    for y in range(SIZE[1]):
        rows = [pixels[fine * (SIDE * y + k):fine * (SIDE * y + k + 1)] for k in range(SIDE)]
        counts += bytes(sum(row[SIDE * x + k] > 0 for row in rows for k in range(SIDE)) for x in range(SIZE[0]))
    return counts


def bare_scene(text):
    """The scene without sky, with white shapes and black grounds; and the names of the grounds."""
    grounds = re.findall(r"^// (.+): ground\b.*\n#declare (\w+) =", text, re.M)
    for _, declared in grounds:
        text = re.sub(r"(object \{\n  %s\n(?:  .*\n)*?)  material \{ M_\w+ \}" % declared, r"\1  pigment { rgb 0 }",
                      text)
    text = re.sub(r"^sky_sphere \{.*\n(?: .*\n)*\}\n", "", text, flags=re.M)
    text = re.sub(r"^background .*\n", "", text, flags=re.M)
    text = re.sub(r"material \{ M_\w+ \}", "pigment { rgb 1 }", text)
    text = re.sub(r"^  (aperture|blur_samples|focal_point|variance|confidence) .*\n", "", text, flags=re.M)
    return text, {name for name, _ in grounds}


def silhouettes(cag, script, work):
    picture, scene, fine = (os.path.join(work, name) for name in ("a.exr", "a.pov", "a.ppm"))
    arguments = re.search(r"^// run: (.*)$", open(script).read(), re.M)
    defined = re.findall(r"-D \S+", arguments.group(1)) if arguments else []
    defined = [word for pair in defined for word in pair.split()]
    quiet = dict(check=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    subprocess.run([cag, "render", script, "-o", picture, "--engine", "preview", "--quality", "draft", "--passes",
                    "object", "--size", "%dx%d" % SIZE, *defined], **quiet)
    subprocess.run([cag, "export", script, "-o", scene, *defined], **quiet)
    text, grounds = bare_scene(open(scene).read())
    open(scene, "w").write(text)
    subprocess.run(["povray", f"+I{scene}", f"+O{fine}", f"+W{SIZE[0] * SIDE}", f"+H{SIZE[1] * SIDE}", "+FP",
                    "-D", "-A", "+Q0", "-GA"], cwd=work, **quiet)
    return preview_coverage(picture, grounds), povray_coverage(fine)


def main():
    cag = os.path.abspath(sys.argv[1])
    scripts = sys.argv[2:] or sorted(s for s in glob.glob("examples/**/*.cag", recursive=True)
                                     if os.path.exists(s[:-3] + "png"))
    worst = 1
    for script in scripts:
        with tempfile.TemporaryDirectory() as work:
            try:
                preview, povray = silhouettes(cag, script, work)
            except (subprocess.CalledProcessError, StopIteration) as failed:
                print(f"{script:<44} -", str(getattr(failed, "stderr", b""))[-200:])
                continue
        both = sum(map(min, preview, povray)) / SIDE**2
        either = sum(map(max, preview, povray)) / SIDE**2
        overlap = both / either if either else 1
        worst = min(worst, overlap) if either else worst
        print(f"{script:<44} {either:7.0f} pixels {either - both:5.0f} differ  overlap {overlap:.4f}", flush=True)
    print(f"smallest overlap {worst:.4f}, target > 0.995")


if __name__ == "__main__":
    main()
