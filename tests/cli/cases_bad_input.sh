# Input that is wrong: a message with its place, the right exit status, nothing written.

# The output of an earlier run, which every failing export must leave alone.
printf 'earlier' > out.stl
# fails FILE STATUS TEXT: run and export of the script end so, with this text.
fails() {
  try run "$1"
  status "$2"
  says "$3"
  try export "$1" -o out.stl
  status "$2"
  says "$3"
  holds out.stl earlier
  no_temporaries .
}

it 'an empty script runs, and has nothing to export'
: > empty.cag
try run empty.cag
status 0
prints_nothing
says_nothing
try export empty.cag -o out.stl
status 1
says 'shows no shape'
holds out.stl earlier
try render empty.cag -o out.png
status 1
is_missing out.png

it 'a binary file is no script'
head -c 20000 "$CAG" > binary.cag
fails binary.cag 1 'binary.cag:'

it 'a file that is not there'
fails missing.cag 3 'missing.cag'
says 'No such file'

it 'a folder is no script'
mkdir folder.cag
fails folder.cag 3 'folder.cag'
says_like '[Ff]older\|directory'

it 'a file that may not be read'
script locked.cag 'print 1'
chmod 000 locked.cag
if needs_permissions; then fails locked.cag 3 'locked.cag'; fi
chmod 600 locked.cag

it 'ten megabytes on one line run'
awk 'BEGIN { printf "xs = [1"; for (i = 1; i < 5000000; i++) printf ",1"; print "]"; print "print len(xs)" }' > long.cag
try run long.cag
code_long=$code
[ "$code_long" -eq 0 ] || [ "$code_long" -eq 1 ] || wrong 'a long line ended otherwise'
[ "$code_long" -ne 0 ] || prints_exactly 5000000
bytes_at_most err 4000

it 'an error in a line of ten megabytes is shown in short'
awk 'BEGIN { printf "x = \""; for (i = 0; i < 1000000; i++) printf "0123456789"; print "\" + nothing" }' > long_error.cag
fails long_error.cag 1 'long_error.cag:1:10000010'
bytes_at_most err 4000

it 'a text of ten megabytes that does not end'
awk 'BEGIN { printf "x = \""; for (i = 0; i < 1000000; i++) printf "0123456789"; print "" }' > long_open.cag
fails long_open.cag 1 'long_open.cag:1:5'
bytes_at_most err 4000

for bracket in '(' '[' '{' 'f(' '-' 'not ' 'x => '; do
  it "a hundred thousand nested $bracket"
  awk -v b="$bracket" 'BEGIN { printf "x = "; for (i = 0; i < 100000; i++) printf "%s", b; print "" }' > nested.cag
  fails nested.cag 1 'nested.cag:1:'
  bytes_at_most err 20000
done

it 'a hundred thousand nested brackets that close'
awk 'BEGIN { printf "x = "; for (i = 0; i < 100000; i++) printf "["; for (i = 0; i < 100000; i++) printf "]"; print "" }' > nested.cag
fails nested.cag 1 'nested.cag:1:'
says '1000 deep'

it 'a text that is not ended'
script text.cag 'a = 1
x = "no end
print x'
fails text.cag 1 'text.cag:2:5'

it 'a comment that is not ended'
script comment.cag 'a = 1
/* no /* end */
print a'
fails comment.cag 1 'comment.cag:2:1'

it 'a raw text that is not ended'
script raw.cag 'x = `no end'
fails raw.cag 1 'raw.cag:1:5'

it 'a bracket that is not closed'
script bracket.cag 'x = [1, 2
y = 3'
fails bracket.cag 1 'bracket.cag:1:5'

it 'bytes that are not UTF-8, with their place'
printf 'a = 1\nx = "ab\377c"\n' > utf8.cag
fails utf8.cag 1 'utf8.cag:2:8'

it 'a byte of zero'
printf 'a = 1\nb\000c = 2\n' > zero.cag
fails zero.cag 1 'zero.cag:2:2'

it 'an unknown unit'
script unit.cag 'x = 3inch'
fails unit.cag 1 'unit.cag:1:'
says 'inch'

it 'a misspelt name gets the nearest'
script name.cag 'height = 20
print hieght'
fails name.cag 1 'name.cag:2:7'
says 'height'

it 'a misspelt built-in gets the nearest'
script builtin.cag 'show spere(10)'
fails builtin.cag 1 'builtin.cag:1:6'
says 'sphere'

it 'too many arguments'
script arity.cag 'f(x) = x
print f(1, 2)'
fails arity.cag 1 'arity.cag:2:'

it 'too few arguments of a built-in'
script few.cag 'show sphere()'
fails few.cag 1 'few.cag:1:'
says 'radius'

it 'an argument of an unknown name'
script argument.cag 'show sphere(radus: 10)'
fails argument.cag 1 'argument.cag:1:'
says 'radus'
says 'radius'

it 'endless recursion'
script recursion.cag 'f(n) = 1 + f(n + 1)
print f(0)'
fails recursion.cag 5 'recursion.cag:1:'
bytes_at_most err 6000

it 'endless recursion of two functions through a list'
script mutual.cag 'f(n) = [g(n)]
g(n) = [f(n)]
print f(0)'
fails mutual.cag 5 'mutual.cag:'

it 'an endless list'
script endless.cag 'print len(0..inf)'
fails endless.cag 1 'endless.cag:1:'
script endless_for.cag 'xs = [for i in 0..inf: i]
print len(xs)'
fails endless_for.cag 1 'endless_for.cag:1:'

it 'a list beyond the memory'
script huge.cag 'print len([for i in 0..1e14: i])'
try run huge.cag --max-memory 64M
status 5
says 'huge.cag:1:'

it 'a value that needs itself prints the circle'
script circle.cag 'a = b + 1
b = c * 2
c = a
print a'
fails circle.cag 1 'circle.cag:'
says 'a'
says_like 'b.*c\|c.*b'

it 'a circle of imports prints the circle'
script one.cag 'import two
x = 1'
script two.cag 'import one
y = 1'
fails one.cag 1 'two.cag'
says 'one'

it 'a script that imports itself'
script self.cag 'import self
x = 1'
fails self.cag 1 'self.cag:1:8'

it 'a module that is not there'
script module.cag 'x = 1
import nowhere.part
print x'
fails module.cag 1 'module.cag:2:8'
says 'nowhere'

it 'a name that the module does not have'
script lacks.cag 'import std.materials: gloss_of_the_moon
print 1'
fails lacks.cag 1 'lacks.cag:1:'

it 'an error in a module shows the place there'
script broken.cag 'x = 1
y = [1, 2'
script uses.cag 'import broken
print broken.x'
fails uses.cag 1 'broken.cag:2:5'

for path in ../../etc/passwd ../../../../../../etc/passwd /etc/passwd link /proc/self/environ; do
  it "a script cannot read $path"
  ln -sf /etc/passwd link
  script read.cag "print read_text(\"$path\")"
  fails read.cag 1 'read.cag:1:'
  ! grep -q 'root:' out err || wrong 'it was read'
done

it 'a script cannot import from elsewhere'
script outside.cag 'import "../../../etc/passwd"'
fails outside.cag 1 'outside.cag:1:'

it 'a file that a script asks for and that is not there is the failure of the script'
script expects.cag 'print read_csv("points.csv")'
fails expects.cag 1 'expects.cag:1:'
says 'points.csv'

it 'up to twenty errors are shown in one run'
awk 'BEGIN { for (i = 0; i < 30; i++) print "x" i " = nothing" i }' > many.cag
try run many.cag
status 1
[ "$(grep -c '^error' err)" -eq 20 ] || wrong 'not twenty errors'

it 'a failed assertion says the values'
script assertion.cag 'a = 3
assert a + 1 == 5, "the sum"'
fails assertion.cag 1 'assertion.cag:2:8'
says 'the sum'

it 'Windows line ends and a byte order mark are welcome'
printf '\357\273\277a = 1\r\nprint a\r\n' > windows.cag
try run windows.cag
status 0
prints_exactly 1

it 'a profile that crosses itself is reported, and exported all the same'
script knot.cag 'show revolve(polyline([[5, 0], [20, 10], [5, 20], [20, 0]])) |> named("knot")'
try export knot.cag -o knot.stl
status 0
says 'warning: knot: its profile crosses itself'
exists knot.stl

it 'a tube that meets itself is reported, and one that stays clear of itself is not'
script coil.cag 'show tube(helix(10, 3, 4), 2) |> named("coil")'
try export coil.cag -o coil.stl
status 0
says 'warning: coil: its path at v = '
says 'so it crosses itself'
script eight.cag 'show tube(curve(t => [20*cos(t), 20*sin(2*t), 0], 0deg..360deg), 2)'
try export eight.cag -o eight.stl
says 'its path at v = 90deg is 0 from that at v = 270deg, where the tube is 4 thick'
script bend.cag 'show tube(polyline([[0,0,0], [20,0,0], [20,5,0], [0,5,0]]), 3)'
try export bend.cag -o bend.stl
says 'so it crosses itself'
script clear.cag 'show tube(helix(10, 4.1, 4), 2), tube(circle(10), 3), tube(polyline([[0,0,0], [20,0,0], [0,4,0]]), 1)'
try export clear.cag -o clear.stl
says_not 'crosses itself'

it 'a loft whose sections lie in one plane is reported, and exported all the same'
script plate.cag 'show rotate([1, 2, 3], 30deg) * loft([circle(3), circle(5)]) |> named("plate")'
try export plate.cag -o plate.stl
status 0
says 'warning: plate: its sections lie in one plane, so the loft has no volume'
script cup.cag 'show loft([circle(3), translate([0, 0, 0.01]) * circle(5)])'
try export cup.cag -o cup.stl
says_not 'lie in one plane'

it 'a sweep that folds is reported, and exported all the same'
script fold.cag 'show sweep(circle(8), helix(5, 3, 4))'
try export fold.cag -o fold.stl
status 0
says 'so the surface folds there'
exists fold.stl
