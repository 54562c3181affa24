# Output destinations, and outputs that cannot be written.

script ball.cag 'print "printed"
show sphere(10)'
script curve.cag 'show circle(10)'

for format in obj stl ply glb pov json; do
  it "export writes .$format"
  try export ball.cag -o "ball.$format"
  status 0
  prints_exactly printed
  exists "ball.$format"
  no_temporaries .
done

it 'the endings mean what they say'
begins_with ball.ply 706c790a
begins_with ball.glb 676c5446
grep -q '^mtllib ball.mtl' ball.obj || wrong 'the .obj names no materials'
exists ball.mtl
grep -q 'sphere *{' ball.pov || wrong 'the .pov has no sphere'

it 'export writes .svg of curves'
try export curve.cag -o curve.svg
status 0
grep -q '<svg' curve.svg || wrong 'no svg'

it 'an .svg of solids is refused with the reason'
try export ball.cag -o ball.svg
status 1
says 'curve'
is_missing ball.svg

it '--format overrides the ending'
try export ball.cag -o ball.dat --format ply
status 0
begins_with ball.dat 706c790a

it '-o - is standard output, and prints go to standard error then'
try export ball.cag -o - --format ply
status 0
begins_with out 706c790a
says printed

it 'an export twice gives the same bytes'
try export ball.cag -o again.stl
cmp -s ball.stl again.stl || wrong 'the files differ'

it 'a finer tolerance gives more triangles'
try export ball.cag -o fine.stl --tolerance 0.001
status 0
[ "$(wc -c < fine.stl)" -gt "$(wc -c < ball.stl)" ] || wrong 'it is not finer'

it 'an output that is a folder'
mkdir taken.stl
try export ball.cag -o taken.stl
status 3
says 'taken.stl'
prints_nothing

it 'a folder that is missing is made'
try export ball.cag -o made/for/it/ball.stl
status 0
cmp -s made/for/it/ball.stl ball.stl || wrong 'the file is not that of another folder'

it 'no folder is made for a script that fails'
script failing.cag 'show 1/0'
try export failing.cag -o unmade/ball.stl
status 1
is_missing unmade

it 'an output in a folder that cannot be made'
try export ball.cag -o /proc/nowhere/below/ball.stl
status 3
says '/proc/nowhere'
prints_nothing

it 'an output below a file'
try export ball.cag -o ball.stl/more.stl
status 3

it 'an output that is write-protected'
printf earlier > kept.stl
chmod 400 kept.stl
if needs_permissions; then
  try export ball.cag -o kept.stl
  status 3
  holds kept.stl earlier
fi
chmod 600 kept.stl

it 'an output with an empty name'
try export ball.cag -o '' --format stl
status 2

it 'render checks its output before it works'
try render ball.cag -o ball.stl/ball.png
status 3
prints_nothing

it 'an output keeps its permissions'
cp ball.stl mode.stl
chmod 640 mode.stl
try export ball.cag -o mode.stl
[ "$(stat -c %a mode.stl)" = 640 ] || wrong 'the permissions changed'

it 'a full disk is an error, for a device'
try export ball.cag -o /dev/full --format stl
status 3
says 'No space left'

it 'a full disk leaves the earlier output'
mkdir disk
if mount -t tmpfs -o size=64k tmpfs disk 2> err; then
  printf earlier > disk/ball.stl
  try export ball.cag -o disk/ball.stl --tolerance 0.001
  status 3
  says 'No space left'
  holds disk/ball.stl earlier
  no_temporaries disk
  umount disk
fi

it 'a standard output that is full is an error'
ran='cag run > /dev/full' && "$CAG" run ball.cag -q > /dev/full 2> err
code=$?
: > out
status 3
says 'standard output'

it 'a standard output that is closed is an error'
ran='cag run >&-' && "$CAG" run ball.cag -q 2> err >&-
code=$?
status 3
says 'standard output'

it 'help and values notice a full standard output too'
"$CAG" --help > /dev/full 2> err
code=$?
status 3
"$CAG" eval '1 + 1' > /dev/full 2> err
code=$?
status 3
"$CAG" export ball.cag -o - --format stl > /dev/full 2> err
code=$?
status 3

it 'a reader that goes away is no message'
script lines.cag 'print join([for i in 0..<200000: "line {i}"], "\n")
print "more"'
ran='cag run lines.cag | head -n 1'
("$CAG" run lines.cag 2> err; echo $? > code) | head -n 1 > out
code=$(cat code)
prints_exactly 'line 0'
status 3
says_nothing
("$CAG" export ball.cag -o - --format obj --tolerance 0.0005 -q 2> err; echo $? > code) | head -n 1 > out
code=$(cat code)
status 3
grep -v '^printed$' err > others
[ ! -s others ] || wrong 'there is a message'

it 'a failing script prints what came before'
script half.cag 'print "first"
print 1/0'
try run half.cag
status 1
prints_exactly first
says 'half.cag:2:7'

it 'a symbolic link stays one'
printf earlier > target.stl
ln -s target.stl alias.stl
try export ball.cag -o alias.stl
status 0
[ -L alias.stl ] || wrong 'the link was replaced'
cmp -s target.stl ball.stl || wrong 'the target was not written'

it 'an output is written where standard input is closed'
"$CAG" export curve.cag -o closed.svg <&- > out 2> err
code=$?
status 0
exists closed.svg

# The letters are those of the compiled-in font, and H has no rounded parts: the middle label is half of its height, 1409/2048 of 3 mm, below its
# point. The upper text is as far above its point as the top of the lower text is below it.
it 'a label above stands as far above its place as one below stands below'
script labels.cag 'show line([0, 0], [40, 20])
show label([10, 5], "HHa", place: "above", size: 3), label([10, 5], "HHc", place: "center", size: 3)
show label([10, 5], "HHb", place: "below", size: 3)'
try export labels.cag -o labels.svg
status 0
# The baseline of a text: the lowest y of its first letter.
foot() { sed -n "/aria-label=\"$1\"/{n;s/.* d=\"\([^Z]*\)Z.*/\1/;s/[ML]//gp}" labels.svg | awk '{ y = 1e9; for (i = 2; i <= NF; i += 2) if (-$i < y) y = -$i; print y }'; }
echo "$(foot HHa) $(foot HHc) $(foot HHb)" > feet
awk '{ h = 3 * 1409 / 2048; d = ($1 - 5) - (5 - ($3 + h)); c = $2 - (5 - h / 2); exit !(NF == 3 && $1 > 5 && $3 < $2 && d * d < 1e-6 && c * c < 1e-6) }' feet ||
  wrong "they stand at $(cat feet)"

it 'a .json has samples of formulas, and labels'
script data.cag 'show curve(t => [t, t^2, exp(t)], 0..2) |> named("wave")
show label([1, 2, 3], "here", place: "above_left", mark: "dot", size: 4)'
try export data.cag -o data.json
status 0
script data_of.cag 'data = read_json("data.json")
s = data.items[0].curve.samples
print len(s.parameters) == len(s.points), s.parameters[0], s.parameters[-1]
print [for [t, p] in zip(s.parameters, s.points) if not near(p, [t, t^2, exp(t)]): t]
l = data.labels[0]
print len(data.labels), l.text, l.at, l.place, l.mark, l.size'
try run data_of.cag
prints_exactly 'true 0 2
[]
1 here [1, 2, 3] above_left dot 4'

# --- Exports that fail ---

# fails_whole FORMAT SCRIPT WHY [OPTION ...]: checks that an export fails with the message, that it leaves neither a new nor a temporary
# file, and that an existing file does not change.
fails_whole() {
  format=$1 why=$3
  printf '%s\n' "$2" > "fails_$format.cag"
  shift 3
  it "a failed export leaves no .$format file: $why"
  mkdir -p "fails_$format"
  try export "fails_$format.cag" "$@" -o "fails_$format/new.$format"
  status 1
  says "$why"
  [ -z "$(ls -A "fails_$format")" ] || wrong "files are left: $(ls -A "fails_$format")"
  echo old > "fails_$format/old.$format"
  try export "fails_$format.cag" "$@" -o "fails_$format/old.$format"
  status 1
  holds "fails_$format/old.$format" old
  [ "$(ls -A "fails_$format")" = "old.$format" ] || wrong "files are left: $(ls -A "fails_$format")"
}

wave='show surface((u, v) => [u, v, if u > 0.3 and u < 0.4 then sqrt(v - 2) else 0], 0..1, 0..1)'
fails_whole step "$wave" 'sqrt expects a number of at least 0' --tolerance 0.01
fails_whole igs "$wave" 'sqrt expects a number of at least 0' --tolerance 0.01
undefined='overflows or is undefined'
fails_whole pov 'show sphere(1), point_light([0, 0, 100], color: [10, 1, 1], strength: 1.7e308)' "$undefined"
fails_whole svg 'show circle(1), label([1.7e308, -1.7e308], "a"), label([-1.7e308, 0], "b")' "$undefined"
fails_whole urdf 'show robot([revolute(a: 1, shape: material(box([1, 1, 1]), {density: 1.7e308})),
  revolute(a: 1, shape: material(box([1e3, 1e3, 1e3]), {density: 1.7e308}))])' "$undefined"

it 'a label of .svg has its mark at its point'
script marks.cag 'show circle(10), label([10, 0], "P", mark: "cross"), label([0, 10], "Q", mark: "circle"), label([-10, 0], "R", mark: "dot")'
try export marks.cag -o marks.svg
status 0
if needs python3; then
  # The middle of each mark, as the middle of its points: arcs of circles, and the cross with its round ends.
  try_command python3 -c '
import re
picture = open("marks.svg").read()
def middle(path):
    v = [float(x) for x in re.sub(r"A (\S+ ){5}|[MLCZ,]", " ", path).split()]
    return (min(v[0::2]) + max(v[0::2])) / 2, (min(v[1::2]) + max(v[1::2])) / 2
for name, x, y in (("P", 10, 0), ("Q", 0, -10), ("R", -10, 0)):
    paths = re.findall(" d=\"([^\"]*)\"", picture.split("aria-label=\"" + name)[1].split("</g>")[0])
    assert len(paths) == (3 if name == "Q" else 2), paths
    for path in paths[:-1]:
        at = middle(path)
        assert abs(at[0] - x) < 1e-3 and abs(at[1] - y) < 1e-3, (name, at)
assert picture.count("#ffffff") == 1'
  status 0
fi

it 'a spot light and a panorama are in .json as they were said'
script light.cag 'show box(3), spot_light([10, 10, 10], [0, 0, 0], angle: 90deg), sky("sky.exr")'
try export light.cag -o light.json
status 0
grep -q '"kind":"spot","position":\[10,10,10\]' light.json || wrong 'no spot light'
grep -q '"angle":1.57079632679489' light.json || wrong 'the angle is not pi / 2'
grep -q '"direction":\[-0.57735026918962[0-9]*,' light.json || wrong 'the direction is not along [-1, -1, -1]'
grep -q '"sky":{"image":"sky.exr"}' light.json || wrong 'no panorama'

# --- Default tolerances ---

triangles_of() { python3 -c 'import struct, sys; print(struct.unpack("<I", open(sys.argv[1], "rb").read()[80:84])[0])' "$1"; }

it 'the default tolerance follows the size of all that is shown' python3
script large.cag 'show box([1000, 1000, 10])
show [for i in 0..40: translate(sphere(5), [(i % 8)*100 + 100, floor(i/8)*100 + 100, 15])]
show ground(size: 100000)'
try export large.cag -o large.stl -v
status 0
# A thousandth of the diagonal is 1.41 mm. The balls are 17.3 mm across their corners, of which 1/32 is 0.54 mm.
says 'tolerances 0.541266 to 1 mm, by the size of what is shown'
# By the size of each, the balls have 107,256 triangles.
[ "$(triangles_of large.stl)" -lt 12000 ] || wrong "$(triangles_of large.stl) triangles"
for radius in 9.5 10 12; do
  script ball.cag "show sphere($radius)"
  try export ball.cag -o ball.stl -v
  cat err >> balls
done
# Diagonals of 32.9, 34.6, and 41.6 mm.
[ "$(grep -o 'tolerance 0[.0-9]*' balls | sort -u)" = 'tolerance 0.03125' ] || wrong "$(cat balls)"
try export ball.cag -o ball.stl -v --tolerance 0.2
says 'tolerance 0.2 mm, by --tolerance'
script own.cag 'show sphere(10) |> tolerance(0.3)'
try export own.cag -o own.stl -v
says 'tolerance 0.3 mm, by `tolerance`'

it 'a section has the default tolerance of the whole' python3
script whole.cag 'show sphere(10)'
try export whole.cag -o whole.stl -v --section x=-5
status 0
says 'tolerance 0.03125 mm'
