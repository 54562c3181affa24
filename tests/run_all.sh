#!/bin/sh
# Runs all suites of a build (BUILD, default build) and sums up the results. SANITIZED names a second build, with which the suites that need
# only a build run again. The last line is `N passed, N failed, N skipped`; the exit status is 0 if nothing failed. A test is skipped, that
# is, neither passed nor failed, if it needs a tool that is missing. A suite that crashes or prints no counts adds one failure.
set -u
cd "$(dirname "$0")/.."
BUILD=${BUILD:-build}
passed=0 failed=0 skipped=0
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# add NAME PASSED FAILED SKIPPED STATUS: adds a suite, and shows its output when something is wrong with it.
add() {
  suite_failed=$3
  [ "$5" -eq 0 ] || [ "$3" -gt 0 ] || suite_failed=1
  [ $(($2 + $4)) -gt 0 ] || [ "$suite_failed" -gt 0 ] || suite_failed=1
  [ "$suite_failed" -eq 0 ] || tail -n 200 "$log"
  [ "$4" -eq 0 ] || [ "$suite_failed" -gt 0 ] || grep -e '^skipped: ' -e ' is skipped: ' -e '^\[  SKIPPED \] [a-z_0-9]*$' "$log" | sort -u
  echo "$1: $2 passed, $suite_failed failed, $4 skipped"
  passed=$((passed + $2)) failed=$((failed + suite_failed)) skipped=$((skipped + $4))
}

# unit PROGRAM NAME: runs a program of C tests. cmocka writes its counts to standard error, with several lines per group: `[  PASSED  ] 3
# test(s).`, `[  SKIPPED ] 1 test(s), listed below:`. in_all PATTERN: sums up the numbers at \(\).
in_all() { sed -n "s/$1/\1/p" "$log" | awk '{ n += $1 } END { print n + 0 }'; }
unit() {
  "$1" > "$log" 2>&1
  status=$?
  add "$2" "$(in_all '^\[  PASSED  \] \([0-9]*\) test(s).*')" "$(in_all '^\[  FAILED  \].*[ :]\([0-9]*\) test(s).*')" \
    "$(in_all '^\[  SKIPPED \].*[ :]\([0-9]*\) test(s).*')" $status
}

# A command whose last line is `N passed, N failed, N skipped`.
counted() {
  name=$1
  shift
  "$@" > "$log" 2>&1
  status=$?
  counts=$(tail -n 1 "$log" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed, \([0-9]*\) skipped$/\1 \2 \3/p')
  add "$name" ${counts:-0 1 0} $status
}

# A check that passes or fails as a whole.
check() {
  name=$1
  shift
  "$@" > "$log" 2>&1
  status=$?
  if [ $status -eq 0 ]; then add "$name" 1 0 0 0; else add "$name" 0 1 0 $status; fi
}

# unit_suites BUILD NAME: runs all programs of C tests of a build. NAME is a prefix of the names of its suites.
unit_suites() {
  for source in tests/base/*_test.c tests/lang/*_test.c tests/geom/*_test.c tests/interp/*_test.c; do
    [ ! -e "$source" ] || unit "$1/${source%.c}" "$2${source%.c}"
  done
}

# vector_suites BUILD NAME: runs the worked examples.
vector_suites() {
  for vectors in tests/data/0*.json; do
    counted "$2$vectors" env BUILD="$1" tests/vectors/run "$vectors"
  done
}

case $BUILD in /*) ;; *) BUILD=$PWD/$BUILD ;; esac
unit_suites "$BUILD" ""
counted "cag test" "$BUILD/cag" test tests/language tests/scenes
counted "cag test examples" "$BUILD/cag" test --no-pictures examples stdlib
counted "tests/cli" env BUILD="$BUILD" sh tests/cli/run.sh
counted "tests/repl" env BUILD="$BUILD" sh tests/repl/run.sh
counted "tests/editors" env BUILD="$BUILD" sh tests/editors/run.sh
vector_suites "$BUILD" ""
counted "tests/fuzz" "$BUILD/tests/fuzz/fuzz" 8
counted "tests/fuzz/memory" "$BUILD/tests/fuzz/memory" -n "${MEMORY_POINTS:-3}"
counted "tests/fuzz/memory scripts" "$BUILD/tests/fuzz/memory" -n "${MEMORY_POINTS:-3}" -x tests/fuzz/scripts/*.cag
counted "tests/fuzz/memory language" "$BUILD/tests/fuzz/memory" -n "${MEMORY_POINTS:-3}" \
  tests/language/modules/*.cag tests/language/values/*.cag tests/language/words/*.cag
if [ -n "${SANITIZED:-}" ]; then
  case $SANITIZED in /*) ;; *) SANITIZED=$PWD/$SANITIZED ;; esac
  unit_suites "$SANITIZED" "sanitized "
  # Three scripts take 12 s each without sanitizers, and four times that with them.
  counted "sanitized cag test" "$SANITIZED/cag" test --no-pictures --max-time 600 tests/language
  vector_suites "$SANITIZED" "sanitized "
  counted "sanitized tests/fuzz" "$SANITIZED/tests/fuzz/fuzz" 2
fi
check "layers" make -s check-layers
if command -v clang-format > /dev/null; then
  check "format" make -s check-format
else
  echo "skipped: clang-format is missing" > "$log"
  add "format" 0 0 1 0
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
