#!/bin/sh
# Runs all suites of a build (BUILD, default build) and sums up the results. SANITIZED names a second build, with which the suites that need
# only a build run again. The last line is `N passed, N failed, N skipped`; the exit status is 0 if nothing failed. A test is skipped, that
# is, neither passed nor failed, if it needs a tool that is missing. A suite that crashes or prints no counts adds one failure.
#
# Suites run in parallel, one per processor, except those that measure how soon an operation ends: these run alone, afterwards.
#
# `run_all.sh --suite FOLDER NUMBER` runs one suite of the list FOLDER/suites, shows its output if it fails, and writes its counts to
# FOLDER/NUMBER.
set -u
cd "$(dirname "$0")/.."
tab=$(printf '\t')

# add NAME PASSED FAILED SKIPPED STATUS: reports the result of a suite and its time, and shows its output if it failed.
add() {
  suite_failed=$3
  [ "$5" -eq 0 ] || [ "$3" -gt 0 ] || suite_failed=1
  [ $(($2 + $4)) -gt 0 ] || [ "$suite_failed" -gt 0 ] || suite_failed=1
  {
    [ "$suite_failed" -eq 0 ] || tail -n 200 "$log"
    [ "$4" -eq 0 ] || [ "$suite_failed" -gt 0 ] || grep -e '^skipped: ' -e ' is skipped: ' -e '^\[  SKIPPED \] [a-z_0-9]*$' "$log" | sort -u
    echo "$1: $2 passed, $suite_failed failed, $4 skipped ($(($(date +%s) - begin)) s)"
  } > "$log.shown"
  cat "$log.shown" # in one piece, because other suites write as well
  echo "$2 $suite_failed $4" > "$counts"
}

# cmocka writes its counts to standard error, with several lines per group: `[  PASSED  ] 3 test(s).`, `[  SKIPPED ] 1 test(s), listed
# below:`. in_all PATTERN: sums up the numbers at \(\).
in_all() { sed -n "s/$1/\1/p" "$log" | awk '{ n += $1 } END { print n + 0 }'; }

# run_suite KIND NAME COMMAND. The kinds: unit, a program of C tests; counted, a command whose last line is `N passed, N failed, N skipped`;
# check, a command that passes or fails as a whole.
run_suite() {
  begin=$(date +%s)
  sh -c "$3" > "$log" 2>&1 < /dev/null
  status=$?
  case $1 in
    unit)
      add "$2" "$(in_all '^\[  PASSED  \] \([0-9]*\) test(s).*')" "$(in_all '^\[  FAILED  \].*[ :]\([0-9]*\) test(s).*')" \
        "$(in_all '^\[  SKIPPED \].*[ :]\([0-9]*\) test(s).*')" $status
      ;;
    counted)
      found=$(tail -n 1 "$log" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed, \([0-9]*\) skipped$/\1 \2 \3/p')
      add "$2" ${found:-0 1 0} $status
      ;;
    check)
      if [ $status -eq 0 ]; then add "$2" 1 0 0 0; else add "$2" 0 1 0 $status; fi
      ;;
  esac
}

if [ "${1:-}" = --suite ]; then
  log=$2/log.$3 counts=$2/$3
  IFS=$tab read -r kind name command << END
$(sed -n "$3p" "$2/suites")
END
  run_suite "$kind" "$name" "$command"
  exit 0
fi

BUILD=${BUILD:-build}
case $BUILD in /*) ;; *) BUILD=$PWD/$BUILD ;; esac
export BUILD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

suite() { printf '%s\t%s\t%s\n' "$1" "$2" "$3" >> "$work/suites"; }

# These take half of the time of all with sanitizers, because they try thousands of random shapes or search long. `make test-sanitize` runs
# them.
: "${SANITIZED_LEFT_OUT=tests/geom/boolean tests/geom/boolean_flat tests/geom/boolean_turned tests/geom/caster_nearest tests/geom/csg
tests/geom/general tests/geom/half_spaces tests/geom/level_sets tests/geom/meet_rings tests/geom/meet_touch tests/geom/minkowski
tests/geom/nearest tests/geom/quadric_body tests/geom/quadric_outline tests/geom/ray_mesh tests/geom/region_clipper
tests/geom/region_offset tests/geom/region_sets tests/geom/region_stroke tests/geom/region_unite tests/geom/section_small tests/geom/side
tests/geom/tessellate tests/geom/tessellate_dense tests/geom/tessellate_motion tests/geom/tessellate_solids tests/geom/villarceau
tests/interp/operators tests/interp/pov tests/interp/section tests/interp/tool_batch
tests/language/geometry/csg tests/language/geometry/csg_sides tests/language/geometry/meet_branches tests/language/geometry/meet_shallow
tests/language/geometry/meet_small tests/language/geometry/meet_surfaces tests/language/geometry/quadrics}"

# is_left_out NAME LEFT_OUT: whether a list has the name.
is_left_out() {
  case " $(echo $2) " in *" $1 "*) return 0 ;; esac
  return 1
}

# unit_suites BUILD NAME [LEFT_OUT]: all programs of C tests of a build, except those of a list. NAME is a prefix of the names of its suites.
unit_suites() {
  for source in tests/base/*_test.c tests/lang/*_test.c tests/geom/*_test.c tests/interp/*_test.c; do
    is_left_out "${source%_test.c}" "${3:-}" && continue
    case $source in
      *'*'* | tests/interp/interrupt_test.c | tests/interp/heavy_test.c) ;; # the latter two run alone
      *) suite unit "$2${source%.c}" "'$1/${source%.c}'" ;;
    esac
  done
}

# vector_suites BUILD NAME: the worked examples.
vector_suites() {
  for vectors in tests/data/0*.json; do
    suite counted "$2$vectors" "BUILD='$1' tests/vectors/run '$vectors'"
  done
}

# language_suites BUILD NAME OPTIONS [LEFT_OUT]: the scripts of the language, folder by folder, except those of a list.
language_suites() {
  for folder in tests/language/*/; do
    folder=${folder%/}
    case $folder in
      */geometry) for part in '[a-l]' '[m-r]' '[s-z]'; do language_suite "$@" "$folder/$part" "$folder"/$part*.cag; done ;;
      *) suite counted "$2$folder" "'$1/cag' test $3 $folder" ;;
    esac
  done
}

# language_suite BUILD NAME OPTIONS LEFT_OUT WHAT SCRIPT...
language_suite() {
  name=$2$5 command="'$1/cag' test $3" left_out=$4
  shift 5
  for script; do is_left_out "${script%.cag}" "$left_out" || command="$command $script"; done
  suite counted "$name" "$command"
}

# The slowest ones start first.
points=${MEMORY_POINTS:-3}
alone='limits output signals'
suite counted "tests/web" "sh tests/web/run.sh"
if [ -n "${SANITIZED:-}" ]; then
  case $SANITIZED in /*) ;; *) SANITIZED=$PWD/$SANITIZED ;; esac
  language_suites "$SANITIZED" "sanitized " "--no-pictures --max-time 600" "$SANITIZED_LEFT_OUT"
  suite counted "sanitized tests/fuzz" "'$SANITIZED/tests/fuzz/fuzz' 2"
  suite counted "sanitized tests/fuzz/pictures" "python3 tests/fuzz/pictures.py '$SANITIZED/cag' 1000 3"
  suite counted "sanitized tests/fuzz/fonts" "python3 tests/fuzz/fonts.py '$SANITIZED/cag' 250 3"
  suite counted "sanitized tests/fuzz/memory limits" "'$SANITIZED/tests/fuzz/memory' -l -n 3"
  unit_suites "$SANITIZED" "sanitized " "$SANITIZED_LEFT_OUT"
  vector_suites "$SANITIZED" "sanitized "
fi
suite counted "tests/live view" "python3 tests/live/view.py '$BUILD/cag'"
suite counted "tests/live" "sh tests/live/run.sh"
language_suites "$BUILD" "" "" ""
suite counted "tests/scenes" "'$BUILD/cag' test tests/scenes"
suite counted "cag test examples" "'$BUILD/cag' test --no-pictures examples stdlib"
suite counted "tests/fuzz" "'$BUILD/tests/fuzz/fuzz' 8"
suite counted "tests/fuzz/pictures" "python3 tests/fuzz/pictures.py '$BUILD/cag' 2000"
suite counted "tests/fuzz/fonts" "python3 tests/fuzz/fonts.py '$BUILD/cag' 1000"
suite counted "tests/fuzz/memory" "'$BUILD/tests/fuzz/memory' -n $points"
suite counted "tests/fuzz/memory scripts" "'$BUILD/tests/fuzz/memory' -n $points -x tests/fuzz/scripts/*.cag"
suite counted "tests/fuzz/memory language" \
  "'$BUILD/tests/fuzz/memory' -n $points tests/language/modules/*.cag tests/language/values/*.cag tests/language/words/*.cag"
for cases in tests/cli/cases_*.sh; do
  name=${cases#tests/cli/cases_}
  name=${name%.sh}
  case " $alone " in
    *" $name "*) ;;
    *) suite counted "tests/cli $name" "sh tests/cli/run.sh $name" ;;
  esac
done
suite counted "tests/repl" "sh tests/repl/run.sh"
suite counted "tests/brep" "python3 tests/brep/protocol.py '$BUILD/cag-brep' '$BUILD/cag'"
suite counted "tests/editors" "sh tests/editors/run.sh"
unit_suites "$BUILD" ""
vector_suites "$BUILD" ""
suite check "layers" "make -s check-layers"
# With half of its effort, GCC's analyzer takes half of the time.
for part in "base lang geom/basis geom/linalg geom/curve" geom/surface "geom/mesh geom/meet geom/robot geom/distance geom/letter" \
  "geom/tessellate geom/boolean geom/solid" "interp/scene interp/render interp/formats" interp/vm "interp/doc interp/check" \
  interp/builtin "interp/session interp/document live cli"; do
  suite check "analyzer $part" "make -s analyze ANALYZED='$part' ANALYZE_EFFORT=2"
done
# The analyzer of clang-tidy takes ten times as long as all else, and finds what that of GCC finds; `make tidy` runs it as well.
if command -v clang-tidy > /dev/null; then
  suite check "tidy" "make -s tidy TIDY_CHECKS='-clang-analyzer-*'"
else
  suite counted "tidy" "echo 'skipped: clang-tidy is missing'; echo '0 passed, 0 failed, 1 skipped'"
fi
if command -v clang-format > /dev/null; then
  suite check "format" "make -s check-format"
else
  suite counted "format" "echo 'skipped: clang-format is missing'; echo '0 passed, 0 failed, 1 skipped'"
fi
together=$(wc -l < "$work/suites")
for name in $alone; do suite counted "tests/cli $name" "sh tests/cli/run.sh $name"; done
for build in "$BUILD" ${SANITIZED:+"$SANITIZED"}; do
  for name in interrupt heavy; do
    suite unit "${build##*/} tests/interp/${name}_test" "'$build/tests/interp/${name}_test'"
  done
done
suite check "threads" "make -s test-threads"
all=$(wc -l < "$work/suites")

seq "$together" | xargs -P "$(nproc)" -n 1 sh tests/run_all.sh --suite "$work"
seq $((together + 1)) "$all" | xargs -n 1 sh tests/run_all.sh --suite "$work"
passed=0 failed=0 skipped=0
for number in $(seq "$all"); do
  # A suite whose runner was killed has no counts.
  read -r p f s < "$work/$number" 2> /dev/null || { p=0 f=1 s=0; }
  passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
