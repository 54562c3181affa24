# Ctrl-C and similar signals: status 130, and no incomplete files.

script endless.cag 'print "begun"
f(n) = f(n + 1)
print f(0)'
script ball.cag 'show sphere(10)'
mkdir temporary
# Runs cag until a signal arrives after this many seconds.
interrupted() {
  signal=$1 after=$2
  shift 2
  ran="cag $* (SIG$signal after $after s)"
  TMPDIR=$PWD/temporary timeout --preserve-status -k 20 -s "$signal" "$after" "$CAG" "$@" > out 2> err < /dev/null
  code=$?
  check_end
}

for signal in INT TERM HUP; do
  it "SIG$signal stops a run"
  interrupted $signal 0.5 run endless.cag
  status 130
  prints_exactly begun
done

it 'Ctrl-C stops a long list'
script list.cag 'print sum([for i in 0..1e12: i])'
interrupted INT 0.3 run list.cag
status 130

it 'Ctrl-C ends a long step that does not look up, after two seconds'
script matrix.cag 'print "begun"
a = [for i in 0..<4000: random(i, 4000)]
print determinant(multiply(inverse(a), inverse(a)))'
interrupted INT 2 run matrix.cag
status 130

it 'a second signal ends such a step at once'
ran='cag run matrix.cag (SIGTERM twice)'
# Without the alarm, which ends the program after two seconds, the step takes about a minute.
(
  trap '' ALRM
  exec "$CAG" run matrix.cag
) > out 2> err &
child=$!
sleep 3
kill -TERM $child
sleep 0.5
kill -TERM $child 2> /dev/null
patience=200
while kill -0 $child 2> /dev/null && [ $patience -gt 0 ]; do
  sleep 0.1
  patience=$((patience - 1))
done
[ $patience -gt 0 ] || wrong 'the second signal does not end the program'
kill -KILL $child 2> /dev/null
wait $child
code=$?
status 130

it 'Ctrl-C stops eval'
interrupted INT 0.3 eval '{ f(n) = f(n + 1); f(0) }'
status 130

it 'Ctrl-C while a script is read from standard input'
mkfifo pipe
sleep 5 > pipe &
sleeper=$!
ran='cag run - (SIGINT)'
timeout --preserve-status -k 20 -s INT 0.3 "$CAG" run - < pipe > out 2> err
code=$?
kill $sleeper 2> /dev/null
status 130

# A renderer that never ends, identified by its odd argument.
mkdir slow
cat > slow/povray <<'END'
#!/bin/sh
exec sleep 61.2937
END
chmod +x slow/povray
is_running() { grep -l -a '61\.2937' /proc/[0-9]*/cmdline 2> /dev/null | grep -q .; }

it 'Ctrl-C during a render ends the renderer and leaves the earlier picture'
printf earlier > out.png
PATH=$PWD/slow:$PATH
interrupted INT 1 render ball.cag -o out.png --size 64x48
status 130
holds out.png earlier
no_temporaries .
no_temporaries temporary
sleep 0.1
! is_running || wrong 'the renderer still runs'

it 'two signals at once still leave nothing behind'
ran='cag render (SIGTERM twice)'
TMPDIR=$PWD/temporary "$CAG" render ball.cag -o out.png --size 64x48 > out 2> err &
child=$!
sleep 0.7
kill -TERM $child
kill -TERM $child
wait $child
code=$?
status 130
holds out.png earlier
no_temporaries temporary
! is_running || wrong 'the renderer still runs'

it 'a killed cag takes its renderer along'
ran='cag render (SIGKILL)'
TMPDIR=$PWD/temporary "$CAG" render ball.cag -o out.png --size 64x48 > out 2> err &
child=$!
sleep 0.7
kill -KILL $child
wait $child 2> /dev/null
sleep 0.3
! is_running || wrong 'the renderer still runs'
holds out.png earlier
rm -rf temporary/*
PATH=${PATH#*:}

it 'a signal during a film keeps the frames that are whole' povray
script film.cag 'show sphere(10 + frame)'
ran='cag render film.cag (SIGTERM)'
TMPDIR=$PWD/temporary "$CAG" render film.cag -o 'film.%04d.png' --frames 0..999 --size 64x48 --quality draft > out 2> err < /dev/null &
child=$!
patience=200
while [ ! -e film.0000.png ] && [ $patience -gt 0 ]; do
  sleep 0.1
  patience=$((patience - 1))
done
kill -TERM $child
wait $child
code=$?
status 130
exists film.0000.png
no_temporaries .
no_temporaries temporary
for picture in film.*.png; do begins_with "$picture" 89504e470d0a1a0a; done

it 'a second Ctrl-C ends at once'
ran='cag run (SIGTERM twice)'
"$CAG" run endless.cag > out 2> err &
child=$!
sleep 0.3
kill -TERM $child
kill -TERM $child 2> /dev/null
wait $child
code=$?
status 130

# --- All long operations end soon after Ctrl-C ---

# The geometry checks the flag and ends by itself. At the latest, the alarm ends it, two seconds after the signal.
script heavy.cag 'show difference(sphere(100), translate(sphere(100), [30, 0.1, 0.2]))'
script degree.cag 'c = bspline([for i in 0..5000: [i, sin(i * 1deg) * 100, i % 7]], degree: 999)
print length(c)'
script gon.cag 'r = region([for i in 0..<20000: [cos(i * 0.018deg), sin(i * 0.018deg)] * (100 + 10 * (i % 2))])
print area(difference(r, rotate(r, Z, 0.01deg)))'
script meet.cag 'a = bspline([for i in 0..3000: [i, sin(i * 40deg) * 100]])
b = bspline([for i in 0..3000: [i + 0.5, cos(i * 30deg) * 100]])
print len(intersect(a, b))'
stopped() {
  begun=$(date +%s%N)
  interrupted INT 1 "$@"
  took=$((($(date +%s%N) - begun) / 1000000))
  status 130
  [ $took -lt 3500 ] || wrong "it took $took ms"
  no_temporaries .
}

it 'Ctrl-C ends the meshing of an export'
stopped export ball.cag -o ball.stl --tolerance 1e-6
is_missing ball.stl

it 'Ctrl-C ends a set operation at an export'
stopped export heavy.cag -o heavy.stl --tolerance 0.0002

it 'Ctrl-C ends curves of high degree'
stopped run degree.cag

it 'Ctrl-C ends set operations of regions and intersections of curves'
stopped run gon.cag
stopped run meet.cag

it 'Ctrl-C within a limit of time is no crossed limit'
stopped run degree.cag --max-time 60
says_not '--max-time'

# --- Limits of the system ---

it 'a write beyond the limit of a file'"'"'s size is a failed write, and leaves nothing'
mkdir -p limited
try_command sh -c 'ulimit -f 40; exec "$1" export ball.cag -o limited/ball.stl --tolerance 0.01' sh "$CAG"
status 3
says 'ulimit -f'
is_missing limited/ball.stl
no_temporaries limited

it 'a text in JSON with a zero is not a name of a file'
printf '[{"script": "ball.cag", "output": "ball.png\\u0000x"}]' > zero.json
try batch zero.json
status 2
says '\u0000'
