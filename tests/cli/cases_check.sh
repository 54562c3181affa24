# cag check: errors without running, warnings, exit status, JSON for editors.

script good.cag 'print 1'
script unused.cag 'a = 1
print 2'
script wrong.cag 'error_when_run = error("it ran")
print sin(30), error_when_run'

it 'a good script is well'
try check good.cag
status 0
prints_nothing
says_nothing

it 'an error is told with its mend, and nothing runs'
try check wrong.cag
status 1
says 'sin expects an angle, found a number'
says 'write 30deg or 30rad'
says_not 'it ran'

it 'a warning does not fail'
try check unused.cag
status 0
says 'warning: a is not used'

it 'statements after a syntax error are checked'
script damaged.cag 'a = [1, 2
b = a + hieght
show sphere(-3), b'
try check damaged.cag
status 1
says 'this bracket is not closed'
says 'unknown name `hieght`'
says 'sphere expects a number greater than 0, found the number -3'

it 'JSON for editors'
try check wrong.cag unused.cag --diagnostics json
status 1
says '"severity":"error","code":"E0301"'
says '"severity":"warning","code":"E0900"'

it 'standard input can be checked'
with_input wrong.cag check -
status 1
says '<stdin>:2'

it 'a script that is not there is told'
try check nowhere.cag
status 3

it 'the examples, the cookbook and the library have nothing to warn of'
try check "$root/examples" "$root/stdlib" "$root/docs/cookbook"
status 0
prints_nothing
says_nothing

it 'the module path is looked through'
mkdir -p shelf
script shelf/tools.cag 'twice(x) = 2 * x'
script uses.cag 'import tools: twice
print twice(1, 2)'
try check uses.cag -I shelf
status 1
says 'twice takes 1 argument, found 2'

it 'the scripts of the library, the examples, the cookbook and the bench are right'
try check "$root/stdlib" "$root/examples" "$root/docs" "$root/tests/bench"
status 0
says_nothing

it 'so are the tests that expect no errors'
# A call that passes the failing function to another function (code, reason) intends its errors.
grep -rL --include='*.cag' -e 'expect error' -e '(() =>' "$root/tests/language" "$root/tests/vectors" | tr '\n' '\0' > right
[ "$(tr -cd '\0' < right | wc -c)" -gt 30 ] || wrong "there are few"
ran='cag check' && timeout $LONGEST xargs -0 "$CAG" check < right > out 2> err
code=$?
! grep -A2 '^error' err > errors || wrong "$(cat errors)"

it 'parts that share volume are reported with their names and the volume'
script clash.cag 'post = named(box(2), "post")
beam = named(box([4, 2, 2]), "beam")
show post, beam |> translate([1, 0, 0]), named(box(2), "block") |> translate([5, 0, 0])'
try check --interference clash.cag
status 1
prints_nothing
says 'error: parts `post` and `beam` share 4 mm3'
says 'clash.cag:1'
says_not block
try check clash.cag
status 0

it 'JSON of parts that share volume'
try check --interference clash.cag --diagnostics json
status 1
says '"severity":"error","code":"E0921"'
says 'parts `post` and `beam` share 4 mm3'
says '"line":1'

it 'parts that touch, and the bodies of a part, do not interfere'
script fits.cag 'param deep = 0
post = named(group(box(2), sphere(1)), "post")
block = box([9, 9, 2]) - (cylinder(9, 2) |> translate([4, 4, -1]))
show post, block |> translate([2 - deep, 0, 0]), cylinder(2, 2) |> translate([6 - deep, 4, 0])
show circle(3), camera([0, -9, 3]), ground()'
try check --interference fits.cag
status 0
says_nothing
try check --interference fits.cag -D deep=0.5
status 1
says 'parts `post` and `block` share'

it 'more than 20 pairs are all reported'
script many.cag 'show [for i in 0..30: named(box(2), "b{i}") |> translate([1.5*i, 0, 0])]'
try check --interference many.cag --diagnostics json
status 1
[ "$(grep -c E0921 err)" = 30 ] || wrong "$(grep -c E0921 err) pairs"

it 'an error of the run, and standard input'
script fails.cag 'show box(1)
assert 1 > 2'
try check --interference fails.cag
status 1
says 'assert'
with_input clash.cag check --interference -
status 1
says 'share 4 mm3'
