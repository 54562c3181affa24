# The program when memory is out: an allocation of each place in it fails once.

script vase.cag '/// how tall
param height = 200
show revolve(bspline([[30, 0], [50, 60], [20, 150], [30, height]]), Z)'
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

# exhausts WHAT ARGUMENT ...: runs cag with the arguments once for each place that allocates. It ends by itself, with what it
# writes when nothing fails or with an error that it tells.
exhausts() {
  it "memory is out: $1"
  shift
  ran="cag $*"
  LD_PRELOAD=./fail_memory.so CAG_FAIL_COUNT=count "$CAG" "$@" < "$from" > expected 2> err
  as_usual=$?
  place=1
  last=$(cat count)
  while [ "$place" -le "$last" ]; do
    rm -rf a.stl b.obj c.stl ball.stl saved.cag jobs.*.journal jobs.*.report.csv done.csv report.xml
    timeout $LONGEST env LD_PRELOAD=./fail_memory.so CAG_FAIL_PLACE=$place "$CAG" "$@" < "$from" > out 2> err
    code=$?
    if [ $code -eq 134 ]; then # what cannot go on without memory, and has no way to tell, aborts
      place=$((place + 1))
      continue
    fi
    check_end
    if [ $code -eq "$as_usual" ]; then
      [ "$code" -ne 0 ] || [ -s err ] || [ -n "$varies" ] || cmp -s out expected || wrong "place $place: it writes something else"
    else
      [ -s err ] || wrong "place $place: status $code without an error"
    fi
    [ "$test_state" = good ] || {
      ran="CAG_FAIL_PLACE=$place $ran"
      break
    }
    place=$((place + 1))
  done
}

it 'the library that lets memory be out is built'
if ldd "$CAG" | grep -q 'libasan'; then
  skip 'AddressSanitizer has an allocator of its own'
elif needs cc; then
  try_command cc -std=c17 -D_GNU_SOURCE -O1 -fPIC -shared -Wall -Wextra -Werror "$root/tests/cli/fail_memory.c" -ldl -o fail_memory.so
  status 0
fi
if [ -e fail_memory.so ]; then
  from=/dev/null varies=
  exhausts 'a value' eval '1 + 1'
  exhausts 'an error' run wrong.cag
  exhausts 'a script that is checked' check vase.cag --diagnostics json
  exhausts 'the layout' fmt --diff long.cag
  exhausts 'documentation' doc sphere
  exhausts 'documentation of a script' doc vase.cag
  exhausts 'help' batch --help
  exhausts 'an unknown option' run --defnie vase.cag
  exhausts 'an error that is explained' explain E0301
  exhausts 'a film that cannot be' render vase.cag -o a%d.png --frames 5..3
  exhausts 'tests' test tested.cag long.cag --junit report.xml
  varies=yes # times
  exhausts 'a batch' batch jobs.csv --jobs 2
  exhausts 'jobs in JSON' batch jobs.json --report done.csv
  from=input.txt
  VISUAL=true exhausts 'the REPL' repl -D height=3
fi
