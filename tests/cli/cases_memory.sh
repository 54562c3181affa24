# Tests the program with exhausted memory and failing system calls: each location in its code that allocates or calls the
# system fails once (fail_memory.c).

script vase.cag '/// how tall
param height = 200
show revolve(bspline([[30, 0], [50, 60], [20, 150], [30, height]]), Z)'
script shapes.cag 'show box(10) |> material({color: "red", name: "clay"}), moved(cylinder(2, 5), translate([20, 0, 0]))
show circle(4) |> line_style(radius: 0.5, dash: 3), bilinear([0, 0, 9], [0, 9, 9], [9, 0, 9], [9, 9, 12]), rectangle(3, 4)'
script picture.cag 'param x = 30
show box(10), camera([x, -20, 15], size: [16, 12])'
script arm.cag 'show robot([revolute(a: 100, limits: -90deg..90deg, shape: box([100, 10, 10])), revolute(a: 50)])'
script wrong.cag 'print sin(30)'
script long.cag '// A list that
// is laid out.
points=[[30,0],[50,60],[20,150],[30,200],[30,0],[50,60],[20,150],[30,200],[30,0],[50,60],[20,150],[30,200]]
print points'
script tested.cag 'print 1 + 1  // expect: 2
// run: -D height=3 --max-time 5
param height = 2
print height  // expect: 3
print sin(30)  // expect error: E0301'
script jobs.csv 'script,output,tolerance,height
vase.cag,a.stl,0.5,100
vase.cag,b.obj,0.5,"200"'
script jobs.json '[{"script": "vase.cag", "output": "c.stl", "height": 90}]'
script input.txt 'import std.robots: puma560
x = 3
f(a) = a * x
:list
:type x
:time f(2)
:doc sphere
:doc sphree
:help :load
:load vase.cag
:save saved.cag
:edit
:reload
:scene
:hide box(1)
:export ball.stl
x'

# fails_at WHAT NAME ARGUMENT ...: runs cag with the arguments once for each location that requests WHAT (memory, system), which fails
# there. The first `beyond` locations are skipped. The program must end by itself, with its usual output or an error message, and any file
# that it leaves must be complete.
fails_at() {
  it "$1 fails: $2"
  what=$1
  shift 2
  ran="cag $*"
  clear_outputs
  CAG_FAIL_WHAT=$what LD_PRELOAD=./fail_memory.so CAG_FAIL_COUNT=count "$CAG" "$@" < "$from" > expected 2> err
  as_usual=$?
  rm -rf whole
  mkdir whole
  [ -z "$made" ] || cp "$made" whole/
  place=$((beyond + 1))
  last=$(cat count)
  while [ "$place" -le "$last" ]; do
    clear_outputs
    timeout $LONGEST env CAG_FAIL_WHAT=$what LD_PRELOAD=./fail_memory.so CAG_FAIL_PLACE=$place "$CAG" "$@" < "$from" > out 2> err
    code=$?
    check_end
    if [ $code -eq "$as_usual" ]; then
      [ "$code" -ne 0 ] || [ -s err ] || [ -n "$varies" ] || cmp -s out expected || wrong "place $place: the output differs"
      [ "$code" -ne 0 ] || [ -z "$made" ] || [ -e "$made" ] || wrong "place $place: $made is missing"
    else
      [ -s err ] || grep -q 'Cannot allocate\|Input/output' out || wrong "place $place: status $code without an error"
    fi
    [ -z "$made" ] || [ ! -e "$made" ] || [ -n "$varies" ] || cmp -s "$made" "whole/$made" || wrong "place $place: $made is incomplete"
    [ "$test_state" = good ] || {
      ran="CAG_FAIL_WHAT=$what CAG_FAIL_PLACE=$place $ran"
      break
    }
    place=$((place + 1))
  done
}
clear_outputs() { rm -rf a.stl b.obj c.stl ball.stl saved.cag jobs.*.journal jobs.*.report.csv done.csv report.xml made.*; }
exhausts() {
  fails_at memory "$@"
  fails_at system "$@"
}

it 'the library that makes calls fail is built'
if ldd "$CAG" | grep -q 'libasan'; then
  skip 'AddressSanitizer has an allocator of its own'
elif needs cc; then
  try_command cc -std=c17 -D_GNU_SOURCE -O1 -fPIC -shared -Wall -Wextra -Werror "$root/tests/cli/fail_memory.c" -ldl -o fail_memory.so
  status 0
fi
if [ -e fail_memory.so ]; then
  from=/dev/null varies= made= beyond=0
  exhausts 'a value' eval '1 + 1'
  exhausts 'an error' run wrong.cag
  exhausts 'a script that is checked' check vase.cag --diagnostics json
  exhausts 'the layout' fmt --diff long.cag
  exhausts 'documentation' doc sphere
  exhausts 'documentation of a script' doc vase.cag
  exhausts 'an unknown option' run --defnie vase.cag
  exhausts 'an invalid range of frames' render vase.cag -o a%d.png --frames 5..3
  exhausts 'tests' test --jobs 1 tested.cag long.cag --report report.xml
  # The locations before an export are the same as in any run.
  for what in memory system; do
    CAG_FAIL_WHAT=$what LD_PRELOAD=./fail_memory.so CAG_FAIL_COUNT=before_$what "$CAG" run shapes.cag > out 2>&1
  done
  for made in made.stl made.obj made.ply made.glb made.gltf made.3mf made.pov made.igs made.step made.svg made.json; do
    for what in memory system; do
      beyond=$(cat before_$what)
      fails_at $what "$made" export shapes.cag -o $made
    done
  done
  if have povray; then
    made=made.png beyond=0
    for what in memory system; do
      fails_at $what 'a picture' render picture.cag -o $made --quality draft
    done
    for kind in exr png; do
      for camera in 30 31; do "$CAG" render picture.cag -D x=$camera -o $camera.$kind --quality draft > out 2>&1; done
      made=made.$kind
      exhausts "a comparison of .$kind files" compare 30.$kind 31.$kind --threshold 100 --heatmap $made
    done
  fi
  made=made.urdf beyond=0
  exhausts "$made" export arm.cag -o $made
  made= varies=yes # times
  exhausts 'a batch' batch jobs.csv --jobs 2
  exhausts 'jobs in JSON' batch jobs.json --report done.csv
  from=input.txt
  VISUAL=true exhausts 'the REPL' repl -D height=3
fi
