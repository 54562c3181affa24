# Operands that are folders, standard input, or nothing; options before the command; and colors on terminals.

script one.cag 'print 1 // expect: 1'

it 'options and -- may stand before the command'
try -q --max-time 5 eval 1+1
status 0
prints_exactly 2
try -qI. eval 1+2
prints_exactly 3
try -- eval 1+3
prints_exactly 4
try --
status 0
try eval -x
status 2
says 'an expression that begins with - comes after --'
try eval -- -2
prints_exactly -2
try -h
status 0
prints 'Commands:'
try export one.cag -o ''
status 2
says "-o '': expected a name"
script ball.cag 'show sphere(10)'
try export ball.cag -o - --format .obj
status 0
prints_like '^v '
try export ball.cag -o a.pov --pov-csg other
status 2
says 'choose auto, native, or mesh'

it 'a folder stands for the scripts below it'
mkdir -p tree/b tree/.hidden 'tree/not.cag'
script tree/a.cag 'print 1 // expect: 1'
script tree/b/c.cag 'print 2 // expect: 2'
script tree/.hidden/d.cag 'print 3 // expect: 4'
script tree/x 'print 3 // expect: 4'
script 'tree/.cag' 'print 3 // expect: 4'
ln -s .. tree/b/loop
ln -s nowhere.cag tree/broken.cag
ln -s a.cag tree/link.cag
for folder in tree tree/; do
  try test $folder
  status 0
  prints_exactly '3 passed, 0 failed, 0 skipped'
done
cd tree
try test -v
cd ..
grep -q '^passed b/c.cag ' tree/out || wrong 'names begin with the folder itself'
rm tree/out tree/err
try doc tree
status 0
try test tree nowhere
status 3
says 'cannot read nowhere: No such file or directory'
if needs_permissions; then
  mkdir tree/locked
  chmod 000 tree/locked
  try check tree
  status 3
  says 'cannot read tree/locked: Permission denied'
  chmod 700 tree/locked
fi

it 'a folder without scripts'
mkdir bare
for command in test fmt check; do
  try $command bare
  status 0
  says 'no scripts found'
  try $command bare -q
  says_nothing
done
cd bare
try fmt
cd ..
grep -q 'no scripts found' bare/err || wrong 'the folder one is in has scripts'

it 'standard input is a test'
with_input one.cag test - -D unused=1
prints_like '1 failed'
with_input one.cag test - -v
status 0
prints 'passed <stdin>'
script param.cag 'param n = 1
print n // expect: 7'
with_input param.cag test - -D n=7
status 0
prints_exactly '1 passed, 0 failed, 0 skipped'

it 'words of other languages, and operands that make no site'
try doc cube
status 2
says 'in cag, write'
try doc --html site - --no-pictures
status 2
says "--html expects scripts and folders, found '-'"
is_missing site
try doc sin cos
status 0
prints 'cos('

it 'a film from standard input' povray
{
  for i in $(seq 3000); do echo "// A comment that makes the script longer than what is read at once."; done
  echo 'show sphere(10 + frame)'
} > long.cag
with_input long.cag render - -o film.%d.png --frames 0..1 --size 32x24 --quality draft -v
status 0
says 'wrote film.0.png in'
exists film.1.png
name=$(printf '%04090d' 0)
try render ball.cag -o "$name%d.png" --frames 10..10
status 3

it 'a picture for standard output that cannot be made or written' povray
ran='cag render -o - (TMPDIR is not there)'
TMPDIR=/no/where "$CAG" render ball.cag -o - --format png --size 32x24 --quality draft > out 2> err
code=$?
status 3
says 'set TMPDIR to a folder that you may write to'
ran='cag render -o - > /dev/full'
"$CAG" render ball.cag -o - --format png --size 32x24 --quality draft > /dev/full 2> err
code=$?
status 3
says 'cannot write standard output'
ran='cag render -o - (TMPDIR is relative)'
TMPDIR=here "$CAG" render ball.cag -o - --format png --size 32x24 --quality draft > picture.png 2> err
code=$?
status 0
begins_with picture.png 89504e470d0a1a0a

# Errors have colors on terminals that show them.
it 'colors in errors'
script wrong.cag 'print sin(30)'
colors() {
  expected=$1
  shift
  ran="cag run wrong.cag ($*)"
  env -u NO_COLOR -u TERM "$@" python3 "$here/on_terminal.py" "$CAG" run wrong.cag $color > out 2> err
  code=$?
  status 1
  found=no
  ! grep -q "$(printf '\033')" out || found=yes
  [ $found = "$expected" ] || wrong "colors: $found"
}
if needs python3; then
  color=
  colors yes TERM=xterm
  colors no TERM=dumb
  colors no
  colors no TERM=xterm NO_COLOR=1
  colors yes TERM=xterm NO_COLOR=
  color='--color never'
  colors no TERM=xterm
  color='--color always'
  colors yes TERM=dumb
  color='--diagnostics json'
  colors no TERM=xterm
fi
