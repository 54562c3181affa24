# Set operations as the renderer's own and as meshes: the same pictures.

# alike NAME SHAPE: renders the shape natively and as a mesh; the colors' root mean square difference is small. Edges
# that are sampled differently are all that may differ.
alike() {
  script "$1.cag" "param native = true
give(s) = if native then s else tessellate(s, tolerance: 0.005)
$2
show camera([14, -30, 26], target: [4, 4, 3], fov: 34deg), sun([1, 1.5, -2]), sky([\"white\", \"lightblue\"])"
  try export "$1.cag" --pov-csg native -o "$1.pov"
  status 0
  grep -q -E '^#declare [a-z_]+ = (union|difference|intersection|merge) \{' "$1.pov" || wrong 'no operation of the renderer'
  try render "$1.cag" --pov-csg native -o "$1.exr" --size 96x72 --quality draft
  status 0
  try render "$1.cag" -o "$1_mesh.exr" --size 96x72 --quality draft -D native=false
  status 0
  try compare "$1.exr" "$1_mesh.exr"
  awk '$1 ~ /^[RGB]$/ { n++; if ($2 > 0.012) bad = 1 } END { exit bad || n != 3 }' out || wrong 'the pictures differ'
}

it 'a box and a ball with three bores' povray
alike die 'bore = translate(cylinder(14, 3), [0, 0, -7])
die = (box(10, centered: true) & sphere(6.8)) - bore - rotate(bore, X, 90deg) - rotate(bore, Y, 90deg)
show give(die) |> translate([4, 4, 4]) |> color("tomato")'

it 'a bore whose ends lie in the faces, and a pin left in it' povray
alike flush 'show give(box(8) - (translate(box([6, 6, 8]), [1, 1, 0]) - translate(cylinder(8, 2), [4, 4, 0]))) |> color("teal")'

it 'half spaces and quadrics' povray
alike bowl 'show give((sphere(5) - solid([1, 1, 0, 0, 0, 0, 0, 0, -4, -3])) & half_space(plane(origin, [1, 0, 0.5]))) |> translate([4, 4, 3]) |> color("gold")'

it 'lathes, prisms, meshes and moved operations' povray
alike kinds 'pot = revolve(bezier([[0, 0], [6, 0], [6, 8], [0, 8]]))
star = extrude(polygon([for k in 0..9: polar(if k % 2 == 0 then 5 else 2, 36deg * k)]), 9)
show give(pot - translate(star, [0, 0, 2])) |> color("orchid")
show give((tessellate(box(4)) | torus(3, 1)) - translate(sphere(2), [4, 4, 4])) |> rotate(Z, 30deg) |> translate([9, 6, 1]) |> color("khaki")'

it 'nothing but faces outside is seen of a union of glass'
script glass.cag 'import std.materials as mat
show sphere(4) | translate(sphere(4), [4, 0, 0]) |> material(mat.glass)'
try export glass.cag -o glass.pov
status 0
grep -q 'merge {' glass.pov || wrong 'no merge'

# written WORD: the object that NAME of the file became.
written() { grep -q "^#declare $1 = $2" faces.pov || wrong "$1 is no $2"; }

it 'operands whose faces coincide become a mesh in .pov, others the objects of the renderer'
script faces.cag 'pot = revolve(bezier([[0, 0], [6, 0], [6, 8], [0, 8]]))
cup = revolve(polyline([[0, 0], [5, 0], [5, 8], [4, 8], [4, 1], [0, 1]]))
M = rotate([1, 2, 3], 22deg)
show named(box(10, centered: true) & sphere(6.8), "faces_cross")
show named(pot - translate(cylinder(9, 2), [0, 0, 2]), "free_form")
show named(torus(5, 1) | translate(sphere(2), [5, 0, 0]), "ring")
show named(sphere(5) & half_space(plane(origin, [1, 0, 1])), "cut")
show named(box(8) - translate(cylinder(8, 2), [4, 4, 0]), "flush_ends")
show named(M * box([3, 3, 1]) - M * translate(box([1, 1, 1]), [1, 1, 0]), "turned")
show named(prism(rectangle(30, 20, radius: 4), 10) & prism(region(circle(13)), 10), "same_caps")
show named(cylinder(9, 3) - translate(cylinder(2, 3), [0, 0, 3]), "same_wall")
show named(cup | translate(box([3, 1, 1]), [3, 0, 8]), "same_rim")
show named(torus(5, 1) | rotate(torus(5, 1), Z, 20deg), "same_torus")
show named(box(5) - half_space(plane([0, 0, 5], -Z)), "same_plane")
show named(tessellate(box(4)) | translate(box(2), [1, 1, 4]), "on_mesh")'
try export faces.cag -o faces.pov
status 0
written faces_cross 'intersection {'
written free_form 'difference {'
written ring 'union {'
written cut 'intersection {'
for name in flush_ends turned same_caps same_wall same_rim same_torus same_plane on_mesh; do written $name 'mesh2 {'; done
try export faces.cag --pov-csg mesh -o faces.pov
status 0
for name in faces_cross free_form ring cut flush_ends; do written $name 'mesh2 {'; done
try export faces.cag --pov-csg native -o faces.pov
status 0
written same_caps 'intersection {'
written flush_ends 'difference {'

it 'a picture of faces that coincide has no speckles' povray
script speckles.cag 'param whole = false
body = if whole then translate(box([40, 40, 10]), [-20, -20, 0]) else prism(rectangle(30, 20, radius: 4), 10) & prism(region(circle(13)), 10)
show body |> color("khaki")
show camera([0, -1, 90], target: [0, 0, 10], fov: 12deg), sun([1, 1.5, -2])'
try render speckles.cag -o speckles.exr --size 64x48 --quality draft
status 0
# The same body, built without a set operation: its flat top fills the picture.
try render speckles.cag -D whole=true -o whole.exr --size 64x48 --quality draft
status 0
try compare speckles.exr whole.exr
awk '$1 ~ /^[RGB]$/ { n++; if ($2 > 0.001) bad = 1 } END { exit bad || n != 3 }' out || wrong 'the face is speckled'

it '--pov-csg takes three words'
script one.cag 'show sphere(1)'
try export one.cag --pov-csg both -o one.pov
status 2
says 'choose auto, native, or mesh'

it 'an operation that leaves nothing warns, and is no output alone'
script nothing.cag 'show box(2) - sphere(9)'
try export nothing.cag -o nothing.stl
status 1
says 'nothing.cag:1:6'
says 'the shape is empty'
says 'shows only empty shapes'

it 'what leaves nothing or has no end is shown where it was asked for'
script place.cag 'a = box(2)
b = translate(box(1), [9, 0, 0])
c = a & b
show c'
try export place.cag -o place.stl
status 1
says 'place.cag:3:5'
script place.cag 'show half_space(plane(origin, Z)) | sphere(3)'
try export place.cag -o place.stl
status 1
says 'place.cag:1:6'

it 'faces keep the material of their operand'
script hues.cag 'show (box(4) |> color("red")) - (sphere(2) |> color("blue")) - box(1)'
try export hues.cag -o hues.obj
status 0
[ "$(grep -c ^usemtl hues.obj)" = 2 ] || wrong 'not two materials'
[ "$(grep -c ^newmtl hues.mtl)" = 2 ] || wrong 'not two materials in the .mtl'
try export hues.cag --pov-csg native -o hues.pov
status 0
[ "$(grep -c '^ *material { M_' hues.pov)" -ge 4 ] || wrong 'operands without materials'
script plain.cag 'show (box(4) |> color("red")) - sphere(2)'
try export plain.cag -o plain.obj
status 0
[ "$(grep -c ^usemtl plain.obj)" = 1 ] || wrong 'not one material'

it 'a half space alone has no end'
script half.cag 'show half_space(plane(origin, Z))'
try export half.cag -o half.pov
status 1
says 'the half space is unbounded'

it 'operations are operations in JSON, with their operands'
script tree.cag 'show box(2) - (sphere(1) | translate(half_space(plane(origin, Z)), [0, 0, 0.5]))'
try export tree.cag -o tree.json
status 0
for word in difference union half_space '"operands"' '"form"'; do grep -q "$word" tree.json || wrong "no $word"; done
