# POV-Ray's native objects: each shape is written as the named object, accepted by POV-Ray, and looks like its mesh.

quick='--size 96x72 --quality draft'
lit='
show camera(eye: [90, -140, 90], target: [0, 0, 12], fov: 32deg)
show sun(direction: [-1, 2, -2])
show sky(["#404040", "#909090"])'

# native NAME OBJECT 'script that defines g': the shape must be written as OBJECT and not as a mesh, with the same picture as its mesh with
# a tolerance of 0.02 mm. A pixel is 1 mm wide; the pictures differ where the outline is between pixels.
native() {
  printf '%s\nshow g |> color("teal")%s\n' "$3" "$lit" > "$1.cag"
  printf '%s\nshow tessellate(g, 0.02) |> color("teal")%s\n' "$3" "$lit" > "$1_mesh.cag"
  it "$1 is written as $2"
  try export "$1.cag" -o "$1.pov"
  status 0
  grep -q "= $2 {" "$1.pov" || wrong "there is no $2"
  ! grep -q 'mesh2 {' "$1.pov" || wrong 'there is a mesh'
  it "$1 as $2 looks like its mesh" povray
  try render "$1.cag" -o "$1.exr" $quick
  status 0
  try render "$1_mesh.cag" -o "$1_mesh.exr" $quick
  status 0
  try compare "$1.exr" "$1_mesh.exr"
  most=$(awk '$1 ~ /^[RGB]$/ && $2 > most { most = $2 } END { print most + 0 }' out)
  awk "BEGIN { exit !($most < 0.01) }" || wrong "the root of the mean square difference is $most"
  # The difference would also be small for an empty picture.
  try compare "$1.exr" empty.exr
  status 1
}
printf 'show sphere(0.001) |> translate([0, 0, 9000])%s\n' "$lit" > empty.cag
it 'a picture of nothing, to compare with' povray
try render empty.cag -o empty.exr $quick
status 0

native ball sphere 'g = sphere(25) |> translate([0, 0, 25])'
native egg sphere 'g = sphere(20) |> scale([1, 1.3, 0.6]) |> rotate(X, 30deg) |> translate([0, 0, 20])'
native drum cylinder 'g = cylinder(30, 20)'
native cup cone 'g = cylinder(30, 12, top: 22)'
native ring torus 'g = torus(25, 8) |> rotate(X, 40deg) |> translate([0, 0, 20])'
native dice box 'g = box([30, 40, 20], centered: true) |> rotate(Z, 20deg) |> translate([0, 0, 12])'
native bowl union 'g = revolve(polyline([[0, 2], [20, 0], [30, 25], [28, 25], [15, 5]]))'
native vase lathe 'g = revolve(bspline([[0, 0], [30, 0], [25, 20], [8, 25], [20, 45]]))'
native tyre lathe 'g = revolve(rounded(polygon([[12, 0], [30, 0], [30, 20], [18, 24]]), 4))'
native dome lathe 'g = revolve(arc(25, 0deg..70deg))'
native pitcher lathe 'g = revolve(bezier([[10, 0], [40, 10], [0, 20], [30, 30], [22, 40]], weights: [1, 2, 1, 3, 1]))'
native plate prism 'g = extrude(polygon([[-25, -20], [25, -20], [15, 20], [-25, 20]], holes: [[[-8, -8], [8, -8], [0, 8]]]), 15)'
native flange prism 'g = extrude(region(circle(25), holes: [circle(6), circle(4, center: [15, 0])]), 12)'
native leaning prism 'g = extrude(rounded(polygon([[-20, -20], [20, -20], [0, 25]]), 5), [10, 5, 25])'
native patch bicubic_patch 'g = bezier_surface([for i in 0..3: [for j in 0..3: [20 * i - 30, 20 * j - 30, if i == 1 or j == 2 then 35 else 5]]])'
native tent bicubic_patch 'g = bezier_surface([for i in 0..2: [for j in 0..1: [25 * i - 25, 50 * j - 25, if i == 1 then 40 else 5]]])'
native tower quadric 'g = hyperboloid(12, 12, 15, within: 0..35)'
native dish quadric 'g = paraboloid(5, 4, within: 0..30)'
native saddle quadric 'g = hyperbolic_paraboloid(8, 6, within: box([50, 50, 60], centered: true)) |> translate([0, 0, 15])'
# Stretched, sheared, and reflected: the same objects with a matrix.
native stretched_vase lathe 'g = revolve(bspline([[0, 0], [20, 0], [16, 20], [5, 25], [13, 45]])) |> scale([1.5, 0.8, 1]) |> rotate(X, 20deg)'
native mirrored_tyre lathe 'g = transform([[1, 0.3, 0, 0], [0, 1, 0.4, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) * revolve(rounded(polygon([[12, 0], [30, 0], [30, 20], [18, 24]]), 4)) |> reflect(plane([0, 0, 12], [1, 0, 3]))'
native flat_bowl union 'g = revolve(polyline([[0, 2], [20, 0], [30, 25], [28, 25], [15, 5]])) |> scale([1, 0.6, 1.2])'
native round_egg sphere 'g = sphere_surface(20) |> scale([1, 1.3, 0.6]) |> rotate(X, 30deg) |> translate([0, 0, 20])'
native oval_ring torus 'g = torus_surface(20, 6) |> scale([1.4, 0.8, 1.5]) |> rotate(X, 40deg) |> translate([0, 0, 20])'
native leaning_tower quadric 'g = transform([[1, 0, 0.4, -8], [0, 1, -0.2, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) * hyperboloid(12, 10, 15, within: 0..35)'
native leaning_dish quadric 'g = transform([[-1, 0.2, 0.3, 0], [0, 1, 0, 0], [0, 0, 0.8, 0], [0, 0, 0, 1]]) * paraboloid(5, 4, within: 0..30)'
native oval_cut difference 'g = difference(revolve(rounded(polygon([[12, 0], [30, 0], [30, 20], [18, 24]]), 4)) |> scale([1.1, 0.7, 1.3]), torus(20, 6) |> scale([1.5, 1, 0.7]) |> translate([10, 0, 20]))'

native sheet polygon 'g = polygon([[-25, -20], [25, -20], [15, 20], [-25, 20]], holes: [[[-8, -8], [8, -8], [0, 8]]])'

# curve NAME OBJECT 'script': a line with a thickness.
native_curve() {
  it "$1 is written as $2" povray
  printf '%s\nshow g |> line_style(radius: 2)%s\n' "$3" "$lit" > "$1.cag"
  try export "$1.cag" -o "$1.pov"
  status 0
  grep -q "= $2 {" "$1.pov" || wrong "there is no $2"
  try render "$1.cag" -o "$1.exr" $quick
  status 0
}
native_curve stick cylinder 'g = line([-20, 0, 0], [20, 10, 30])'
native_curve hoop torus 'g = circle(25, normal: [0, 1, 1])'
native_curve coil union 'g = helix(20, 8, 4)'

it 'what is nearly flat is a mesh: the renderer would not meet it'
script leaf.cag 'show sphere_surface(20) |> scale([1, 1, 1e-8])'
try export leaf.cag -o leaf.pov
status 0
grep -q 'mesh2 {' leaf.pov || wrong 'it is not a mesh'

it 'what has no object of its own is a mesh with normals'
script knot.cag 'show tube(bezier([[0, 0, 0], [30, 0, 0], [30, 30, 10], [0, 30, 30]]), 4)'
try export knot.cag -o knot.pov
status 0
grep -q 'normal_vectors' knot.pov || wrong 'there are no normals'

# After full turns, its ends look like those of a prism. With an even number of turns, so does the middle.
it 'a body twisted by whole turns is not a prism'
script screws.cag 'for_turns(n) = extrude(polygon([[0, 0], [9, 0], [0, 4]]), 20, twist: n * 360deg) |> translate([30 * n, 0, 0])
show [for n in 1..4: for_turns(n)]'
try export screws.cag -o screws.pov
status 0
[ "$(grep -c 'mesh2 {' screws.pov)" -eq 4 ] || wrong 'they are not all meshes'

it 'a mesh of several colors has a part of each, and says what it is'
script lump.cag 'lump = tessellate(color(box(4), "red") - color(translate(cylinder(9, 1), [2, 2, -1]), "blue")) |> named("lump")
show lump
show mesh([[9, 0, 0], [10, 0, 0], [9, 1, 0]], [[0, 1, 2]]) |> named("leaf")
print len(faces(lump))'
try export lump.cag -o lump.pov
status 0
grep -q '^// lump: mesh$' lump.pov || wrong 'there is no comment of the lump'
grep -q '^// leaf: mesh$' lump.pov || wrong 'there is no comment of the leaf'
[ "$(grep -c 'color rgb <1, 0, 0>' lump.pov)" -eq 1 ] && [ "$(grep -c 'color rgb <0, 0, 1>' lump.pov)" -eq 1 ] || wrong 'a color is missing'
sum=$(awk '/^\/\/ leaf/ { exit } /mesh2 \{/ { s += $4 } END { print s }' lump.pov)
prints_exactly "$sum"

# The full light is within 0.8 of the cone. It points along -[1, 2, 3] from [10, 20, 30], at any point of that line.
it 'a spot light keeps its place, direction and cone'
script spot.cag 'show box(9), spot_light([10, 20, 30], origin, angle: 40deg)'
try export spot.cag -o spot.pov
status 0
sed -n '/light_source { \/\/ spot/,/^}/p' spot.pov > spot
grep -q '<10, 20, 30>' spot || wrong 'it is at another place'
grep -q 'spotlight radius 16 falloff 20 ' spot || wrong 'its cone is another'
tr -d '<>,' < spot | awk '/point_at/ { for (i = 1; i < NF; i++) if ($i == "point_at") { x = 10 - $(i+1); y = 20 - $(i+2); z = 30 - $(i+3) }
  exit !(x > 0 && (y - 2*x)^2 + (z - 3*x)^2 < 1e-12) }' || wrong 'it points elsewhere'

# At outlines, smooth normals of meshes face away before their triangles do.
it 'opaque closed meshes take light on both sides, sheets and glass do not'
script sides.cag 'c = [for a in 0..3: bspline([[-5, 0, 0], [-2, 0.9, 0], [2, 0.9, 0], [5, 0.2, 0], [0, -0.4, 0]], closed: true) |> rotate(Z, 40deg*a) |> translate([0, 0, 10*a])]
show loft(c) |> named("blade")
show loft(c) |> translate([20, 0, 0]) |> material({transmission: 0.5}) |> named("glass")
show loft(c, caps: false) |> translate([40, 0, 0]) |> named("sleeve")'
try export sides.cag -o sides.pov
status 0
sides() { awk -v name="$1" '/^object \{/ { inside = 1 } inside && $1 == name { mine = 1 } mine && /double_illuminate/ { n++ } /^}/ { inside = mine = 0 } END { print n + 0 }' sides.pov; }
[ "$(sides blade)" -eq 1 ] || wrong 'the blade takes light on one side'
[ "$(sides glass)" -eq 0 ] || wrong 'the glass takes light on both sides'
[ "$(sides sleeve)" -eq 0 ] || wrong 'the sleeve takes light on both sides'

# sheets NAME 'script': no triangle is shaded on the side that the camera does not see, in perspective or not.
sheets() {
  it "$1: the camera sees the side that is shaded" python3
  script "$1.cag" "blade = bspline([[-5, 0, 0], [-2, 0.9, 0], [2, 0.9, 0], [5, 0.2, 0], [2, -0.1, 0], [-2, -0.5, 0]], closed: true)
$2"
  try export "$1.cag" -o "$1.pov"
  status 0
  python3 "$here/pov_facing.py" "$1.pov" > sides || wrong "$(cat sides)"
  printf '\nshow camera(eye: [80, 30, -50], kind: "orthographic", width: 60)\n' >> "$1.cag"
  try export "$1.cag" -o "$1.pov"
  status 0
  python3 "$here/pov_facing.py" "$1.pov" > sides || wrong "without perspective: $(cat sides)"
}
sheets lofted_sheet 'show loft([for k in 0..4: blade |> rotate(Z, 30deg*k) |> translate([0, 0, 10*k])], caps: false)'
sheets lathe_sheet 'show revolve(bspline([[10, 0, 0], [16, 0, 6], [4, 0, 14], [8, 0, 22], [14, 0, 30]]), angle: 300deg)'
sheets half_cylinder 'show revolve(line([10, 0, 0], [10, 0, 30]), angle: 180deg)'
sheets patch_sheet 'show bspline_surface([for i in 0..4: [for j in 0..4: [10*i, 10*j, 8*sin(70deg*i)*cos(80deg*j)]]])'
sheets saddle 'show surface((u, v) => [u, v, u*u/12 - v*v/12], -12..12, -12..12)'
sheets twisted_sleeve 'show extrude(blade, 20, twist: 90deg, caps: false)'
sheets closed_blade 'show loft([for k in 0..4: blade |> rotate(Z, 30deg*k) |> translate([0, 0, 10*k])])'
sheets far_sheet 'show translate(loft([for k in 0..4: blade |> rotate(Z, 30deg*k) |> translate([0, 0, 10*k])], caps: false), [20000, 30000, 10000])'

# The renderer stores vertices in single precision: 0.002 mm at 30 m. A pixel on an outline may change sides, so one in 10,000 may differ.
it 'what is far from the origin looks like the same at the origin' povray
for at in '0, 0, 0' '20000, 30000, 10000'; do
  script "at_$at.cag" "c = bspline([[-5, 0, 0], [-2, 4, 0], [2, 4, 0], [5, 0.2, 0], [2, -0.1, 0], [-2, -2, 0]], closed: true)
b = loft([for k in 0..4: c |> rotate(Z, 30deg*k) |> translate([0, 0, 4*k])])
show translate(b - translate(sphere(3), [1, 1, 7]) - (b |> scale(0.6) |> rotate(Y, 80deg) |> translate([-8, 0, 10])), [$at])
show translate(loft([for k in 0..4: c |> rotate(Z, 30deg*k) |> translate([20, 0, 4*k])], caps: false), [$at])
show sun(direction: [-1, 1, -2])"
  try render "at_$at.cag" -o "at_$at.exr" --size 480x360 --quality draft
  status 0
done
try compare 'at_0, 0, 0.exr' 'at_20000, 30000, 10000.exr' --threshold 0.002
differ=$(sed -n 's/^pixels that differ by more than 0.002: \([0-9]*\) of 172800.*/\1/p' out)
test "${differ:-172800}" -le 17 || wrong "${differ:-all} pixels differ"

# Eight digits of the largest coordinate: 11 decimals for thousandths of a millimeter, 3 for kilometers.
it 'vertices of meshes have eight digits'
script tiny.cag 'show mesh([[0, 0, 0], [0.0012345678901, 0, 0], [0, 0.0023456789012, 0]], [[0, 1, 2]])'
try export tiny.cag -o tiny.pov
status 0
grep -q '<0.00123456789,0,0>' tiny.pov || wrong "$(grep '<0' tiny.pov)"
script vast.cag 'show mesh([[0, 0, 0], [123456.7890123, 0, 0], [0, 234567.8901234, 0]], [[0, 1, 2]])'
try export vast.cag -o vast.pov
status 0
grep -q '<123456.789,0,0>' vast.pov || wrong "$(grep '<0' vast.pov)"
