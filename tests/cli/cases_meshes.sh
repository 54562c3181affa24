# Mesh files: written, read by cag, and read by other programs: assimp, admesh, unzip, xmllint, and the Khronos validator. Tests of missing
# programs are skipped.

# The validator comes from npm, once per build folder. This is the newest version since 2024.
validator=$BUILD/npm
if have node && have npm && [ ! -d "$validator/node_modules/gltf-validator" ]; then
  mkdir -p "$validator"
  timeout 90 npm install --prefix "$validator" --fetch-retries=1 --fetch-timeout=30000 --no-audit --no-fund --silent gltf-validator@2.0.0-dev.3.10 > npm_out 2>&1 < /dev/null ||
    echo "the Khronos validator could not be installed: $(tail -n 1 npm_out)"
fi
can_validate() {
  needs node || return
  [ -d "$validator/node_modules/gltf-validator" ] || {
    skip 'the Khronos validator is missing'
    return 1
  }
}
can_trace() {
  needs strace || return
  strace -o /dev/null true 2> /dev/null || {
    skip 'strace may not trace'
    return 1
  }
}
# The validator must not report any problem.
validate() {
  ran="gltf-validator $*"
  NODE_PATH=$validator/node_modules timeout $LONGEST node "$here/gltf_validate.js" "$@" > out 2> err
  code=$?
  status 0
  [ "$(grep -c ': 0 errors, 0 warnings' out)" -eq $# ] || wrong 'the validator found faults'
}

# Closed bodies: a ball, a ring, a box, a lathe with corners, and copies that are rotated, translated, and reflected.
script bodies.cag 'rod_of(k) = rod(origin, [0, 2, 9], 1)
show named(sphere(10), "ball") |> material({color: "white", transmission: 0.8, ior: 1.33, roughness: 0})
show named(torus(4, 1), "ring <&\"") |> translate([0, 0, 30]) |> color("teal")
show box([3, 4, 5]) |> translate([40, 0, 0]) |> material({color: "gold", metallic: 1, emission: [2, 1, 0], coat: 0.5})
show around(translate(rod_of(0), [25, 0, 0]), 7, axis: [1, 2, 3])
show named(rows(torus(4, 1), 5, [9, 0, 0]), "chain") |> translate([0, 60, 0])
show mirrored(translate(cone(5, 3), [0, 30, 0]), plane(origin, Y)) |> color("red")'
# The same as one mesh, and the numbers for any file of it.
cat > bodies_of.cag <<'E2'
param file = "bodies.stl"
rod_of(k) = rod(origin, [0, 2, 9], 1)
shapes = [sphere(10), translate(torus(4, 1), [0, 0, 30]), translate(box([3, 4, 5]), [40, 0, 0]),
  around(translate(rod_of(0), [25, 0, 0]), 7, axis: [1, 2, 3]), translate(rows(torus(4, 1), 5, [9, 0, 0]), [0, 60, 0]),
  mirrored(translate(cone(5, 3), [0, 30, 0]), plane(origin, Y))]
wanted = tessellate(shapes, tolerance: 0.01)
found = read_mesh(file)
same(a, b) = near(a, b, relative: 1e-6)
print "volume {same(volume(found), volume(wanted))}, area {same(area(found), area(wanted))}"
print "triangles {len(faces(found)) == len(faces(wanted))}, closed {is_watertight(found)}"
print "euler {euler_characteristic(found) == euler_characteristic(wanted)}"
print "bounds {norm(bounds(found).max - bounds(wanted).max) < 1e-4}, {norm(bounds(found).min - bounds(wanted).min) < 1e-4}"
print "count {len(faces(found))}"
E2
all_the_same='volume true, area true
triangles true, closed true
euler true
bounds true, true'

triangles=
for format in stl obj ply glb gltf; do
  it "what .$format has is read back: volume, area, counts, closed"
  try export bodies.cag -o "bodies.$format" --tolerance 0.01
  status 0
  says_nothing
  no_temporaries .
  try run bodies_of.cag -D "file=bodies.$format"
  status 0
  prints "$all_the_same"
  triangles=$(sed -n 's/^count //p' out)
done
# The count in a binary STL is in the bytes 80 to 83.
it 'a .stl says how many triangles it has'
[ "$(od -An -tu4 -j80 -N4 bodies.stl | tr -d ' ')" = "$triangles" ] || wrong 'it says another count'

it 'a .gltf on standard output has its data in it'
try export bodies.cag -o - --format gltf --tolerance 0.01
status 0
cp out embedded.gltf
grep -q 'base64,' embedded.gltf || wrong 'no data in it'
try run bodies_of.cag -D file=embedded.gltf
prints "$all_the_same"

it 'the data of a .gltf is named by its content'
mkdir half
script half/body.cag 'param size = 1
show box(size)'
try export half/body.cag -o half/body.gltf
status 0
first=$(cd half && ls body-*.bin)
grep -qF "\"uri\":\"$first\"" half/body.gltf || wrong 'the .gltf does not name it'
cp half/body.gltf half/before
try export half/body.cag -o half/body.gltf
same half/body.gltf half/before
exists "half/$first"
try export half/body.cag -o half/body.gltf -D size=2
second=$(cd half && ls body-*.bin)
[ "$first" != "$second" ] || wrong 'other data has the same name'
grep -qF "\"uri\":\"$second\"" half/body.gltf || wrong 'the .gltf does not name it'
no_temporaries half

it 'where the data cannot be written, the .gltf stays, with its own data'
rm "half/$second"
try export half/body.cag -o half/body.gltf
mkdir "half/$second"
cp half/body.gltf half/before
try export half/body.cag -o half/body.gltf -D size=2
status 3
says "$second"
same half/body.gltf half/before
exists "half/$first"
no_temporaries half
rmdir "half/$second"

# Killed at each of its renames in turn. The file is the first body or the second, never a mixture.
it 'a .gltf that is killed between its renames has its own data'
if can_trace; then
  script half/read.cag 'print round(volume(read_mesh("body.gltf")))'
  for rename in 1 2; do
    ran="strace cag export body.cag, killed at rename $rename" code=0
    strace -f -o /dev/null -e trace=rename,renameat,renameat2 -e "inject=rename,renameat,renameat2:signal=KILL:when=$rename" \
      "$CAG" export half/body.cag -o half/body.gltf -D size=2 > out 2> err
    try run half/read.cag
    status 0
    prints_like '^[18]$'
  done
  try export half/body.cag -o half/body.gltf -D size=2
  try run half/read.cag
  prints_exactly 8
fi

it 'the name of a .bin may have any characters'
try export bodies.cag -o 'für 100% von "mir" #1.gltf' --tolerance 0.01
status 0
try run bodies_of.cag -D 'file=für 100% von "mir" #1.gltf'
status 0
prints "$all_the_same"

# A profile from the axis that ascends on the outside results in a surface with inward normals. Volumes are by Pappus.
it 'closed surfaces and meshes face outward in every mesh file, whatever their normals'
script inward.cag 'show revolve(polyline([[0, 0], [10, 0], [10, 5], [0, 5]]))
show translate([30, 0, 0]) * revolve(polyline([[5, 1], [5, -1], [9, -1], [9, 1], [5, 1]]))
show translate([60, 0, 0]) * mesh([[0, 0, 0], [6, 0, 0], [0, 6, 0], [0, 0, 6]], [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
show translate([90, 0, 0]) * revolve(reverse(polyline([[0, 0], [3, 3], [0, 6]])))
show translate([120, 0, 0]) * solid([sphere_surface(10), sphere_surface(5)])'
script inward_of.cag 'param file = "inward.stl"
wanted = pi * 100 * 5 + pi * (81 - 25) * 2 + 36 + 2 * pi * 27 / 3 + 4 / 3 * pi * (1000 - 125)
print "{near(volume(read_mesh(file)), wanted, relative: 3e-3)}"'
for format in stl obj ply glb gltf; do
  try export inward.cag -o "inward.$format" --tolerance 0.003
  status 0
  says_nothing
  try run inward_of.cag -D "file=inward.$format"
  prints_exactly true
done
script normal.cag 'print round(normal(revolve(polyline([[0, 0], [10, 0], [10, 5], [0, 5]])), 1.5, 0deg), 9)'
try run normal.cag
prints_exactly '[-1, 0, 0]'

it 'what is shown without a name is named after its definition in the .3mf' python3
script leads.cag 'lid = sphere(4)
leg = cylinder(9, 1)
show lid |> color("red")
show [translate(leg, [30, 0, 0]), scale(lid, 2)]
show around(translate(leg, [50, 0, 0]), 2)
show lid |> translate([0, 0, 40]) |> named("top")
cut = lid - leg
show cut |> translate([0, 0, 90]), lid - leg, lid | leg, extrude(circle(3), 2), lid & leg'
try export leads.cag -o leads.3mf
status 0
python3 - leads.3mf > found 2> err << 'E2' || wrong 'the file is not read'
import re, sys, zipfile
model = zipfile.ZipFile(sys.argv[1]).read("3D/3dmodel.model").decode()
print(*re.findall('<object [^>]*name="([^"]*)"', model))
E2
[ "$(cat found)" = 'lid leg lid.2 leg.2 leg.3 top cut difference union extrusion intersection' ] || wrong "the names are $(cat found)"

it 'open surfaces are named where a file is for printing'
script sheets.cag 'show revolve(polyline([[0, 0], [10, 0], [10, 5]])) |> named("cup")
show mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2]]) |> named("tent")
show region(polyline([[0, 0], [9, 0], [0, 9]], closed: true)) |> named("sail"), box(1)'
for format in stl 3mf; do
  try export sheets.cag -o "sheets.$format"
  status 0
  says_like 'cup is an open surface, not a solid: [0-9]* open edges'
  says '`thicken` or `solid` makes it printable'
  says 'tent is an open mesh, not a solid: 3 open edges'
  says 'sail is a flat region, not a solid: 3 open edges'
  says_not box
done
try export sheets.cag -o sheets.ply
says_nothing

it 'lines alone are written as closed tubes that share no edge'
script wires.cag 'param which = 0
square = polyline([[0, 0], [10, 0], [10, 10], [0, 10]], closed: true)
hairpin = polyline([[0, 0, 0], [10, 0, 0], [0, 0, 0], [0, 10, 0], [0, 10, 10], [3, 3, 3]])
walk = polyline([for k in 0..60: [7 * sin(k * 101deg), 7 * sin(k * 67deg), 7 * sin(k * 43deg)]])
steps = polyline([for k in 0..40: [floor((k + 1) / 2), floor(k / 2) % 3, 0]])
shapes = [square, hairpin, walk, steps, circle(4), helix(3, 2, 4)]
show shapes[which]'
printf 'print is_watertight(read_mesh("wires.stl"))\n' > tight.cag
for which in 0 1 2 3 4 5; do
  try export wires.cag -o wires.stl -D which=$which
  status 0
  says_nothing
  try run tight.cag
  prints_exactly true
done

# Points, radius, and the arguments of stl_tube.py: the length and the turns.
it 'the tube of a path with corners is one closed shell, without overlaps' python3
while IFS='|' read -r curve radius expected; do
  script path.cag "show $curve |> line_style(radius: $radius)"
  try export path.cag -o path.stl
  status 0
  says_nothing
  python3 "$here/stl_tube.py" path.stl $radius $expected > shells || wrong "$curve: $(cat shells)"
done <<'PATHS'
polyline([[0, 0], [10, 0], [10, 10], [0, 10]], closed: true)|0.5|40 90 90 90 90
polyline([[0, 0], [10, 0], [10, 7]])|1.5|17 90
polyline([[3, 0, 0], [3, 10, 0], [3, 10, 7], [3, -10, 7]])|0.25|37 90 90
polyline([[0, 0], [10, 0], [5, 5*sqrt(3)], [20, 5*sqrt(3)]])|0.5|35 120 120
polyline([[-3, 0], [0, 4], [3, 0]], closed: true)|0.1|16 126.86989764584402 126.86989764584402 106.26020470831196
polyline([[0, 0, 1], [6, 0, 1], [6 + 3*sqrt(3), 3, 1], [6 + 3*sqrt(3), 9, 1]])|0.3|18 30 60
PATHS

# The normal rotates by at most 15 degrees along an edge (tessellate.h), and the normal of a triangle is between those of its corners.
it 'triangles follow the surface, also for surfaces of revolution, trimmed and thickened surfaces, and set operations' python3
script lean.cag 'param which = 0
profile = bspline([[-5, 0, 0], [-2, 0.9, 0], [2, 0.9, 0], [5, 0.2, 0], [2, -0.1, 0], [-2, -0.5, 0]], closed: true)
blade = loft([for k in 0..4: profile |> scale(1 - 0.1*k) |> rotate(Z, 30deg*k) |> translate([0, 0, 10*k])], caps: true)
hub = cylinder(20, 6) |> rotate(X, 90deg) |> translate([0, 10, 0])
sheet = bezier_surface([[[0,0,0], [0,10,5], [0,20,0]], [[10,0,5], [10,10,-8], [10,20,5]], [[20,0,0], [20,10,5], [20,20,0]]])
shapes = [
  union(hub, blade, blade |> rotate(Y, 120deg), blade |> rotate(Y, 240deg)),
  revolve(polyline([[0, 0], [10, 0], [10, 5], [6, 9], [0, 9]])),
  revolve(line([-10, 0, 0], [10, 0, 20])),
  revolve(line([-10, 0, 0], [7, 0, 20]), angle: 0deg..200deg),
  revolve(bspline([[-8, 0], [6, 5], [-6, 10], [8, 16]])),
  revolve(bspline([[4, 0], [0, 4], [-4, 8], [0, 12], [4, 16]], degree: 2)),
  clip(sheet, sphere(8) |> translate([10, 10, 0])),
  thicken(sheet, 1),
  difference(sphere(10), cylinder(30, 4) |> translate([0, 0, -15])),
  intersection(revolve(bspline([[0, 0], [10, 0], [4, 8], [12, 14], [0, 18]])), box([30, 30, 12]) |> translate([-10, -10, 0]))
]
// In shown shapes, the normal may turn farther along edges up to four tolerances.
show tessellate(shapes[which])'
for which in 0 1 2 3 4 5 6 7 8 9; do
  try export lean.cag -o lean.glb -D which=$which
  status 0
  python3 "$here/glb_lean.py" lean.glb 15 > lean || wrong "shape $which: $(cat lean)"
done

# The normals on the two sides of a cusp, or of a tip inside the domain, have opposite limits.
it 'triangles at cusps have the normals of their sides' python3
script cusps.cag 'param which = 0
shapes = [
  surface((u, v) => 10 * [cos(u)*sin(v), sin(u)*sin(v), cos(v) + ln(tan(v/2)) + 0.2*in_radians(u)], 0deg..720deg, 10deg..170deg),
  surface((u, v) => [u*cos(v), u*sin(v), u], -1..1.5, 0deg..360deg),
  surface((u, v) => [u, v^3, v^2 + 0.1*u*v^2], -1..1, -1..1),
  surface((u, v) => [u^3 + u*v, 0.75*u^4 + 0.5*u^2*v, v], -1..1, -1..1),
  surface((u, v) => [3*u^2 + v, -2*u^3, v], -1..1, -1..1)
]
show tessellate(if which < 5 then shapes[which] else clip(shapes[0], plane([0, 0, 9], [1, 1, 1])))'
for which in 0 1 2 3 4 5; do
  try export cusps.cag -o cusps.glb -D which=$which
  status 0
  python3 "$here/glb_lean.py" cusps.glb 30 > lean || wrong "shape $which: $(cat lean)"
done

# At its corner with three equal control points, the partial derivatives vanish. The plane has the normal [-1, -2, 2] / 3 there as
# elsewhere.
it 'normals in a .ply are those of the surface, also where control points coincide'
script corner.cag 'f(x, y) = [x, y, (x + 2*y) / 2]
show bezier_surface([[f(0,0), f(0,0), f(0,2), f(0,3)], [f(0,0), f(1,1), f(1,2), f(1,3)], [f(2,0), f(2,1), f(2,2), f(2,3)], [f(3,0), f(3,1), f(3,2), f(3,3)]])'
try export corner.cag -o corner.ply
status 0
# First six floats of 4 bytes each; then two more and three colors.
size=$((8 * 4 + 3)) head=$(grep -abo end_header corner.ply | cut -d: -f1)
count=$(sed -n 's/^element vertex //p' corner.ply | head -1)
tail -c +$((head + 12)) corner.ply | head -c $((count * size)) > corner_vertices
k=0
while [ $k -lt "$count" ]; do
  od -An -tf4 -w12 -j$((k * size + 12)) -N12 corner_vertices
  k=$((k + 1))
done > corner_normals
[ "$(wc -l < corner_normals)" -eq "$count" ] || wrong 'normals are missing'
awk '{ d = ($1 + 1/3)^2 + ($2 + 2/3)^2 + ($3 - 2/3)^2; if (!(d < 1e-12)) exit 1 }' corner_normals || wrong 'a normal is another'

it 'copies are written once'
[ "$(wc -c < bodies.glb)" -lt "$(($(wc -c < bodies.ply) * 3 / 4))" ] || wrong 'the .glb holds every copy'

it 'values are shown by colors where the format has them'
script colors.cag 'show colored_by(torus_surface(3, 1), "gaussian") |> named("map"), zebra(translate([9, 0, 0]) * sphere_surface(2))
show translate([0, 9, 0]) * colored_by(torus_surface(3, 1), "gaussian"), translate([0, 18, 0]) * colored_by(torus_surface(3, 1), "mean")'
for format in gltf glb ply 3mf obj stl pov; do
  try export colors.cag -o "colors.$format"
  status 0
done
[ "$(grep -o COLOR_0 colors.gltf | wc -l)" -eq 3 ] || wrong 'the moved copy of a map shares its mesh, the others have colors of their own'
grep -q uv_mapping colors.pov || wrong 'the .pov has no colors'
if needs unzip xmllint; then
  unzip -p colors.3mf 3D/3dmodel.model > colors.xml
  xmllint --noout colors.xml || wrong 'the .3mf is no XML'
  [ "$(grep -c '<m:colorgroup' colors.xml)" -eq 3 ] || wrong 'the .3mf has not a group of colors for each mesh'
fi

it 'meshes without a triangle are no output'
script labels.cag 'show label([1, 2, 3], "here")'
try export labels.cag -o labels.stl
status 1
says 'labels have no mesh'
is_missing labels.stl
script ground.cag 'show ground()'
try export ground.cag -o ground.3mf
status 1
says 'a ground is only for pictures'
is_missing ground.3mf

it 'the Khronos validator has nothing to say about .gltf and .glb'
if can_validate; then
  script open.cag 'show bilinear([0, 0, 0], [0, 2, 1], [4, 0, 0], [4, 2, 0]) |> color("teal")
show line([0, 0, 0], [1, 2, 3])
show revolve(line([5, 0], [0, 3]))
show sphere(1e-3), translate(sphere(2), [1e5, 0, 0]), sphere(1) |> material({emission: "red"})'
  try export open.cag -o open.glb
  try export open.cag -o open.gltf
  validate bodies.glb bodies.gltf embedded.gltf open.glb open.gltf colors.glb colors.gltf 'für 100% von "mir" #1.gltf'
fi

it 'admesh finds no open edge and as many facets'
if needs admesh; then
  try_command admesh bodies.stl
  status 0
  prints_like "Number of facets *: *$triangles  *$triangles"
  prints_like 'Total disconnected facets *: *0 '
  prints_like 'Degenerate facets *: *0'
  prints_like 'Number of parts *: *17 '
fi

for format in stl ply obj; do
  it "assimp finds as many triangles in .$format"
  needs assimp || continue
  try_command assimp info "bodies.$format"
  status 0
  prints_like "^Faces: *$triangles$"
done
for format in glb gltf 3mf; do
  it "what assimp makes of .$format is the same body"
  needs assimp || continue
  [ -e "bodies.$format" ] || try export bodies.cag -o "bodies.$format" --tolerance 0.01
  try_command assimp export "bodies.$format" "of_$format.stl"
  status 0
  # assimp does not convert glTF's meters and Y up, so cag reads a .glb that assimp wrote.
  case $format in
    3mf) try run bodies_of.cag -D "file=of_$format.stl" ;;
    *) script turned.cag "m = read_mesh(\"of_$format.stl\")
show scale(1000) * rotate(X, 90deg) * m"
      try export turned.cag -o turned.obj
      try run bodies_of.cag -D file=turned.obj ;;
  esac
  status 0
  prints "$all_the_same"
done
for format in stlb stl ply plyb obj; do
  it "cag reads what assimp writes: $format"
  needs assimp || continue
  try_command assimp export bodies.obj "theirs.${format%b}" "-f$format"
  status 0
  try run bodies_of.cag -D "file=theirs.${format%b}"
  status 0
  prints 'volume true, area true'
  prints 'closed true'
done
for format in glb2 gltf2; do
  it "cag reads what assimp writes: $format"
  needs assimp || continue
  try_command assimp export bodies.glb "theirs.${format%2}" "-f$format"
  status 0
  try run bodies_of.cag -D "file=theirs.${format%2}"
  status 0
  prints "$all_the_same"
done

it '.3mf is the same twice'
try export bodies.cag -o bodies.3mf --tolerance 0.01
try export bodies.cag -o again.3mf --tolerance 0.01
status 0
cmp -s bodies.3mf again.3mf || wrong 'the files differ'
begins_with bodies.3mf 504b0304

it '.3mf is a sound archive of sound XML'
if needs unzip xmllint; then
  try_command unzip -t bodies.3mf
  status 0
  prints 'No errors detected'
  unzip -p bodies.3mf '\[Content_Types\].xml' | xmllint --noout - || wrong 'the content types are no XML'
  unzip -p bodies.3mf _rels/.rels | xmllint --noout - || wrong 'the relationships are no XML'
  unzip -p bodies.3mf 3D/3dmodel.model > model.xml
  try_command xmllint --noout model.xml
  status 0
fi

# Counts by XPath, without the namespace.
in_model() { xmllint --xpath "$(echo "$1" | sed 's/@@\([a-z]*\)/*[local-name()="\1"]/g')" model.xml; }
it '.3mf keeps the rules of the core specification'
if needs unzip xmllint; then
  ran='xmllint model.xml'
  : > out
  : > err
  [ "$(in_model 'string(/@@model/@unit)')" = millimeter ] || wrong 'the unit is no millimeter'
  [ "$(in_model 'count(//@@object)')" = 17 ] || wrong 'there are not 17 objects'
  [ "$(in_model 'count(//@@build/@@item)')" = 17 ] || wrong 'not every object is built'
  [ "$(in_model 'count(//@@item[not(@objectid = //@@object/@id)])')" = 0 ] || wrong 'an item of no object'
  [ "$(in_model 'count(//@@component[not(@objectid = ../../preceding-sibling::@@object/@id)])')" = 0 ] ||
    wrong 'a component of no object before it'
  [ "$(in_model 'count(//@@object[@pid and @@components])')" = 0 ] || wrong 'components with a material'
  [ "$(in_model 'count(//@@object[@type != "model"])')" = 0 ] || wrong 'a closed body is no model'
  [ "$(in_model 'count(//@@mesh)')" = 7 ] || wrong 'not 7 bodies have meshes of their own'
  [ "$(in_model 'count(//@@object[@pindex >= count(//@@base)])')" = 0 ] || wrong 'a material that is none'
  [ "$(in_model 'count(//@@triangle[@v1 = @v2 or @v2 = @v3 or @v3 = @v1])')" = 0 ] || wrong 'a triangle with a point twice'
  [ "$(in_model 'string(//@@object[@id = 3]/@name)')" = 'ring <&"' ] || wrong 'a name is not kept'
  script open.cag 'show bilinear([0, 0, 0], [0, 2, 1], [4, 0, 0], [4, 2, 0])'
  try export open.cag -o open.3mf
  unzip -p open.3mf 3D/3dmodel.model | grep -q 'type="surface"' || wrong 'an open sheet is a model'
fi

# --- Reading: limits and locations ---

it 'read_mesh keeps the limit of triangles'
script read.cag 'print len(faces(read_mesh("bodies.stl")))'
try run read.cag --max-triangles 100
status 5
says 'bodies.stl has more than the 100 triangles allowed'

it 'read_mesh keeps the limit of memory'
try run read.cag --max-memory 2M
status 5
says 'max-memory'

it 'read_mesh reads below the folder of the script alone'
mkdir inner
script inner/read.cag 'print len(faces(read_mesh("../bodies.stl")))'
try run inner/read.cag
status 1
says 'outside of the folders'
script inner/beside.gltf '{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 3, "uri": "../bodies.bin"}]}'
script inner/read.cag 'print read_mesh("beside.gltf")'
try run inner/read.cag
status 1
says 'bodies.bin is outside'

it 'a file cut anywhere is refused with its place'
for format in stl ply glb; do
  head -c 5000 "bodies.$format" > "cut.$format"
  script cut.cag "print read_mesh(\"cut.$format\")"
  try run cut.cag
  status 1
  says "cut.$format"
  says 'write or download'
done

it 'facets of any size have normals in .stl'
script sizes.cag 'show mesh([[0,0,0],[1e-15,0,0],[0,1e-15,0]], [[0,1,2]]), mesh([[0,0,0],[0,1e25,0],[0,0,1e25]], [[0,1,2]])'
try export sizes.cag -o sizes.stl
status 0
[ "$(tail -c +85 sizes.stl | head -c 12 | od -An -tf4 | tr -s ' ')" = ' 0 0 1' ] || wrong 'the normal of the small facet is not Z'
[ "$(tail -c +135 sizes.stl | head -c 12 | od -An -tf4 | tr -s ' ')" = ' 1 0 0' ] || wrong 'the normal of the large facet is not X'
