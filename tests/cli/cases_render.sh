# Pictures by POV-Ray, small and fast; and a missing or failing POV-Ray.

script ball.cag 'print "frame {frame} of {frames}, time {time}"
show sphere(10) |> material({color: "#d04030"})
show camera(eye: [60, 0, 20], target: origin, fov: 30deg)
show camera(eye: [0, 0, 80], target: origin, up: Y, fov: 30deg) |> named("top")
show sun(direction: [-1, 1, -2])'
quick='--size 64x48 --quality draft'
mkdir temporary
TMPDIR=$PWD/temporary
export TMPDIR

it 'render writes a PNG' povray
try render ball.cag -o ball.png $quick
status 0
prints_exactly 'frame 0 of 1, time 0'
says_nothing
begins_with ball.png 89504e470d0a1a0a
no_temporaries temporary

it 'render writes an EXR, the same one twice' povray
try render ball.cag -o ball.exr $quick
status 0
begins_with ball.exr 762f3101
try render ball.cag -o again.exr $quick
try compare ball.exr again.exr
status 0

it 'the picture shows something' povray
script nothing.cag 'show sphere(0.001) |> translate([0, 0, 9000])
show camera(eye: [60, 0, 20], target: origin, fov: 30deg)'
try render nothing.cag -o nothing.exr $quick
try compare ball.exr nothing.exr --threshold 0.05
status 1

it 'the EXR tells what it is of' povray
grep -q -a 'cag.script' ball.exr || wrong 'no script in the header'
grep -q -a 'worldToCamera' ball.exr || wrong 'no camera in the header'

it '--size sets the size' povray
# Width and height are big-endian, after the first 16 bytes of a PNG.
[ "$(od -An -v -tx1 -j16 -N8 ball.png | tr -d ' \n')" = 0000004000000030 ] || wrong 'it is not 64 by 48'

it 'a camera is chosen by name' povray
try render ball.cag -o top.exr $quick --camera top
status 0
try compare ball.exr top.exr --threshold 0.02
status 1

it 'a misspelt camera gets the nearest'
printf earlier > kept.png
try render ball.cag -o kept.png $quick --camera tpo
status 2
says 'top'
holds kept.png earlier

it '--exposure brightens a PNG' povray
try render ball.cag -o bright.png $quick --exposure 2
status 0
try compare ball.png bright.png
status 1

it 'a picture may go to standard output' povray
try render ball.cag -o - --format png $quick
status 0
begins_with out 89504e470d0a1a0a
says 'frame 0 of 1'
no_temporaries temporary
try render ball.cag -o - $quick
status 2
says '--format'

it '--format and the ending of the output agree' povray
try render ball.cag -o again.png --format PNG $quick
status 0
exists again.png
try render ball.cag -o again.exr --format png $quick
status 2
says "--format png and the output 'again.exr' contradict each other"

it '--frames renders a film' povray
try render ball.cag -o 'film.%03d.png' --frames 1..2 $quick
status 0
prints_exactly 'frame 1 of 3, time 0.5
frame 2 of 3, time 1'
is_missing film.000.png
begins_with film.001.png 89504e470d0a1a0a
begins_with film.002.png 89504e470d0a1a0a

it '-D frames makes the film longer' povray
try render ball.cag -o 'part.%d.png' --frames 1..1 -D frames=5 $quick
status 0
prints_exactly 'frame 1 of 5, time 0.25'
exists part.1.png

it 'a film from standard input' povray
with_input ball.cag render - -o 'piped.%d.png' --frames 0..1 $quick
status 0
exists piped.0.png
exists piped.1.png

it 'a percent sign in a film is written twice' povray
try render ball.cag -o '100%%.%d.png' --frames 3..3 $quick
status 0
exists '100%.3.png'

for pattern in 'f.png' 'f.%s.png' 'f.%n.png' 'f.%d.%d.png' 'f.%04x.png' 'f.%*d.png' 'f.%99999999d.png' 'f.%04d.%s.png' 'f.%ld.png'; do
  it "the pattern $pattern is refused"
  try render ball.cag -o "$pattern" --frames 0..2 $quick
  status 2
  prints_nothing
  says '%04d'
done

it 'a pattern without --frames is refused'
try render ball.cag -o 'f.%04d.png' $quick
status 2
says '--frames'

it 'frames beyond the film are refused'
try render ball.cag -o 'f.%04d.png' --frames 0..5 -D frames=3 $quick
status 2
says '0..5'
try render ball.cag -o 'f.%04d.png' --frames 0..5 -D time=0.5 $quick
status 2

it 'a script that fails in a frame ends the film' povray
script breaks.cag 'assert frame < 1, "the second frame"
show sphere(10)'
try render breaks.cag -o 'breaks.%d.png' --frames 0..3 $quick
status 1
says 'the second frame'
exists breaks.0.png
is_missing breaks.1.png
is_missing breaks.2.png

it 'there is no progress on a pipe' povray
try render ball.cag -o quiet.png $quick
says_nothing

# Another program replaces POV-Ray; the earlier picture must be kept.
fake() {
  mkdir -p fake
  printf '#!/bin/sh\n%s\n' "$1" > fake/povray
  chmod +x fake/povray
}
printf earlier > kept.exr
# stand_in STATUS TEXT: checks the result of a render with it.
stand_in() {
  ran="cag render with the povray of this test"
  PATH=$PWD/fake:$PATH timeout 60 "$CAG" render ball.cag -o kept.exr $quick --engine povray > out 2> err
  code=$?
  check_end
  status "$1"
  says "$2"
  holds kept.exr earlier
  no_temporaries .
  no_temporaries temporary
}

it 'without POV-Ray, the built-in renderer is used'
mkdir nothing
ran='cag render without POV-Ray' && PATH=$PWD/nothing "$CAG" render ball.cag -o built_in.exr --size 64x48 > out 2> err
code=$?
status 0
exists built_in.exr
try render ball.cag -o built_in_here.exr --size 64x48 --engine preview
try compare built_in.exr built_in_here.exr
status 0

# --- The built-in renderer ---
it 'previews are the same for any number of threads, and in parts'
script glass.cag 'show sphere(8) |> material({color: "white", transmission: 1, ior: 1.5})
show box([20, 20, 2]) |> translate([-10, -10, -11]) |> material({color: "teal", roughness: 0.1})
show torus(14, 2) |> material({color: "gold", metallic: 1, roughness: 0.2})'
for quality in draft normal; do
  try render glass.cag -o one.exr --engine preview --quality $quality --size 96x64 --threads 1
  status 0
  try render glass.cag -o two.exr --engine preview --quality $quality --size 96x64 --threads 2
  try compare one.exr two.exr
  status 0
done
try render glass.cag -o whole.png --engine preview --size 96x64
try render glass.cag -o part.png --engine preview --size 96x64 --region 40x30+20+10
python3 "$here/png_part.py" whole.png part.png 20 10 > part || wrong "$(cat part)"

it 'a preview of POV-Ray drafts looks the same' povray
script clean.cag 'show sphere(10) |> translate([0, 0, 10]) |> material({color: "tomato", roughness: 0.4})
show box([12, 12, 12]) |> translate([14, -4, 0]) |> material({color: "#dddddd", roughness: 1})
show ground()
show point_light([-60, -90, 120])'
for engine in povray preview; do
  try render clean.cag -o clean_$engine.exr --engine $engine --quality draft --size 160x120
  status 0
done
try compare clean_povray.exr clean_preview.exr
color=$(sed -n 's/^color difference (CIEDE2000): mean \([0-9.e-]*\),.*/\1/p' out)
awk "BEGIN { exit !(${color:-9} < 0.5) }" || wrong "the mean color difference is ${color:-missing}"

it 'passes are layers of one file'
script parts.cag 'ball = sphere(10) |> translate([0, 0, 10])
plate = box([60, 60, 4]) |> translate([-30, -30, -4])
param r = 2
show ball
show plate
show torus(16, r) |> translate([0, 0, 2]) |> named("ring")
show camera(eye: [0, 0, 200], target: origin, up: Y, kind: "orthographic", width: 80)'
try render parts.cag -o parts.exr --passes color,depth,normal,object,material,uv,curvature --size 80x80
status 0
script seen.cag 'img = read_image("parts.exr")
at(name, x, y) = pixel(channel(img, name), x, y)
// The top of the ball is 180 mm from the eye, its normal is up, and its curvature 1/10 and 1/100.
print round(at("depth.Z", 40, 40), 1), round(at("normal.Z", 40, 40), 2), round(at("curvature.mean", 40, 40), 2), round(at("curvature.gaussian", 40, 40), 3)
// The depth of the floor next to the plate, and no material of it is that of the plate.
print round(at("depth.Z", 12, 40), 1)
// Beyond the edge, the first part of the pixel covers all of it.
print at("CryptoObject00.g", 40, 40), at("CryptoObject00.a", 40, 40)'
try run seen.cag
status 0
prints '180 1 0.1 0.01'
prints '200'
prints '1 0'

it 'curvature is that of the exact surfaces'
script bends.cag '// In a row, seen from above; pixel [20 + x, 30] shows the point [x, 0].
show scale(sphere(10), [1, 1, 2])
show torus(10, 4) |> translate([30, 0, 0])
show (box([24, 24, 10]) |> translate([-12, -12, -10])) - sphere(8) |> translate([60, 0, 0])
show revolve(region(circle(4, center: [10, 0]))) |> translate([90, 0, 0])
show surface((x, y) => [x, y, x*y/20], u: -10..10, v: -10..10) |> translate([120, 0, 0])
show line_style(line([140, 0], [160, 0]), radius: 5)
show line_style(polyline([[180, 0, 0], [190, 0, 0], [190, 9, 0]]), radius: 8)
show camera(eye: [89.5, 0.5, 400], target: [89.5, 0.5, 0], up: Y, kind: "orthographic", width: 220)'
try render bends.cag -o bends.exr --passes curvature,depth --size 220x60
status 0
script bent.cag 'img = read_image("bends.exr")
at(name, x) = round(pixel(channel(img, name), x + 20, 30), 5) + 0
// An ellipsoid with the semiaxes 10, 10, and 20: at its end, both principal curvatures are 20/10^2.
print at("curvature.mean", 0), at("curvature.gaussian", 0)
// The top of a torus, where it touches a plane along a circle: 1/4 and 0. The second one is a body of revolution.
print at("curvature.mean", 40), at("curvature.gaussian", 40)
print at("curvature.mean", 100), at("curvature.gaussian", 100)
// The hollow of a subtracted ball of radius 8: -1/8 twice.
print at("curvature.mean", 60), at("curvature.gaussian", 60)
// The saddle z = xy/20 has the principal curvatures 1/20 and -1/20 in the middle.
print at("curvature.mean", 120), at("curvature.gaussian", 120)
// A rod of radius 5: 1/5 and 0.
print at("curvature.mean", 150), at("curvature.gaussian", 150)'
try run bent.cag
status 0
prints_exactly '0.2 0.04
0.125 0
0.125 0
-0.125 0.01563
0 -0.0025
0.1 0'

it 'curves with corners have round ends in previews, and straight lines flat ones'
script ends.cag 'img = read_image("bends.exr")
at(name, x) = pixel(channel(img, name), x + 20, 30)
// 4 mm beyond the end of the rod of radius 8, its ball is sqrt(8^2 - 4^2) high.
print near(at("depth.Z", 176), 400 - sqrt(48), 1e-4), at("curvature.gaussian", 176)
// 1 mm beyond the end of the line is nothing but the floor.
print at("depth.Z", 161) > 410'
try run ends.cag
status 0
prints_exactly 'true 0.015625
true'

it 'previews show a panorama where POV-Ray does'
script panorama.cag 'show image(64, 32, (x, y) => [x / 64, y / 32, 0.5], channels: ["R", "G", "B"])'
try export panorama.cag -o panorama.exr
status 0
script under_sky.cag 'show sphere(10) |> material({color: "white", metallic: 1, roughness: 0})
show sphere(10) |> translate([0, 25, 0]) |> material({color: "gray", roughness: 1})
show sky("panorama.exr")
show camera(eye: [70, 12, 20], target: [0, 12, 0], fov: 60deg)
show camera(eye: [0, 90, 0], target: [0, 100, 0], fov: 20deg) |> named("along_y")'
try render under_sky.cag -o along_y.exr --engine preview --camera along_y --size 33x33
status 0
script toward_y.cag 'img = read_image("along_y.exr")
// +Y is between the pixels 15 and 16 of a row, and the horizon between rows 15 and 16.
print near(pixel(img, 16, 16)[0], 15.5/64, 1e-3), near(pixel(img, 16, 16)[1], 15.5/32, 1e-3)
// +X is to the right, where the panorama begins.
print pixel(img, 30, 16)[0] < pixel(img, 2, 16)[0]'
try run toward_y.cag
status 0
prints_exactly 'true true
true'

it 'a preview under a panorama looks like the picture of POV-Ray' povray
for quality in draft normal; do
  for engine in povray preview; do
    try render under_sky.cag -o sky_$engine.exr --engine $engine --quality $quality --size 160x120
    status 0
  done
  try compare sky_povray.exr sky_preview.exr
  color=$(sed -n 's/^color difference (CIEDE2000): mean \([0-9.e-]*\),.*/\1/p' out)
  awk "BEGIN { exit !(${color:-9} < 0.5) }" || wrong "the mean color difference is ${color:-missing}"
done

it 'a pattern moves with its solid in previews'
script grain.cag 'import std.materials as mat
param turn = 0
turned(x) = rotate(x, Z, turn * 1deg)
show turned(box([40, 30, 10]) |> translate([5, 3, 0])) |> material(mat.clay)
show turned(sphere(12) |> translate([-25, 0, 0])) |> material(mat.concrete)
show turned(sun(direction: [-1, -2, -3]))
show turned(camera(eye: [30, -80, 60], target: origin, fov: 50deg))'
for turn in 0 40; do
  try render grain.cag -o grain_$turn.exr --engine preview --quality draft --size 120x90 -D turn=$turn
  status 0
done
try compare grain_0.exr grain_40.exr --threshold 1e-4
status 0

it 'patterns of previews vary as much as those of POV-Ray' povray
for name in wood marble concrete clay; do
  script pattern.cag "import std.materials as mat
show ground() |> material({...mat.$name, texture_scale: 8, coat: 0})
show sun(direction: [-1, -1, -1])
show camera(eye: [0, 0, 200], target: origin, up: Y, kind: \"orthographic\", width: 320)"
  for engine in povray preview; do
    try render pattern.cag -o pattern_$engine.exr --engine $engine --quality draft --size 320x240
    status 0
  done
  script spread.cag 'values(path) = flatten(pixels(resize(channel(read_image(path), "r"), width: 80, height: 60)))
mean(v) = sum(v) / len(v)
spread(v, m) = sqrt(mean([for x in v: (x - m)^2]))
a = values("pattern_povray.exr")
b = values("pattern_preview.exr")
print abs(mean(a) / mean(b) - 1) < 0.05, abs(spread(a, mean(a)) / spread(b, mean(b)) - 1) < 0.35'
  try run spread.cag
  prints_exactly 'true true'
done

it 'compare shows which part differs'
try render parts.cag -o before.exr --passes color,object --size 80x80
try render parts.cag -o after.exr --passes color,object --size 80x80 -D r=3
try compare before.exr after.exr --passes --threshold 0.02
status 1
# The areas of the rings as seen from above, one pixel a square millimeter: 2 pi 16 times 4 and 6.
awk '$1 == "ring" { exit !($2 > 400 && $2 < 404 && $3 > 600 && $3 < 606) }' out || wrong "the ring covers: $(grep ring out)"
try compare before.exr before.exr --passes
status 0
try compare parts.exr "$here/../../examples/vase.png" --passes
status 2
says 'do not tell which parts they show'
# The hash of "hello" is a known value of MurmurHash3.
script hello.cag 'show sphere(1) |> named("hello")'
try render hello.cag -o hello.exr --passes object --size 8x8
grep -a -q '"hello":"248bfa47"' hello.exr || wrong 'the manifest has another hash'

it 'a preview that is stopped is kept if it is asked for'
script long.cag 'show [for i in 0..20: sphere(8) |> translate([(i % 5)*14, floor(i/5)*14, 0])]'
"$CAG" render long.cag -o stopped.exr --engine preview --samples 100000 --size 320x240 --keep-partial > out 2> err &
child=$!
sleep 2
kill -TERM $child
wait $child
code=$? ran='cag render --keep-partial, interrupted'
status 130
exists stopped.exr
"$CAG" render long.cag -o not_kept.exr --engine preview --samples 100000 --size 320x240 > out 2> err &
child=$!
sleep 1
kill -TERM $child
wait $child
code=$? ran='cag render, interrupted'
status 130
is_missing not_kept.exr

it 'POV-Ray is missing'
mkdir empty
ran='cag render without POV-Ray' && PATH=$PWD/empty "$CAG" render ball.cag -o kept.exr $quick --engine povray > out 2> err
code=$?
status 4
says 'POV-Ray is not installed'
says 'apt-get install povray'
holds kept.exr earlier

it 'POV-Ray fails, and its last lines are shown'
fake 'echo "Fatal error in parser: the moon is missing" >&2; exit 1'
stand_in 4 'the moon is missing'

it 'POV-Ray is killed'
fake 'kill -KILL $$'
stand_in 4 'POV-Ray'

it 'POV-Ray crashes'
fake 'kill -SEGV $$'
stand_in 4 'POV-Ray'

it 'POV-Ray writes no picture'
fake 'exit 0'
stand_in 4 'no picture'

it 'POV-Ray writes no EXR'
fake 'echo nonsense > out.exr'
PATH=$PWD/fake:$PATH "$CAG" render ball.cag -o kept.exr $quick --engine povray > out 2> err
code=$?
[ "$code" -eq 3 ] || [ "$code" -eq 4 ] || wrong 'expected status 3 or 4'
holds kept.exr earlier
no_temporaries .
no_temporaries temporary

it 'POV-Ray cannot be started'
mkdir -p fake
printf 'no program' > fake/povray
chmod +x fake/povray
stand_in 4 'POV-Ray'

it 'POV-Ray takes longer than --max-time'
fake 'sleep 60'
ran='cag render with a povray that sleeps'
PATH=$PWD/fake:$PATH timeout 60 "$CAG" render ball.cag -o kept.exr $quick --engine povray --max-time 0.7 > out 2> err
code=$?
status 5
holds kept.exr earlier
no_temporaries temporary

it 'a disk for temporary files that is not there' povray
ran='cag render with a wrong TMPDIR' && TMPDIR=/nowhere "$CAG" render ball.cag -o kept.exr $quick --engine povray > out 2> err
code=$?
status 3
says 'TMPDIR'
holds kept.exr earlier
unset TMPDIR

# --- Cameras ---

# The reflected scene through the reflected camera is the same picture, including the light.
script mirror.cag 'G = [sphere(10), translate(box([6, 4, 20]), [12, -9, 0]), translate(cylinder(14, 3), [-20, 5, 3])]
param m = false
flip(x) = if m then reflect(x, [1, 0.4, 0.3], [3, 1, 0]) else x
show flip(G) |> material({color: "#d04030"})
show flip(camera(eye: [60, -70, 40], target: [0, 0, 5], fov: 40deg))
show flip(sun(direction: [-1, 1, -2]))'
it 'a mirrored camera sees the mirrored scene as the camera sees the scene' povray
try render mirror.cag -o mirror_a.exr $quick
status 0
try render mirror.cag -o mirror_b.exr $quick -D m=true
status 0
try compare mirror_a.exr mirror_b.exr --threshold 0.02
status 0

# In the plane of the mirror, the eye and target are fixed: the picture is flipped from left to right.
script flip.cag 'param m = false
param side = 1
show translate(sphere(6), [side * 10, 0, 0]) |> material({color: "#d04030"})
show translate(box([2, 2, 9]), [-side * 14 - 1, -1, 0])
eye = camera(eye: [0, -80, 30], target: origin, fov: 40deg)
show if m then reflect(eye, X) else eye
show sun(direction: [0, 1, -2])'
it 'a mirrored camera gives the mirrored picture' povray
try render flip.cag -o flip_a.exr $quick -D m=true
try render flip.cag -o flip_b.exr $quick -D side=-1
try compare flip_a.exr flip_b.exr --threshold 0.02
status 0
try render flip.cag -o flip_c.exr $quick
try compare flip_a.exr flip_c.exr --threshold 0.02
status 1

it 'the standard views always work' povray
for view in top bottom front back left right iso; do
  try render mirror.cag -o "view_$view.exr" $quick --camera $view
  status 0
done
try render mirror.cag -o nowhere.png $quick --camera sideways
status 2
says 'top, bottom, front, back, left, right'

it 'a camera of the script wins over a standard view of its name' povray
script named.cag 'show sphere(10)
show camera(eye: [60, 0, 20], target: origin, fov: 30deg) |> named("front")'
try render named.cag -o front_a.exr $quick --camera front
try render named.cag -o front_b.exr $quick
try compare front_a.exr front_b.exr
status 0

# A slanted rod: its axis-parallel box is a cube 700 mm wide.
script rod.cag 'show rotate(cylinder(1000, 4), Y, 45deg) |> translate([-353.55, 0, -353.55]) |> material({color: "black"})
show background("white")
show sun(direction: [0, 0, -1])'
it 'framing fills the picture for long and thin shapes' povray python3
for view in front top iso; do
  try export rod.cag -o rod.json
  try render rod.cag -o "rod_$view.png" --size 100x100 --quality draft --engine povray --camera $view
  status 0
  python3 "$here/png_extent.py" "rod_$view.png" 0.80 0.97 > extent || wrong "$view: $(cat extent)"
done
try render rod.cag -o rod_own.png --size 100x100 --quality draft --engine povray
python3 "$here/png_extent.py" rod_own.png 0.80 0.97 > extent || wrong "$(cat extent)"

# --- Depth of field ---

# A white edge behind the plane of focus, on black. A thin lens shows a point as a disk of diameter A |z - f| / z at the distance f, so the
# edge is blurred with the standard deviation of a disk's profile, a quarter of its diameter.
script edge.cag 'param lens = 100
param level = false
show translate(box([4000, 1, 8000]), if level then [-2000, 1000, -8000] else [0, 1000, -4000]) |> material({color: "black", emission: [0.5, 0.5, 0.5], roughness: 1})
show background("black")
show camera(eye: [0, -1000, 0], target: origin, fov: 40deg, aperture: lens, focus: 1000)
show point_light([0, 0, 100000], strength: 0)'
it 'the blur of an aperture follows the thin lens formula at every quality' povray python3
for quality in draft normal final; do
  for lens in 100 50; do
    try render edge.cag -o edge.png --size 400x200 --region 400x80+0+60 --quality $quality -D lens=$lens
    status 0
    python3 "$here/png_blur.py" edge.png $lens 1000 2000 40 0.05 > blur || wrong "$quality: $(cat blur)"
  done
  try render edge.cag -o edge.png --size 400x400 --region 80x400+160+0 --quality $quality -D level=true
  python3 "$here/png_blur.py" edge.png 100 1000 2000 40 0.05 level > blur || wrong "$quality: $(cat blur)"
done
it '--samples sets the number of lens samples, not the amount of blur' povray python3
for samples in 1 2 5 10 20 40 200; do
  try render edge.cag -o edge.png --size 400x200 --region 400x80+0+60 --samples $samples
  python3 "$here/png_blur.py" edge.png 100 1000 2000 40 0.05 > blur || wrong "$samples: $(cat blur)"
done
it 'an orthographic camera has no depth of field' povray
for lens in 0 50; do
  script flat.cag "show box(100)
show camera(eye: [300, -1000, 300], target: [50, 50, 50], kind: \"orthographic\", width: 300, aperture: $lens)"
  try render flat.cag -o flat_$lens.png --size 60x40
done
try compare flat_0.png flat_50.png --threshold 0.05
status 0

it 'a terminal shows the progress and the time left, unless the command is quiet' povray python3
# Refraction takes seconds to render; the first estimate appears after one second.
script slow.cag 'show [for i in 0..20: sphere(8) |> translate([(i % 5)*14, floor(i/5)*14, 0])] |> material({color: "white", transmission: 1, ior: 1.5})'
python3 "$here/on_terminal.py" "$CAG" render slow.cag -o slow.png --size 240x180 --threads 1 > shown || wrong "$(cat shown)"
grep -q '% rendering, about [0-9]* s left' shown || wrong "$(tail -2 shown)"
python3 "$here/on_terminal.py" "$CAG" render ball.cag -o ball.png $quick -q > shown
[ -z "$(cat shown)" ] || wrong "$(cat shown)"

it '-v prints the tolerances of the meshes of a picture'
script far.cag 'param away = 100
show tube(helix(4, 2, 2), 0.5) |> named("coil")
show camera(eye: [0, -away, 0], target: origin, kind: "orthographic", width: 20, size: [320, 240])'
try render far.cag -o far.png $quick --engine preview -v
status 0
# A pixel is 20/64 mm, a quarter of it 0.078 mm.
says 'tolerance 0.0625 mm, a quarter of a pixel or less'
try render far.cag -o far.png --size 640x480 --engine preview --quality draft -v
says 'tolerance 0.0078125 mm, a quarter of a pixel or less'
try render far.cag -o far.png $quick --engine preview -v --tolerance 0.1
says 'tolerance 0.1 mm, by --tolerance'
# A quarter of a pixel at the nearest point, 4.5 mm before the target, is (d - 4.5) tan(20deg) / 128: 0.058, 0.129, 0.272 mm.
script near.cag 'param away = 100
show tube(helix(4, 2, 2), 0.5)
show camera(eye: [0, -away, 2], target: [0, 0, 2], size: [320, 240])'
for d in 25 50 100; do
  try render near.cag -o near.png $quick --engine preview -v -D away=$d
  cat err >> near
done
[ "$(grep -o 'tolerance 0[.0-9]*' near | tr '\n' ' ')" = 'tolerance 0.03125 tolerance 0.125 tolerance 0.25 ' ] || wrong "$(cat near)"

it '--progress prints lines where there is no terminal' povray
try render ball.cag -o ball.png $quick --progress
status 0
says '100%'

# --- Films ---

it '--loop makes time frame/frames' povray
script loop.cag 'print time
show sphere(10)'
try render loop.cag -o 'made/for/the_film/loop.%d.png' --frames 0..3 --loop $quick
status 0
prints_exactly '0
0.25
0.5
0.75'
[ -s made/for/the_film/loop.3.png ] || wrong 'the folder of the film was not made'
try render loop.cag -o loop.png --loop $quick
status 2
says '--frames'

it 'the outline of a twisted blade has no dark specks' povray python3
script blade.cag 'c = bspline([[-5, 0, 0], [-2, 0.9, 0], [2, 0.9, 0], [5, 0.2, 0], [2, -0.1, 0], [-2, -0.5, 0]], closed: true)
show loft([for k in 0..4: c |> rotate(Z, 30deg*k) |> translate([0, 0, 10*k])])'
try render blade.cag -o blade.png --size 1440x1080 --region 160x400+580+100 --quality draft --engine povray
status 0
python3 "$here/png_specks.py" blade.png > specks || wrong "$(cat specks)"

it 'the outlines of open sheets have no dark specks' povray python3
script sleeve.cag 'c = bspline([[-5, 0, 0], [-2, 0.9, 0], [2, 0.9, 0], [5, 0.2, 0], [2, -0.1, 0], [-2, -0.5, 0]], closed: true)
show loft([for k in 0..4: c |> rotate(Z, 30deg*k) |> translate([0, 0, 10*k])], caps: false)'
try render sleeve.cag -o sleeve.png --size 1440x1080 --region 140x420+640+100 --quality draft --engine povray
status 0
python3 "$here/png_specks.py" sleeve.png > specks || wrong "sleeve: $(cat specks)"
script saddle.cag 'show surface((u, v) => [u, v, u*u/12 - v*v/12], -12..12, -12..12)'
# The normals of a coarse mesh turn most. (A fine one shows the tip of the background between two outlines, a single pixel.)
try render saddle.cag -o saddle.png --size 1440x1080 --region 260x200+690+300 --quality draft --engine povray --tolerance 0.03
status 0
python3 "$here/png_specks.py" saddle.png > specks || wrong "saddle: $(cat specks)"

# The floor of the studio is slightly below the objects on it: the dark inside must not be visible under the edge.
it 'a sleeve meets the floor without dark specks' povray python3
script standing.cag 'show revolve(line([200, 0, 0], [200, 0, 300]), angle: 180deg)'
try render standing.cag -o standing.png --size 1440x1080 --region 420x60+560+655 --quality draft --engine povray --tolerance 0.25
status 0
python3 "$here/png_specks.py" standing.png > specks || wrong "$(cat specks)"
