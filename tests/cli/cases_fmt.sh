# cag fmt: what it writes, what it leaves alone, --check and --diff.

printf 'a=1;b  = [ 1,2 ]   // two\n' > loose.cag
printf 'a = 1\nb = [1, 2]  // two\n' > neat.expected

it 'a script gets the one layout'
cp loose.cag one.cag
try fmt one.cag
status 0
prints_nothing
says_nothing
same one.cag neat.expected

it 'twice changes nothing, and does not touch the file'
touch -d '2001-01-01' one.cag
try fmt one.cag
status 0
[ "$(date -r one.cag +%Y)" = 2001 ] || wrong 'the file was written again'

it '--check names what is laid out otherwise and writes nothing'
cp loose.cag two.cag
try fmt --check one.cag two.cag
status 1
prints_exactly 'two.cag'
same two.cag loose.cag

it '--diff shows it, as patch reads it'
try fmt --diff two.cag
status 1
cp out two.patch
prints '+b = [1, 2]  // two'
patch -s two.cag two.patch || wrong 'patch does not take it'
same two.cag neat.expected

it '--diff of what is laid out says nothing'
try fmt --diff one.cag
status 0
prints_nothing

it 'standard input goes to standard output'
with_input loose.cag fmt -
status 0
same out neat.expected

it 'a script with errors stays as it is'
printf 'a=[1,\nb=2\n' > broken.cag
cp broken.cag broken.before; cp loose.cag one.cag
try fmt broken.cag one.cag
status 1
says "not closed"
same broken.cag broken.before

it 'a folder stands for its scripts'
mkdir -p parts/inner
cp loose.cag parts/inner/a.cag
cp loose.cag parts/notes.txt
try fmt parts
status 0
same parts/inner/a.cag neat.expected
same parts/notes.txt loose.cag

it 'a file that is not there is told'
try fmt nowhere.cag
status 3
says 'nowhere.cag'

it 'the examples and the library have the layout'
try fmt --check "$root"/examples/*.cag "$root/examples/curves" "$root/stdlib/curves.cag" "$root/stdlib/kinematics.cag" \
  "$root/stdlib/materials.cag" "$root/stdlib/surfaces.cag"
status 0
