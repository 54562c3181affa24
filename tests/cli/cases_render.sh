# Pictures through POV-Ray, small and quick; and a POV-Ray that is missing or misbehaves.

script ball.cag 'print "frame {frame} of {frames}, time {time}"
show sphere(10) |> material({color: "#d04030"})
show camera(eye: [60, 0, 20], target: origin, fov: 30deg)
show camera(eye: [0, 0, 80], target: origin, up: Y, fov: 30deg) |> named("top")
show sun(direction: [-1, 1, -2])'
quick='--size 64x48 --quality draft'
mkdir temporary
TMPDIR=$PWD/temporary
export TMPDIR

it 'render writes a PNG'
try render ball.cag -o ball.png $quick
status 0
prints_exactly 'frame 0 of 1, time 0'
says_nothing
begins_with ball.png 89504e470d0a1a0a
no_temporaries temporary

it 'render writes an EXR, the same one twice'
try render ball.cag -o ball.exr $quick
status 0
begins_with ball.exr 762f3101
try render ball.cag -o again.exr $quick
try compare ball.exr again.exr
status 0

it 'the picture shows something'
script nothing.cag 'show sphere(0.001) |> translate([0, 0, 9000])
show camera(eye: [60, 0, 20], target: origin, fov: 30deg)'
try render nothing.cag -o nothing.exr $quick
try compare ball.exr nothing.exr --threshold 0.05
status 1

it 'the EXR tells what it is of'
grep -q -a 'cag.script' ball.exr || wrong 'no script in the header'
grep -q -a 'worldToCamera' ball.exr || wrong 'no camera in the header'

it '--size sets the size'
# Width and height stand big-endian behind the 16 first bytes of a PNG.
[ "$(od -An -v -tx1 -j16 -N8 ball.png | tr -d ' \n')" = 0000004000000030 ] || wrong 'it is not 64 by 48'

it 'a camera is chosen by name'
try render ball.cag -o top.exr $quick --camera top
status 0
try compare ball.exr top.exr --threshold 0.02
status 1

it 'a misspelt camera gets the nearest'
printf earlier > kept.png
try render ball.cag -o kept.png $quick --camera tpo
status 2
says 'top'
holds kept.png earlier

it '--exposure brightens a PNG'
try render ball.cag -o bright.png $quick --exposure 2
status 0
try compare ball.png bright.png
status 1

it 'a picture may go to standard output'
try render ball.cag -o - --format png $quick
status 0
begins_with out 89504e470d0a1a0a
says 'frame 0 of 1'
no_temporaries temporary
try render ball.cag -o - $quick
status 2
says '--format'

it '--frames renders a film'
try render ball.cag -o 'film.%03d.png' --frames 1..2 $quick
status 0
prints_exactly 'frame 1 of 3, time 0.5
frame 2 of 3, time 1'
is_missing film.000.png
begins_with film.001.png 89504e470d0a1a0a
begins_with film.002.png 89504e470d0a1a0a

it '-D frames makes the film longer'
try render ball.cag -o 'part.%d.png' --frames 1..1 -D frames=5 $quick
status 0
prints_exactly 'frame 1 of 5, time 0.25'
exists part.1.png

it 'a film from standard input'
with_input ball.cag render - -o 'piped.%d.png' --frames 0..1 $quick
status 0
exists piped.0.png
exists piped.1.png

it 'a percent sign in a film is written twice'
try render ball.cag -o '100%%.%d.png' --frames 3..3 $quick
status 0
exists '100%.3.png'

for pattern in 'f.png' 'f.%s.png' 'f.%n.png' 'f.%d.%d.png' 'f.%04x.png' 'f.%*d.png' 'f.%99999999d.png' 'f.%04d.%s.png' 'f.%ld.png'; do
  it "the pattern $pattern is refused"
  try render ball.cag -o "$pattern" --frames 0..2 $quick
  status 2
  prints_nothing
  says '%04d'
done

it 'a pattern without --frames is refused'
try render ball.cag -o 'f.%04d.png' $quick
status 2
says '--frames'

it 'frames beyond the film are refused'
try render ball.cag -o 'f.%04d.png' --frames 0..5 -D frames=3 $quick
status 2
says '0..5'
try render ball.cag -o 'f.%04d.png' --frames 0..5 -D time=0.5 $quick
status 2

it 'a script that fails in a frame ends the film'
script breaks.cag 'assert frame < 1, "the second frame"
show sphere(10)'
try render breaks.cag -o 'breaks.%d.png' --frames 0..3 $quick
status 1
says 'the second frame'
exists breaks.0.png
is_missing breaks.1.png
is_missing breaks.2.png

it 'there is no progress on a pipe'
try render ball.cag -o quiet.png $quick
says_nothing

# Another program in the place of POV-Ray; the earlier picture must stay.
fake() {
  mkdir -p fake
  printf '#!/bin/sh\n%s\n' "$1" > fake/povray
  chmod +x fake/povray
}
printf earlier > kept.exr
# stand_in STATUS TEXT: what comes of a render with it.
stand_in() {
  ran="cag render with the povray of this test"
  PATH=$PWD/fake:$PATH timeout 60 "$CAG" render ball.cag -o kept.exr $quick > out 2> err
  code=$?
  check_end
  status "$1"
  says "$2"
  holds kept.exr earlier
  no_temporaries .
  no_temporaries temporary
}

it 'POV-Ray is missing'
mkdir empty
ran='cag render without POV-Ray' && PATH=$PWD/empty "$CAG" render ball.cag -o kept.exr $quick > out 2> err
code=$?
status 4
says 'POV-Ray is not installed'
says 'apt-get install povray'
holds kept.exr earlier

it 'POV-Ray fails, and its last lines are shown'
fake 'echo "Fatal error in parser: the moon is missing" >&2; exit 1'
stand_in 4 'the moon is missing'

it 'POV-Ray is killed'
fake 'kill -KILL $$'
stand_in 4 'POV-Ray'

it 'POV-Ray crashes'
fake 'kill -SEGV $$'
stand_in 4 'POV-Ray'

it 'POV-Ray writes no picture'
fake 'exit 0'
stand_in 4 'no picture'

it 'POV-Ray writes no EXR'
fake 'echo nonsense > out.exr'
PATH=$PWD/fake:$PATH "$CAG" render ball.cag -o kept.exr $quick > out 2> err
code=$?
[ "$code" -eq 3 ] || [ "$code" -eq 4 ] || wrong 'expected status 3 or 4'
holds kept.exr earlier
no_temporaries .
no_temporaries temporary

it 'POV-Ray cannot be started'
mkdir -p fake
printf 'no program' > fake/povray
chmod +x fake/povray
stand_in 4 'POV-Ray'

it 'POV-Ray takes longer than --max-time'
fake 'sleep 60'
ran='cag render with a povray that sleeps'
PATH=$PWD/fake:$PATH timeout 60 "$CAG" render ball.cag -o kept.exr $quick --max-time 0.7 > out 2> err
code=$?
status 5
holds kept.exr earlier
no_temporaries temporary

it 'a disk for temporary files that is not there'
ran='cag render with a wrong TMPDIR' && TMPDIR=/nowhere "$CAG" render ball.cag -o kept.exr $quick > out 2> err
code=$?
status 3
says 'TMPDIR'
holds kept.exr earlier
unset TMPDIR
