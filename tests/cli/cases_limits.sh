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
