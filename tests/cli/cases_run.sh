# run, eval, test, and the REPL through a pipe.

script vase.cag 'param height = 120 in 50..300 "height of the vase"
profile = bspline([[24, 0], [45, 0.3*height], [22, 0.7*height], [34, height]], degree: 3)
vase = revolve(profile)
print "height {height}"
show vase'

it 'run prints to standard output, and says on standard error what is shown'
try run vase.cag
status 0
prints_exactly 'height 120'
says 'vase'

it 'run -q leaves out what is shown'
try run vase.cag -q
status 0
says_nothing

it '-D sets a param'
try run vase.cag -D height=200
prints_exactly 'height 200'

it '--params takes a named set of the page'
script sets.cag 'param height = 10 in 1..20
param words = "none"
param turned = false
param angle = 30deg
print height, words, turned, angle'
echo '{"tall": {"height": 12.5, "words": "two words", "turned": true, "angle": "60deg"}, "flat": {"height": 2}}' > sets.cag.params.json
try run sets.cag --params sets.cag.params.json:tall
status 0
prints_exactly '12.5 two words true 60deg'
try run sets.cag --params sets.cag.params.json:tall -D height=3
prints_exactly '3 two words true 60deg'
try run sets.cag --params sets.cag.params.json:tal
status 2
says 'did you mean tall?'
try run sets.cag --params sets.cag:tall
status 2
says 'not a JSON object'
try run sets.cag --params none.json:tall
status 2
says 'cannot read none.json'
try run sets.cag --params sets.cag.params.json
status 2
says 'FILE:NAME'

it '-D of an unknown param gets the nearest'
try run vase.cag -D hieght=200
status 1
says 'no param `hieght`'
says 'height'

it '-D outside the range fails before anything runs'
try run vase.cag -D height=500
status 1
prints_nothing
says '50..300'

it '- is standard input'
script six.cag 'print 6 * 7'
with_input six.cag run -
status 0
prints_exactly 42

it '-I adds a folder of modules'
mkdir lib
script lib/part.cag 'size = 7'
mkdir main
script main/main.cag 'import part
print part.size'
try run main/main.cag
status 1
says 'main/main.cag:1:8'
try run main/main.cag -I lib
status 0
prints_exactly 7

it 'eval prints the value of each expression'
try eval '1 + 2' 'sin(30deg)' '"a" + "b"' '[1, "x"]' '90deg / 2'
status 0
prints_exactly '3
0.5
ab
[1, "x"]
45deg'

it 'eval sees definitions, of -D too'
try eval -D r=3 'd = 2 * r' 'd + 1'
status 0
prints_exactly 7

it 'an expression may begin with a sign'
try eval '-2^2' -- '-pi'
status 0
prints_exactly '-4
-3.141592653589793'

it 'eval writes a text bare'
try eval '"say \"hi\" \{x\}\tthere\\now"'
prints_exactly "$(printf 'say "hi" {x}\tthere\\now')"

it 'eval fails with the place'
try eval '1 + 1' 'sin(30)'
status 1
prints_exactly 2
says ':1:5'
says '30deg'

it 'test counts what passed'
script good_test.cag 'print 1 + 1   // expect: 2'
try test good_test.cag
status 0
[ "$(tail -n 1 out)" = '1 passed, 0 failed, 0 skipped' ] || wrong 'the last line is not the count'

it 'test counts what failed'
script bad_test.cag 'print 1 + 1   // expect: 3'
try test bad_test.cag
status 1
[ "$(tail -n 1 out)" = '0 passed, 1 failed, 0 skipped' ] || wrong 'the last line is not the count'

it 'the REPL works with a pipe'
printf 'x = 3\nx + 1\n:quit\n' > input
with_input input repl
status 0
prints '4'

it 'cag alone is the REPL'
with_input input
status 0
prints '4'

it 'the REPL begins with the definitions of a file'
printf 'vase\nheight + 1\n' > input
with_input input repl vase.cag
status 0
prints '121'

it 'the limit of one input of the REPL leaves all of it to what follows'
printf 'f(n) = if n == 0 then 0 else f(n - 1)\nshow [for i in 0..<20: sphere(1 + i)]\nf(1e12)\n:scene\n' > input
with_input input repl --max-time 0.5
says '--max-time'
prints_exactly 'a list of 20 elements'

it 'print without show needs no scene'
script plain.cag 'print "only text"'
try run plain.cag
status 0
says_nothing

it 'standard input may be closed'
ran='cag run vase.cag <&-' && "$CAG" run -q vase.cag > out 2> err <&-
code=$?
status 0
prints_exactly 'height 120'

it 'files that a script reads are looked for beside it, then in the folders of -I'
mkdir -p data_one data_two reading
printf '1,2\n' > data_one/numbers.csv
printf '3,4\n' > data_two/numbers.csv
printf '{"a": 5}' > data_two/record.json
printf 'solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n' > data_two/flat.stl
printf '<robot name="arm"><link name="base"/><link name="tip"/><joint name="j" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>' > data_two/arm.urdf
script reading/all.cag 'print read_csv("numbers.csv")
print read_json("record.json").a, area(read_mesh("flat.stl")), read_urdf("arm.urdf").joints'
try run reading/all.cag -I data_one -I data_two
status 0
prints_exactly '[[1, 2]]
5 0.5 1'
try run reading/all.cag -I data_two -I data_one
prints '[[3, 4]]'
printf '7,8\n' > reading/numbers.csv
try run reading/all.cag -I data_one -I data_two
prints '[[7, 8]]'
try run reading/all.cag -I data_one
status 1
says 'record.json'
