# Fillets, chamfers, shells, drafts, splits, and imprints of solids, computed by cag-brep, and STEP and IGES files that are read. Expected
# values are closed forms.

helper=$(dirname "$CAG")/cag-brep
needs_helper() {
  [ -x "$helper" ] || {
    skip 'cag-brep is missing (Open CASCADE is not installed)'
    test_state=left_out
  }
}

# holds TEST 'script': everything that the script prints is true.
holds() {
  it "$1"
  needs_helper
  printf '%s\n' "$2" > holds.cag
  try run -q holds.cag
  status 0
  is_left_out && return
  [ -s out ] || wrong 'nothing was printed'
  [ -z "$(tr -d 'true \n' < out)" ] && ! grep -q false out || wrong 'something is not true'
}

# fails TEST CODE 'text' 'expression': it fails with this code, and the message contains the text.
fails() {
  it "$1"
  needs_helper
  printf 'print attempt(() => %s, err => [err.code, err.message])\n' "$4" > fails.cag
  try run -q fails.cag
  status 0
  is_left_out || {
    prints "[\"$2\", "
    prints "$3"
  }
}

# --- Fillets ---

# A fillet takes (1 - pi / 4) r^2 per length. If the radius changes evenly from 1 to 2, that of each section, nearly.
holds 'fillets take the corners of a box' 'B = box([10, 20, 30])
up = e => near(e.direction, Z)
print near(volume(fillet(B, 2, edges: up)), 6000 - (4 - pi) * 4 * 30, relative: 1e-8)
print near(volume(fillet(B, 2)), volume(rounded_box([10, 20, 30], 2)), relative: 1e-8)
print near(volume(fillet(B, e => if up(e) then 1 else 2, edges: e => up(e) and e.start.x < 1)), 6000 - (2 - pi / 2) * 30, relative: 1e-8)
first = filter(edges_of(B), up)[0]
print near(volume(fillet(B, [1, 2], edges: [first])), 6000 - (1 - pi / 4) * 7 / 3 * 30, relative: 1e-4)
print near(volume(fillet(B, e => [2, 1], edges: [first, first])), 6000 - (1 - pi / 4) * 7 / 3 * 30, relative: 1e-4)'

# By Pappus: the area outside of the quarter circle about the axis.
holds 'fillets go around circles' 'arm = 3 + 1 / 6 / (1 - pi / 4)
print near(volume(fillet(cylinder(10, 4), 1, edges: e => e.start.z > 5)), 160 * pi - 2 * pi * (1 - pi / 4) * arm, relative: 1e-8)
print near(volume(fillet(cylinder(10, 4), 1)), volume(rounded_cylinder(10, 4, 1)), relative: 1e-8)'

holds 'concave edges gain what convex ones lose' 'G = extrude(polygon([[0, 0], [10, 0], [10, 3], [3, 3], [3, 10], [0, 10]]), 5)
inner = fillet(G, 1, edges: e => e.bend == "concave")
print near(volume(inner), 5 * (51 + 1 - pi / 4), relative: 1e-8)
print len(filter(edges_of(inner), e => e.bend == "concave")) == 0'

# A similarity of the result is that of the solid; so is a reflection.
holds 'solids are rounded where they are' 'B = exact(box([10, 20, 30]))
up = e => near(e.direction, Z) and near(e.start, origin)
big = fillet(scale(rotate(B, [1, 2, 3], 40deg), 2), 2)
print near(volume(big), volume(rounded_box([20, 40, 60], 2)), relative: 1e-8)
low = fillet(B, [1, 4], edges: up)
print near(centroid(fillet(reflect(B, plane([0, 0, 15], Z)), [1, 4], edges: up)), centroid(low), 1e-9)
print centroid(low).z < 15
wide = fillet(scale(B, [2, 1, 1]), 2, edges: e => near(e.direction, Z))
print near(volume(wide), 12000 - (4 - pi) * 4 * 30, relative: 1e-6)'

holds 'every part of a solid is rounded' 'P = box(10) | translate(box(10), [20, 0, 0])
print near(volume(fillet(P, 1)), 2 * volume(rounded_box(10, 1)), relative: 1e-8)
print near(volume(fillet(P, 1, edges: e => e.start.x < 15)), 1000 + volume(rounded_box(10, 1)), relative: 1e-8)'

holds 'attributes are kept' 'G = fillet(box(5) |> named("lid") |> color("red"), 1)
print attempt(() => parts_list([G])[0].name, err => err.message) == "lid"'

fails 'a radius that is too large names the edge and the limit' E0768 \
  'cannot round the line from [0, 0, 0] to [0, 0, 30], 30 mm long, with the radius 12' \
  'fillet(box([10, 20, 30]), 12, edges: e => near(e.direction, Z) and near(e.start, origin))'
is_left_out || prints 'the largest radius that fits is 9.99'
fails 'the limit is in the units of the scene' E0768 'the largest radius that fits is 19.9' \
  'fillet(scale(exact(box([10, 20, 30])), 2), 24, edges: e => near(e.direction, Z) and near(e.start, origin))'
fails 'a radius that fits on each edge but not on all is named' E0768 'along with other edges' 'fillet(box([10, 20, 30]), 7)'
fails 'a solid without edges has nothing to round' E0314 'a solid with edges' 'fillet(sphere(5), 1)'
fails 'a choice of no edge is an error' E0314 'a choice of at least one edge' 'fillet(box(5), 1, edges: e => false)'
fails 'a choice must be true or false' E0301 'returns true or false' 'fillet(box(5), 1, edges: e => 1)'
fails 'edges of another solid are an error' E0314 'records of edges of this solid' 'fillet(box(5), 1, edges: edges_of(box(6)))'
fails 'a radius is positive' E0314 'a length greater than 0' 'fillet(box(5), -1)'
fails 'a radius by a function is positive, too' E0314 'a length greater than 0' 'fillet(box(5), e => [1, 0])'
fails 'a smooth mesh has no edges to round' E0314 'a solid with edges' 'fillet(solid(tessellate(sphere(5))), 1)'

it 'with -v, the method is named'
needs_helper
printf 'show fillet(box(5), 1)\n' > round.cag
try run -v round.cag
status 0
is_left_out || says 'round.cag:1:6: fillet: tier B: kernel; edges: 12'
try run round.cag
says_not tier

# --- Chamfers ---

holds 'chamfers take prisms and cones' 'B = box([10, 20, 30])
up = e => near(e.direction, Z) and near(e.start, origin)
cut = chamfer(B, [3, 1], edges: up)
side = faces_of(B)[filter(edges_of(B), up)[0].faces[0]].normal
print near(volume(cut), 6000 - 45, relative: 1e-8)
print near([3, 1, 0], [for k in 0..2: max([for c in corners_of(cut) if near(c.point.z, 0) and c.point.x < 5 and c.point.y < 5: c.point[k]])]) == near(abs(side.y), 1)
print near(volume(chamfer(cylinder(10, 5), 1)), 250 * pi - 2 * pi * (5 - 1 / 3), relative: 1e-8)'
fails 'a chamfer that is too large names the edge and the limit' E0768 'cannot cut off the line from [0, 0, 0] to [0, 0, 30]' \
  'chamfer(box([10, 20, 30]), 12, edges: e => near(e.direction, Z) and near(e.start, origin))'

# --- Shells ---

holds 'shells of a box and of a ball' 'B = box([10, 20, 30])
print near(volume(shell(B, 1, open: f => f.normal.z > 0.5)), 6000 - 8 * 18 * 29, relative: 1e-8)
print near(volume(shell(B, 1, open: [for f in faces_of(B) if abs(f.normal.z) > 0.5: f])), 6000 - 8 * 18 * 30, relative: 1e-8)
print near(volume(shell(B, 1)), 6000 - 8 * 18 * 28, relative: 1e-8)
print near(volume(shell(sphere(5), 1, outside: true)), 4 / 3 * pi * (216 - 125), relative: 1e-8)
print near(volume(shell(scale(exact(B), 2), 2)), 8 * (6000 - 8 * 18 * 28), relative: 1e-8)'
fails 'walls thicker than the solid are an error' E0759 '' 'shell(box([10, 20, 30]), 6)'

# --- Drafts: frustums ---

holds 'a box with inclined sides is a frustum' 'B = box([10, 10, 10])
sides = f => abs(f.normal.z) < 0.1
print near(volume(draft(B, atan(0.1), faces: sides, at: origin)), 10 / 3 * (100 + 64 + 80), relative: 1e-8)
print near(volume(draft(B, atan(0.1), faces: sides, at: [0, 0, 10], pull: -Z)), 10 / 3 * (100 + 64 + 80), relative: 1e-8)
print near(volume(draft(B, -atan(0.1), faces: sides, at: origin)), 10 / 3 * (100 + 144 + 120), relative: 1e-8)
turned = rotate(exact(B), X, 90deg)
print near(volume(draft(turned, atan(0.1), faces: f => abs(f.normal.y) < 0.1, at: origin, pull: -Y)), 10 / 3 * (100 + 64 + 80), relative: 1e-8)'

# --- Splits and imprints ---

# The cap of a ball: pi h^2 (3 r - h) / 3.
holds 'a plane and a solid split others' 'halves = split_solid(sphere(3), plane([0, 0, 1], Z))
print len(halves) == 2, near(volume(halves[1]), pi * 4 * (9 - 2) / 3, relative: 1e-8), centroid(halves[1]).z > 1
print near(volume(halves[0]) + volume(halves[1]), 36 * pi, relative: 1e-8)
cut = split_solid(box([30, 10, 10], centered: true), box(12, centered: true))
print len(cut) == 3, near(volume(cut[0]), 1200), near(volume(cut[1]), 900), near(volume(cut[2]), 900)
print len(split_solid(box(4), half_space(plane([1, 0, 0], X)))) == 2'

holds 'a curve that is drawn on a face divides it' 'D = imprint(box([10, 10, 10]), translate(circle(2), [5, 5, 10]))
print near(volume(D), 1000), len(faces_of(D)) == 7
areas = sort([for f in faces_of(D) if near(f.normal, Z): f.area])
print near(areas, [4 * pi, 100 - 4 * pi], 1e-8)
low = imprint(translate(exact(box(10)), [0, 0, 50]), [line([2, 0, 50], [2, 10, 50]), line([0, 0, 60], [10, 10, 60])])
print len(faces_of(low)) == 8
pair = imprint(box(10) | translate(box(10), [20, 0, 0]), line([22, 0, 10], [22, 10, 10]))
print len(faces_of(pair)) == 13'
fails 'a curve that is not near a face is an error' E0759 '' 'imprint(box(10), circle(2, center: [50, 50]))'

# --- Files ---

if [ -x "$helper" ]; then
  script written.cag 'show (box([40, 30, 20]) - translate(cylinder(30, 8), [20, 15, -5])) |> named("plate") |> color([1, 0, 0])
show translate(sphere(5), [100, 0, 0]) |> named("ball é")'
  "$CAG" export -q written.cag -o written.step > /dev/null 2>&1
  script one.cag 'show box([1, 2, 3])'
  "$CAG" export -q one.cag -o one.step > /dev/null 2>&1
  "$CAG" export -q one.cag -o one.igs > /dev/null 2>&1
  # The longer axis of the ellipse is the second one, so that its seam is not where readers expect it.
  script oval.cag 'show prism(region(ellipse(5, 9)), 10) - translate(box([20, 20, 5]), [-10, -10, -2])'
  "$CAG" export -q oval.cag -o oval.igs > /dev/null 2>&1
  script ring.cag 'show revolve(ellipse(2, 5, center: [20, 0])) - translate(box([50, 50, 50]), [-25, 0, -25])'
  "$CAG" export -q ring.cag -o ring.igs > /dev/null 2>&1
  mkdir -p folder
  cp one.step folder/inner.step
  head -c 4000 written.step > cut.step
  printf 'ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n' > nothing.step
  : > empty.step
fi
holds 'a STEP file is read with names and colors' 'G = read_step("written.step")
rows = parts_list(G)
print [for r in rows: r.name] == ["plate", "ball é"]
print near(rows[0].volume, 24000 - 64 * 20 * pi, relative: 1e-8), near(rows[1].volume, 500 / 3 * pi, relative: 1e-8)
print near(bounds(G).max, [105, 30, 20], 1e-6)
S = read_step("folder/inner.step")
print type_of(S) == "solid", near(volume(S), 6), len(edges_of(S)) == 12
print near(volume(fillet(S, 0.25)), volume(rounded_box([1, 2, 3], 0.25)), relative: 1e-8)'
holds 'an IGES file is read' 'S = read_iges("one.igs")
print near(volume(S), 6), len(faces_of(S)) == 6'
holds 'whole ellipses in IGES files have their volume' 'print near(volume(read_iges("oval.igs")), 7 * 45 * pi, relative: 1e-8)
print near(volume(read_iges("ring.igs")), 10 * pi * 20 * pi, relative: 1e-8)'
fails 'a STEP file that is missing is an error' E0317 'none.step' 'read_step("none.step")'
fails 'a file of another format is an error' E0740 '`one.igs` is not a STEP file' 'read_step("one.igs")'
fails 'a STEP file is no IGES file' E0740 '`one.step` is not an IGES file' 'read_iges("one.step")'
fails 'an empty file is an error' E0740 '`empty.step`: it is empty' 'read_step("empty.step")'
fails 'a file without solids is an error' E0740 '`nothing.step` ' 'read_step("nothing.step")'
fails 'a file that was cut off is an error' E0740 '`cut.step` is damaged' 'read_step("cut.step")'

it 'files outside of the folder of the script are not read'
mkdir -p apart
printf 'print read_step("../one.step")\n' > apart/reads.cag
try run -q apart/reads.cag
status 1
says 'outside of the folders'

# --- Files of other programs ---

cp "$root"/tests/data/step/*.stp .
holds 'files of NIST have the volumes and areas that Open CASCADE finds' 'g = read_step("nist_ftc_11_asme1_rb.stp")
print near(volume(g), 5129.38613645, relative: 1e-8), near(area(g), 5474.47868298, relative: 1e-8)
h = read_step("nist_ftc_06_asme1_rd.stp")
print near(volume(h), 3323546.07078, relative: 1e-8), near(area(h), 283415.422871, relative: 1e-8)'
holds 'a file in inches is converted, and all of its faces are read' 'h = read_step("nist_ftc_06_asme1_rd.stp")
print near(bounds(h).size, [12 * 25.4, 3.85 * 25.4, 9.75 * 25.4])
of(kind) = len(filter(faces_of(h), f => f.kind == kind))
print [for k in ["plane", "cylinder", "cone", "sphere", "torus"]: of(k)] == [71, 58, 4, 5, 6]'
# By formulas: a frustum of radii 5 and 2, and the volume between -3 and 3 of a circle of radius 9 about (-4, 0) that turns.
for kind in cone torus copies; do python3 "$root/tests/brep/turned_step.py" $kind > far_$kind.step; done
holds 'surfaces on the far side of their axis are read' 'c = read_step("far_cone.step")
print near(volume(c), 78 * pi), near(area(c), pi * (25 + 4 + 7 * sqrt(45)))
t = read_step("far_torus.step")
print near(volume(t), pi * (582 - 18 - 8 * (3 * sqrt(72) + 81 * (asin(1/3) / 1rad))))'
holds 'copies of a part are where they are placed' 'g = read_step("far_copies.step")
print len(parts_list(g)) == 1, parts_list(g)[0].count == 3, near(volume(g), 3 * 78 * pi)
middle = 6 / 4 * (25 + 20 + 12) / 39
print near(centroid(g), [(20 + middle) / 3, 20 / 3, 2 * middle / 3], 1e-9)
print near(bounds(g).min, [-5, -5, -5], 1e-6), near(bounds(g).max, [25, 25, 6], 1e-6)'
for kind in cone torus copies; do
  it "what was read from far_$kind.step is written, and read again"
  needs_helper
  printf 'show read_step("far_%s.step")\n' $kind > far.cag
  for format in step igs; do
    try export far.cag -o far_again.$format -q
    status 0
  done
  script again.cag "v = volume(read_step(\"far_$kind.step\"))
print near(volume(read_step(\"far_again.step\")), v, relative: 1e-6), near(volume(read_iges(\"far_again.igs\")), v, relative: 1e-6)"
  try run -q again.cag
  status 0
  is_left_out || prints_exactly 'true true'
done
it 'the color of a file is that of the solid'
needs_helper
printf 'show read_step("nist_ftc_11_asme1_rb.stp")\n' > colored.cag
try export colored.cag -o colored.json
status 0
is_left_out || grep -q '"color":\[0.5209955' colored.json || wrong 'the color is missing'

it 'without cag-brep, the package is named'
printf 'print exact(box(5) - sphere(3))\n' > rounds.cag
try_command env CAG_BREP="$PWD/none" "$CAG" run -q rounds.cag
status 1
says 'install the package cag-brep'

it 'without cag-brep, shells are made of offsets of the mesh'
printf 'print near(volume(shell(box([10, 20, 30]), 1)), 6000 - 8 * 18 * 28)\n' > shells.cag
try_command env CAG_BREP="$PWD/none" "$CAG" run -v shells.cag
status 0
prints 'true'
says 'tier C: offsets of the mesh, within'

# --- Examples ---

# faces FILE PLANES CYLINDERS CONES TORI SPLINES SOLIDS: what a STEP file holds.
faces() {
  is_left_out && return
  held=$(for kind in PLANE CYLINDRICAL_SURFACE CONICAL_SURFACE TOROIDAL_SURFACE B_SPLINE_SURFACE_WITH_KNOTS MANIFOLD_SOLID_BREP; do
    grep -c "[=(]$kind(" "$1"
  done | tr '\n' ' ')
  shift
  [ "$held" = "$* " ] || wrong "the file holds $held instead of $*"
}

# Planes: 3 outside of each leg, 2 sides, 3 of the rib, 4 of the counterbores. Cylinders: the inner edge, which the rib divides, 4 corners,
# and 2 in each of 4 holes.
it 'a bracket has the faces that its parts leave'
needs_helper
try export "$root/examples/parts/bracket.cag" -o bracket.step
status 0
faces bracket.step 15 14 0 0 0 1

it 'the interference of the parts of a bearing block is none'
needs_helper
try check --interference "$root/examples/parts/bearing_block.cag"
status 0

it 'an enclosure and its lid are two solids without splines'
needs_helper
try export "$root/examples/parts/enclosure.cag" -o enclosure.step
status 0
is_left_out || {
  [ "$(grep -c 'MANIFOLD_SOLID_BREP(' enclosure.step)" = 2 ] || wrong 'there are not 2 solids'
  ! grep -q B_SPLINE_SURFACE enclosure.step || wrong 'there are splines'
}
