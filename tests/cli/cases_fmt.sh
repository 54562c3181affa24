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

it 'a table of numbers gets columns, and comments keep their rows'
printf 'm = [[1000000, 2000000, 3000000, 4000000],  // first\n[1, -2, 3.5, 4], [10, 20, 30, 40], [100, 200, 300, 400]]\n' > table.cag
with_input table.cag fmt -
status 0
cat > table.expected <<'END'
m = [
  [1000000, 2000000, 3000000, 4000000],  // first
  [      1,      -2,     3.5,       4],
  [     10,      20,      30,      40],
  [    100,     200,     300,     400]
]
END
same out table.expected

it 'line ends of Windows, a byte order mark, and a file without a last newline'
printf '\357\273\277a=1\r\nb  = [ 1,2 ]   // two\r' > windows.cag
try fmt windows.cag
status 0
same windows.cag neat.expected
printf 'a=1;b=[1,2]// two' > ends.cag
try fmt ends.cag
same ends.cag neat.expected
: > empty.cag
try fmt --check empty.cag
status 0

it 'what is not text in UTF-8 stays as it is'
printf 'a=1 // \377\n' > bytes.cag
printf 'a=1\000\nb=2\n' > zero.cag
cp bytes.cag bytes.before; cp zero.cag zero.before
try fmt bytes.cag zero.cag
status 1
says 'the byte 0xFF is not UTF-8 here'
says 'zero.cag is not a text in UTF-8'
same bytes.cag bytes.before
same zero.cag zero.before

it 'brackets beyond the limit are told, and long texts are laid out in no time'
awk 'BEGIN { printf "x = "; for (i = 0; i < 200000; i++) printf "("; print 1 }' > deep.cag
try fmt --check deep.cag
status 1
says 'brackets are nested more than 1000 deep'
awk 'BEGIN { printf "x = [1"; for (i = 0; i < 1000000; i++) printf ",%d", i; print "]" }' > wide.cag
try fmt wide.cag
status 0
try fmt --check wide.cag
status 0

it 'a link stays a link, and its target keeps its permissions'
cp loose.cag target.cag; chmod 640 target.cag
ln -sf target.cag link.cag
try fmt link.cag
status 0
[ -L link.cag ] || wrong 'the link is gone'
same target.cag neat.expected
[ "$(stat -c %a target.cag)" = 640 ] || wrong 'its permissions are others'

it 'what is write-protected is told'
mkdir -p kept
cp loose.cag kept/a.cag
if needs_permissions; then
  chmod 444 kept/a.cag
  try fmt kept/a.cag
  status 3
  says 'write-protected'
fi

it 'what cannot be written is told'
ln -sf nowhere.cag dangling.cag
try fmt dangling.cag
status 3
mkfifo pipe.cag
{ cat loose.cag > pipe.cag; } &
try fmt pipe.cag
status 3
says 'it is not a regular file'
{ cat loose.cag > pipe.cag; } &
try fmt --check pipe.cag
status 1
prints_exactly pipe.cag
try fmt /dev/zero
status 3
says 'too large'

it '--check and --diff together show the difference, and -q names nothing'
try fmt --check --diff loose.cag
status 1
prints '+b = [1, 2]  // two'
try fmt --check -q loose.cag
status 1
prints_nothing
with_input loose.cag fmt --check -
status 1
prints_exactly '<stdin>'

it 'killed while it writes, it leaves the old file or the new one'
mkdir -p killed
awk 'BEGIN { for (i = 0; i < 200000; i++) print "a_" i "=[ " i ",2 ]   // two" }' > killed.before
cp killed.before killed/k.cag
try fmt killed/k.cag
cp killed/k.cag killed.after
ran='cag fmt (SIGKILL)'
for round in 1 2 3 4 5; do
  cp killed.before killed/k.cag
  "$CAG" fmt killed/k.cag > out 2> err &
  child=$!
  while kill -0 $child 2> /dev/null && [ "$(ls -A killed)" = k.cag ]; do :; done
  kill -KILL $child 2> /dev/null
  wait $child 2> /dev/null
  cmp -s killed/k.cag killed.before || same killed/k.cag killed.after
  rm -f killed/.k.cag*
done

it 'the examples, the cookbook and the library have the layout'
try fmt --check "$root/examples" "$root/stdlib" "$root/docs/cookbook"
status 0

it 'patch applies the output of --diff, for random scripts'
if needs patch; then
  # Random scripts of 0 to 60 lines with a fixed seed, formatted or not. Some lack the final newline.
  for seed in 1 2 3 4 5 6 7 8 9 10 11 12; do
    awk -v seed=$seed 'BEGIN {
      srand(seed)
      n = int(rand() * 60)
      for (i = 0; i < n; i++) {
        loose = rand() < (seed % 4) / 4
        line = loose ? "x" i "=" i "+1" : "x" i " = " i " + 1"
        printf "%s%s", line, i + 1 == n && seed % 3 == 0 ? "" : "\n"
      }
    }' > drawn.cag
    cp drawn.cag formatted.cag
    try fmt formatted.cag
    status 0
    try fmt --diff drawn.cag
    if cmp -s drawn.cag formatted.cag; then
      prints_nothing
      continue
    fi
    status 1
    patch -s drawn.cag out > patched 2>&1 || wrong "seed $seed: patch fails: $(cat patched)"
    same drawn.cag formatted.cag
  done
fi
