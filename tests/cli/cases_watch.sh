# --watch: runs again after each save. Waits poll with a generous limit, because the machine may be busy.

# shows FILE TEXT [COUNT]: waits until the text is in the file COUNT times.
shows() {
  waited=0
  while [ "$(grep -cF -e "$2" "$1")" -lt "${3:-1}" ]; do
    sleep 0.05
    waited=$((waited + 1))
    [ $waited -lt 600 ] || {
      wrong "waited for: $2"
      return 1
    }
  done
}
# The program ignores SIGINT here, because a shell sets that for what it runs in the background, so SIGTERM stands for Ctrl-C.
start() {
  ran="cag $*"
  : > out
  : > err
  "$CAG" "$@" > out 2> err < /dev/null &
  watcher=$!
}
finish() {
  kill -TERM $watcher
  wait $watcher
  code=$?
  check_end
  status 130
}

for polled in '' 1; do
  it "a script runs at each save${polled:+, without events}"
  [ -z "$polled" ] || export CAG_WATCH_POLL=1
  echo 'print "one"' > w.cag
  start run w.cag --watch
  shows out one
  shows err waiting
  echo 'print "two"' > w.cag
  shows out two
  # Saved by renaming, as many editors do
  echo 'print "three"' > w.tmp && mv w.tmp w.cag
  shows out three
  # Deleted and made again
  rm w.cag
  shows err 'cannot read'
  echo 'print "four"' > w.cag
  shows out four
  # An error, and then its fix
  echo 'print oops' > w.cag
  shows err 'unknown name `oops`'
  echo 'print "five"' > w.cag
  shows out five
  # Two saves in a row: the last one counts
  echo 'print "never mind"' > w.cag && echo 'print "six"' > w.cag
  shows out six
  finish
  unset CAG_WATCH_POLL
done

it 'a newer save stops the run before'
echo 'print trace("begun")
f(n) = f(n + 1)
print f(0)' > w.cag
start run w.cag --watch
shows err begun
echo 'print "fast"' > w.cag
shows out fast
finish
says_not interrupted

it 'Ctrl-C ends a run that takes long'
echo 'print trace("begun")
f(n) = f(n + 1)
print f(0)' > w.cag
start run w.cag --watch
shows err begun
finish

it 'imports, data, and images are watched, and files that are missing'
mkdir -p data
rm -f part.cag
echo 'import "part.cag" as part
print "size {part.size}", read_csv("data/points.csv")' > w.cag
echo '1,2' > data/points.csv
start run w.cag --watch
shows err 'unknown module'
echo 'size = 7' > part.cag
shows out 'size 7'
echo 'size = 8' > part.cag
shows out 'size 8'
echo '3,4' > data/points.tmp && mv data/points.tmp data/points.csv
shows out '[3, 4]'
finish

it 'a failed run keeps the last good output'
echo 'show sphere(10)' > w.cag
start export w.cag -o kept.stl --watch
shows err 'done'
exists kept.stl
cp kept.stl first.stl
echo 'show sphere(' > w.cag
shows err 'failed'
same kept.stl first.stl
echo 'show box(1)' > w.cag
shows err 'done' 2
[ "$(wc -c < kept.stl)" -eq 684 ] || wrong 'the output is not that of the box'
finish
no_temporaries .

# size_is FILE BYTES: waits until a file has this size.
size_is() {
  waited=0
  until [ -e "$1" ] && [ "$(wc -c < "$1")" -eq "$2" ]; do
    sleep 0.05
    waited=$((waited + 1))
    [ $waited -lt 600 ] || {
      wrong "waited for $2 bytes of $1"
      return 1
    }
  done
}

it 'on a terminal, the messages of a run replace those before' python3
echo 'show box(1)' > w.cag
python3 "$here/on_terminal.py" sh -c 'echo $$ > pid; exec "$0" export w.cag -o t.stl --watch' "$CAG" > shown &
size_is t.stl 684
echo 'show tessellate(box(1)), box(1)' > w.cag
size_is t.stl 1284
kill -TERM "$(cat pid)"
wait $!
code=$?
status 130
[ "$(grep -c "$(printf '\033')\[H$(printf '\033')\[2J" shown)" -eq 1 ] || wrong 'the screen is not cleared once'
grep -q 'w.cag changed' shown || wrong 'the file that changed is not named'

it 'pictures are rendered again'
echo 'show sphere(10)' > w.cag
start render w.cag -o 'p.%s.png' --views top,iso --size 32x24 --quality draft --watch
shows err 'done'
cp p.top.png first.png
echo 'show box(1)' > w.cag
shows err 'done' 2
! cmp -s p.top.png first.png || wrong 'the picture is the same'
finish

# The script reads the picture that is written.
it 'the output does not cause another run'
"$CAG" render w.cag -o self.exr --size 8x8 --quality draft
echo 'image = read_image("self.exr")
print "read {image}"
show box(1)' > w.cag
start render w.cag -o self.exr --size 8x8 --quality draft --watch
shows err 'done'
sleep 1
[ "$(grep -c read out)" -eq 1 ] || wrong 'it ran again'
finish

it 'what cannot be watched is refused'
try run - --watch
status 2
says '--watch needs a script in a file'
try run missing.cag --watch
status 3
says 'missing.cag'
try render w.cag -o p.png --watch --keep-partial
status 2
try eval 1 --watch
status 2

it 'a reader that is gone ends the watch'
echo 'print "x"' > w.cag
("$CAG" run w.cag --watch 2> err; echo $? > code) | head -1 > out &
shows out x
echo 'print "y"' > w.cag
echo 'print "z"' >> w.cag
waited=0
while [ ! -s code ] && [ $waited -lt 600 ]; do
  sleep 0.1
  waited=$((waited + 1))
  echo "print $waited" > w.cag
done
exists code
