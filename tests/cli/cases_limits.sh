# Limits of a run: status 5 and an ordinary error with its code.

script endless.cag 'f(n) = f(n + 1)
print f(0)'
script memory.cag 'print len([for i in 0..<1e8: [i, i, i]])'
script depth.cag 'f(n) = if n == 0 then 0 else 1 + f(n - 1)
print f(500)'
script ball.cag 'show sphere(10)'

it '--max-time ends an endless run'
try run endless.cag --max-time 0.3
status 5
says 'endless.cag:1:'
says '--max-time'

it '--max-memory bounds the values'
try run memory.cag --max-memory 20M
status 5
says 'memory.cag:1:'

it '--max-memory bounds the texts of values that share their parts'
# Each of 60 steps makes one list, but doubles the length of the printed text.
for text in 'json(f(60, "a"))' 'json(f(60, { a: none }))' 'text(f(60, 1), digits: 2)' 'text(f(60, "a"))' 'join(f(60, 1))' \
  '"{f(60, 1)}"'; do
  script shared.cag "f(n, t) = if n == 0 then t else f(n - 1, [t, t])
print len($text)"
  (ulimit -v 2000000; try run shared.cag --max-memory 20M; echo "$code" > ended)
  code=$(cat ended)
  ran="cag run: $text"
  status 5
  says '--max-memory'
  try run shared.cag --max-time 0.5
  status 5
done
script replaced.cag 'print len(replace(join(repeat("a", 9000)), "a", join(repeat("b", 9000))))'
script shared.cag 'f(n, t) = if n == 0 then t else f(n - 1, [t, t])
print f(60, 1), { a: f(60, "a") }'
try run shared.cag --max-memory 20M
status 5
says '--max-memory'
try run replaced.cag --max-memory 20M
status 5
says '--max-memory'

it '--max-memory bounds the letters of texts, with what their shaping needs'
# 1.2 million letters. In kilobytes, the limit on addresses is that of the memory and a margin for the program and its libraries.
script letters.cag 'print lettering_metrics(join([for i in 1..200000: "a(b, 1 "]))'
(ulimit -v 1000000; try run letters.cag --max-memory 60M; echo "$code" > ended)
code=$(cat ended)
status 5
says '--max-memory'

it 'what is freed does not count'
script fold.cag 'print reduce(0..<300000, [0, 0], (acc, i) => acc + [i, 1])'
try run fold.cag --max-memory 24M
status 0
prints_exactly '[44999850000, 300000]'

it '--max-depth bounds calls'
try run depth.cag --max-depth 100
status 5
says 'depth.cag:1:'
try run depth.cag --max-depth 600
status 0
prints_exactly 500

it 'ten thousand calls deep is well, and tail calls have no depth'
script deep.cag 'f(n) = if n == 0 then 0 else 1 + f(n - 1)
g(n, acc) = if n == 0 then acc else g(n - 1, acc + 1)
print f(9000), g(100000, 0)'
try run deep.cag
status 0
prints_exactly '9000 100000'

it '--max-triangles bounds meshes, and leaves the earlier output'
printf earlier > ball.stl
try export ball.cag -o ball.stl --max-triangles 50
status 5
says 'triangles'
holds ball.stl earlier
no_temporaries .

it 'a limit behind warnings is status 5, and told however many there are'
script folds.cag 'path(x) = interpolate([[x, 0, 0], [x + 5, 0, 0], [x + 5, 1, 0], [x, 1, 0]])
param count = 1
show [for i in 0..<count: sweep(circle(3 + i / 1000), path(30 * i))]'
try export folds.cag -o folds.stl --max-triangles 100
status 5
says 'warning: sweep'
says 'the limit is 100'
try export folds.cag -o folds.stl --max-triangles 100 -D count=25
status 5
says 'warning: sweep.19'
says '6 more not shown'
says 'the limit is 100'
is_missing folds.stl

it 'attempt does not catch a limit'
script attempt.cag 'f(n) = f(n + 1)
print attempt(() => f(0), e => "caught")'
try run attempt.cag --max-time 0.3
status 5
prints_nothing

it 'eval has limits too'
try eval 'len([for i in 0..<1e9: [i, i]])' --max-memory 16M
status 5

it 'dashes that are too many are refused before they are made'
script dashes.cag 'show line_style(circle(9), dash: 1e-9)'
try export dashes.cag -o dashes.stl --max-time 5
status 5
says 'dashes need more'

it 'built-ins without an end of their own look at the clock'
try eval 'join(0..1e9)' --max-time 0.3
status 5
says '--max-time'

# --- All long operations end soon after the limit ---

# Runs cag with a limit of a second, or of $within seconds; it must end within two.
soon() {
  begun=$(date +%s%N)
  try "$@" --max-time "${within:-1}"
  took=$((($(date +%s%N) - begun) / 1000000))
  status 5
  says '--max-time'
  [ $took -lt 2000 ] || wrong "it took $took ms"
  no_temporaries .
}

script many.cag 'show sphere(1000), torus(300, 100)'
script heavy.cag 'show difference(sphere(100), translate(sphere(100), [30, 0.1, 0.2]))'
script high.cag 'c = interpolate([for i in 0..<200000: [i, sin(i * 1deg), cos(i * 3deg)]], degree: 60)
print at(c, start(c))'
script degree.cag 'c = bspline([for i in 0..5000: [i, sin(i * 1deg) * 100, i % 7]], degree: 999)
print length(c)'
script gon.cag 'r = region([for i in 0..<20000: [cos(i * 0.018deg), sin(i * 0.018deg)] * (100 + 10 * (i % 2))])
print area(difference(r, rotate(r, Z, 0.01deg)))'
script fit.cag 'c = fit([for i in 0..<200000: [i, sin(i * 1deg), cos(i * 3deg)]], degree: 40, count: 30000)
print length(c)'
script meet.cag 'a = bspline([for i in 0..3000: [i, sin(i * 40deg) * 100]])
b = bspline([for i in 0..3000: [i + 0.5, cos(i * 30deg) * 100]])
print len(intersect(a, b))'
script unseen.cag 'a = [for i in 0..<6000: random(i, 6000)]
print determinant(multiply(inverse(a), inverse(a)))'
script glass.cag 'show sphere(100)'

it '--max-time ends the meshing of an export'
printf earlier > many.stl
soon export many.cag -o many.stl --tolerance 1e-4
holds many.stl earlier

it '--max-time ends a set operation of heavy meshes at an export'
soon export heavy.cag -o heavy.stl --tolerance 0.0002
is_missing heavy.stl

it '--max-time ends interpolations of high degree'
soon run high.cag

it '--max-time ends curves of high degree'
soon run degree.cag

it '--max-time ends set operations of regions'
soon run gon.cag

it '--max-time ends fits'
soon run fit.cag

it '--max-time ends intersections of curves'
soon run meet.cag

it '--max-time ends linear algebra of large matrices'
soon run unseen.cag

it '--max-time ends the reading of a large file'
awk 'BEGIN { print "ply\nformat ascii 1.0\nelement vertex 3000000\nproperty float x\nproperty float y\nproperty float z\nelement face 3000000\nproperty list uchar int vertex_indices\nend_header"
  for (i = 0; i < 3000000; i++) print i % 1000, i / 1000, i % 7
  for (i = 0; i < 3000000; i++) print 3, i, (i + 1) % 3000000, (i + 999) % 3000000 }' > large.ply
script large.cag 'print [for i in 1..5: read_mesh("large.ply")]'
within=0.2
soon run large.cag
within=1
rm large.ply

it '--max-time is that of the script and the renderer together'
if needs povray; then
  printf earlier > glass.png
  soon render glass.cag -o glass.png --size 3000x2000 --quality final
  holds glass.png earlier
  is_missing glass.exr
fi

it 'a file that is larger than the memory that is left is not read'
head -c 60000000 /dev/zero > zeros.stl
script zeros.cag 'print read_mesh("zeros.stl")'
try run zeros.cag --max-memory 20M
status 5
says '--max-memory'
says 'zeros.stl'
rm zeros.stl

it 'a robot that needs more memory than it may have'
awk 'BEGIN { print "<robot name=\"long\"><link name=\"l0\"/>"
  for (i = 1; i <= 4000; i++) printf "<link name=\"l%d\"><visual><geometry><box size=\"1 1 1\"/></geometry></visual></link><joint name=\"j%d\" type=\"revolute\"><parent link=\"l%d\"/><child link=\"l%d\"/><axis xyz=\"0 0 1\"/><origin xyz=\"1 0 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint>\n", i, i, i - 1, i
  print "</robot>" }' > long.urdf
script long.cag 'print read_urdf("long.urdf")'
try run long.cag --max-memory 3M
status 5
says '--max-memory'

it 'a memory limit that is too small for the built-ins'
for limit in 1 10K; do
  try eval --max-memory $limit 1+1
  status 5
  says '--max-memory'
done
try export ball.cag -o ball.stl --max-memory 10K
status 5
says '--max-memory'

it 'no script takes much more memory than it may' python3
# A tenth of the scripts; CAG_HOSTILE=1 runs all.
if ! python3 "$here/hostile.py" "$CAG" "$here/hostile.txt" "${CAG_HOSTILE:-10}" > out 2> err; then
  wrong "$(cat out err)"
fi
