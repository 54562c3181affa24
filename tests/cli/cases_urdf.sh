# Robots as URDF: accepted by urdfdom's check_urdf, written completely or not at all, and recovered by reading.

accepted() {
  needs check_urdf || return 0
  try_command check_urdf "$1"
  status 0
  prints 'Successfully Parsed XML'
}

script arm.cag 'part = translate(box([100, 20, 20]), [-100, -10, -10])
arm = robot([fixed_link(translate([0, 0, 50]), shape: named(cylinder(50, 40), "foot")), revolute(d: 30, alpha: 90deg, limits: -170deg..170deg),
  revolute(a: 100, limits: -90deg..120deg, speed: 60deg, effort: 12, shape: [material(part, {color: "orange", density: 2700, name: "aluminium"}), sphere(15)]),
  prismatic(limits: 10..90, home: 20, shape: named(part, "a <wei>rd & \"long\" name"))], name: "arm <1>")
show posed(arm, [30deg, 40deg, 50])'

it 'a robot is a .urdf file with its meshes beside it'
try export arm.cag -o arm.urdf
status 0
says_nothing
exists arm.urdf
exists arm_meshes/foot.stl
exists arm_meshes/link_3.stl
exists arm_meshes/link_3_2.stl
exists arm_meshes/a__wei_rd____long__name.stl
no_temporaries .
no_temporaries arm_meshes
grep -q '<robot name="arm &lt;1&gt;">' arm.urdf || wrong 'the name is another'
grep -q '<material name="aluminium"/>' arm.urdf || wrong 'the material is another'
cp arm.urdf first.urdf

it 'check_urdf accepts it'
accepted arm.urdf

it 'xmllint finds it well-formed'
if needs xmllint; then
  try_command xmllint --noout arm.urdf
  status 0
fi

it 'the pose that is shown is not part of it'
sed 's/30deg, 40deg, 50\]/-30deg, 10deg, 80]/' arm.cag > other.cag
try export other.cag -o arm.urdf --tolerance 0.02
status 0
same arm.urdf first.urdf

it 'it is read back: name, limits, rates, shapes, places'
{
  grep -v '^show' arm.cag
  echo 'param file = "arm.urdf"
r = read_urdf(file)
print r, r.limits, [for l in r.links: l.speed], [for l in r.links: l.effort]
q = [20deg, 30deg, 70]
near_to(a, b) = norm(a - b) < 0.1
b = bounds(posed(r, q))
c = bounds(posed(arm, q))
print near_to(b.min, c.min), near_to(b.max, c.max), norm(position(fk(r, q)) - position(fk(arm, q))) < 1e-9
show r'
} > back.cag
try run back.cag
status 0
prints 'robot arm <1>, 3 joints (RRP) [-170deg..170deg, -90deg..120deg, 10..90] [none, 180deg, 60deg, 1000] [none, 100, 12, 100]'
prints 'true true true'

it 'what was read is written with the same names'
try export back.cag -o again.urdf --tolerance 0.02
status 0
for name in foot link_3 a__wei_rd____long__name; do
  grep -q "<link name=\"$name\">" again.urdf || wrong "no link $name"
done
grep -q '<material name="aluminium">' again.urdf || wrong 'no aluminium'
accepted again.urdf
try run back.cag -D file=again.urdf
prints 'true true true'

it 'names are of letters, digits, -, . and _, and each is there once'
script letters.cag 'names = ["a", "z", "A", "Z", "_", "é9-.", "0", "z0", "-a", ".a", "a`b", "a\{b", "a@b", "a[b", "a/b", "a:b"]
show robot([for n in names: revolute(a: 10, shape: named(box(3), n))])'
try export letters.cag -o letters.urdf
status 0
grep -o 'link name="[^"]*"' letters.urdf | cut -d '"' -f 2 | tr '\n' ' ' > names
printf 'base_link a z A Z _ é9-. __2 z0 _a _a_2 a_b a_b_2 a_b_3 a_b_4 a_b_5 a_b_6 tool ' > expected
same names expected

it 'a robot without shapes is written of plain bodies, also to standard output'
script plain.cag 'show robot([revolute(a: 300), prismatic(limits: 0..100)], convention: "mdh", base: translate([0, 0, 100]))'
try export plain.cag -o - --format urdf
status 0
prints '<link name="world"/>'
prints '<cylinder radius='
prints '<box size='
cp out plain.urdf
accepted plain.urdf
is_missing plain_meshes

it 'meshes have no place beside standard output'
try export arm.cag -o - --format urdf
status 2
says 'which standard output does not allow'
prints_nothing

it 'each mesh has a file of its own'
script names.cag 'foot(k) = named(group(box(k), box(k + 1)), "foot")
show robot([revolute(shape: foot(1)), revolute(shape: named(box(5), "foot_2")), revolute(shape: foot(7)), revolute(shape: named(box(9), "Foot")),
  revolute(shape: named(box(10), "tool"))])'
try export names.cag -o names.urdf
status 0
[ "$(ls names_meshes | wc -l)" -eq 7 ] || wrong "not seven files: $(ls names_meshes | tr '\n' ' ')"
[ "$(grep -o 'filename="[^"]*"' names.urdf | sort -u | wc -l)" -eq 7 ] || wrong 'not seven names'
accepted names.urdf

it 'a coupling is said in a comment'
script coupled.cag 'show robot([revolute(a: 3), revolute(a: 2)], coupling: [[1, 0], [1, 1]])'
try export coupled.cag -o coupled.urdf
status 0
grep -q '<!-- the motors of this robot are coupled' coupled.urdf || wrong 'no comment'
accepted coupled.urdf

it 'a screw is two joints'
script screw.cag 'show robot([revolute(lead: 10), revolute(a: 2)])'
try export screw.cag -o screw.urdf
status 0
accepted screw.urdf
script screw_back.cag 'r = read_urdf("screw.urdf")
print r.joints, near(r.links[1].lead, 10), near(fk(r, [90deg, 0deg]).z, Z), position(fk(r, [180deg, 0deg], link: 2)).z'
try run screw_back.cag
prints '2 true true 5'

it 'no robot is told'
script none.cag 'show sphere(1)'
try export none.cag -o none.urdf
status 1
says 'shows no robot'
is_missing none.urdf

it 'two robots are told by name, the same one twice is one'
script two.cag 'a = robot([revolute(a: 1)], name: "one")
b = robot([revolute(a: 2)], name: "two")
show [a, translate(posed(b), X)], posed(a, [3deg])'
try export two.cag -o two.urdf
status 1
says 'shows 2 robots'
says '(one, two)'
script twice.cag 'a = robot([revolute(a: 1)], name: "one")
show a, rotate(posed(a, [3deg]), Z, 30deg), sphere(2)'
try export twice.cag -o twice.urdf
status 0

it 'a folder of meshes that cannot be made leaves the old file'
mkdir full
echo old > full/arm.urdf
echo old > full/arm_meshes
try export arm.cag -o full/arm.urdf
status 3
holds full/arm.urdf old
no_temporaries full

it 'branches are chosen by tip and base'
script tree.urdf '<robot name="tree">
  <material name="red"><color rgba="1 0 0 0.5"/></material>
  <link name="body"><visual><geometry><sphere radius="0.1"/></geometry><material name="red"/></visual></link>
  <link name="left"/><link name="right"/><link name="hand"/>
  <joint name="a" type="continuous"><parent link="body"/><child link="left"/><axis xyz="0 0 1"/></joint>
  <joint name="b" type="prismatic"><parent link="body"/><child link="right"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.5" velocity="2" effort="9"/></joint>
  <joint name="c" type="fixed"><parent link="right"/><child link="hand"/><origin xyz="0 0 0.3" rpy="0 0 0"/></joint>
</robot>'
script tree.cag 'print attempt(() => read_urdf("tree.urdf"), e => e.message)
l = read_urdf("tree.urdf", tip: "left")
r = read_urdf("tree.urdf", tip: "hand")
print l.limits, r.limits, r.links[len(r.links) - 1].speed
print near(position(fk(r, [100])), [200, 100, 300]), read_urdf("tree.urdf", base: "right").joints
print attempt(() => read_urdf("tree.urdf", tip: "foot"), e => e.reason), attempt(() => read_urdf("tree.urdf", tip: "left", base: "right"), e => e.reason)
print near(volume(posed(l)), 4 / 3 * pi * 100 ^ 3), read_urdf("tree.urdf", tip: "hand", shapes: false).links[0].shape'
try run tree.cag
status 0
prints 'to the ends "left", "hand"'
prints '[-360deg..360deg] [0..500] 2000'
prints 'true 0'
prints 'urdf-chain urdf-chain'
prints 'true none'

it 'meshes of packages are found near the file, others are refused'
mkdir -p pkg/urdf pkg/meshes
cp arm_meshes/foot.stl pkg/meshes/part.stl
for name in 'package://anything/meshes/part.stl' '../meshes/part.stl' '/opt/ros/part.stl' 'http://example.org/part.stl' 'part.dae' \
  '../../../../../../etc/passwd.stl' 'file:///etc/part.stl' 'package://x'; do
  printf '<robot name="r"><link name="a"><visual><geometry><mesh filename="%s" scale="2 2 -2"/></geometry></visual></link><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>' "$name" > pkg/urdf/r.urdf
  script mesh.cag 'print attempt(() => bounds(posed(read_urdf("pkg/urdf/r.urdf"))).size.z, e => e.reason)'
  try run mesh.cag
  status 0
  case $name in package://any*|../meshes*) prints 100 ;; *) prints urdf-mesh ;; esac
done

it 'a Collada mesh gives way to the body for collisions'
printf '<robot name="r"><link name="a"><visual><geometry><mesh filename="package://x/a.dae"/></geometry></visual>
<collision><geometry><box size="1 2 3"/></geometry></collision></link><link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint></robot>' > dae.urdf
script dae.cag 'print volume(posed(read_urdf("dae.urdf")))'
try run dae.cag
prints 6000000000

it 'the examples of the chapter on robots do what they say'
mkdir chapter
awk '/^```cag$/ { n++; inside = 1; next } /^```/ { inside = 0 } inside { print > ("chapter/" n ".cag") }' "$root/docs/robots.md"
exists chapter/7.cag
try test chapter
status 0

script masses.cag 'said(s, c) = material(s, {color: c, density: 1000})
can = revolve(reverse(polyline([[0, 0], [100, 0], [100, 50], [0, 50]])), Z)
show robot([revolute(a: 100, shape: said(translate(torus_surface(200, 50), [10, 20, 30]), "red")),
  revolute(a: 50, shape: said(translate(can, [0, 0, -25]), "blue")), revolute(a: 50, shape: said(circle(5), "blue"))])'

# A torus has the volume 2 pi^2 R r^2 and, about its axis and a diameter, m (R^2 + 3/4 r^2) and m (R^2/2 + 5/8 r^2).
# The cylinder has inward normals, but encloses the same volume; a curve has no mass.
it 'closed surfaces have the mass and inertia of what they enclose'
try export masses.cag -o masses.urdf
status 0
if needs python3; then
  try_command python3 -c '
import math, xml.etree.ElementTree as tree
R, r, a, h = .2, .05, .1, .05
torus, can = 2000 * math.pi**2 * R * r * r, 1000 * math.pi * a * a * h
expected = [(torus, torus * (R*R/2 + 5/8*r*r), torus * (R*R + 3/4*r*r)), (can, can * (3*a*a + h*h) / 12, can * a*a/2)]
found = [(float(i.find("mass").get("value")), *(float(i.find("inertia").get(k)) for k in ("ixx", "izz"))) for i in
  tree.parse("masses.urdf").iter("inertial")]
assert len(found) == 2, found
assert all(abs(x - y) < 1e-9 * y for f, e in zip(found, expected) for x, y in zip(f, e)), (found, expected)'
  status 0
fi

it 'the drawing of a robot has its name'
script plain.cag 'show robot([revolute(a: 300)], name: "arm"), posed(robot([revolute(a: 300), revolute(a: 200)], name: "leg"))'
try run plain.cag
status 0
says 'leg: group of'
try export plain.cag -o plain.obj
status 0
for name in arm arm.2 leg leg.2; do
  grep -qx "o $name" plain.obj || wrong "no object has the name $name"
done
