#!/bin/sh
# Measures how many random changes to the code the tests notice (a mutation score). Not part of the tests: 100 changes take hours.
#
#     N=100 SEED=1 sh tools/mutate.sh
#
# SKIP=20 skips the first 20 changes of the seed, to continue an earlier run. FOLDERS="geom/curve" changes only files in these folders.
# LONGEST=60 leaves out suites that take more than 60 s: the score is then a lower bound.
#
# Works on a copy of the tree in build-mutate/. First, every suite runs once in a build that counts which lines it reaches; the counts are
# kept in build-mutate/reach/. Each change then replaces one operator or constant on one line of geom, interp or lang, by the table
# tools/mutations.txt. A change that does not compile (warnings are errors), or does not change the object file, is replaced with another
# one. The suites that reach the line run until one fails, starting with those that are quick and likely to detect the change: unit tests
# that include the changed file's header, then all others by their time. Each suite has a memory limit and a time limit, which is 10 s plus
# 4 times the time for the unchanged code. If none fails, the suites that run under sanitizers in every test run (see tests/run_all.sh) run
# again, with the changed file and the tests compiled for AddressSanitizer and UndefinedBehaviorSanitizer. Undetected changes are printed
# and stored in build-mutate/survivors.txt. Changes after which the program computes the same, listed with their reasons in
# tools/equivalent_mutations.txt, are replaced with others as well.
set -eu
cd "$(dirname "$0")/.."
N=${N:-100} SEED=${SEED:-1} SKIP=${SKIP:-0} FOLDERS=${FOLDERS:-geom interp lang} LONGEST=${LONGEST:-1800}
[ -n "$N" ] || N=100
[ -n "$SEED" ] || SEED=1
TREE=$PWD/build-mutate/tree
MEMORY=4000000 # KiB

# Runs a suite by name, with the programs of the folder B. The name of a unit test is that of its source.
run_suite() {
  case $1 in
  tests/*_test) "$B/$1" ;;
  scripts/*) "$B/cag" test --no-pictures "tests/language/${1#scripts/}" ;;
  stdlib | examples) "$B/cag" test --no-pictures "$1" ;;
  vectors) for file in tests/data/0*.json; do BUILD=$B tests/vectors/run "$file" || return 1; done ;;
  fuzz) "$B/tests/fuzz/fuzz" 1 ;;
  memory) "$B/tests/fuzz/memory" -n 1 && "$B/tests/fuzz/memory" -n 1 -x tests/fuzz/scripts/*.cag ;;
  editors) BUILD=$PWD/$B sh tests/editors/run.sh ;;
  repl) BUILD=$PWD/$B sh tests/repl/run.sh ;;
  scenes) "$B/cag" test tests/scenes ;;
  cli/*) BUILD=$PWD/$B sh tests/cli/run.sh "${1#cli/}" ;;
  esac
}
# `sh tools/mutate.sh --suite NAME`, in the copy, runs one suite, because timeout needs a program.
if [ "${1:-}" = --suite ]; then
  run_suite "$2"
  exit
fi

tab=$(printf '\t')
all_suites() {
  ls tests/*/*_test.c | sed 's|\.c$||'
  ls tests/language | sed 's|^|scripts/|'
  printf '%s\n' stdlib examples vectors fuzz memory repl editors scenes
  ls tests/cli/cases_*.sh | sed 's|.*/cases_\(.*\)\.sh|cli/\1|'
}

if [ "${1:-}" = --measure ]; then
  TREE=$PWD
else
  mkdir -p "$TREE"
  find "$TREE" -mindepth 1 -maxdepth 1 ! -name 'build*' -exec rm -rf {} +
  # Without the times of the files, so that everything is built anew: objects of an earlier run may have a change in them.
  git ls-files -z | xargs -0 cp --parents -t "$TREE"
  cd "$TREE"
fi
REACH=$TREE/../reach
export OPT=-O1 SANITIZE=
export ASAN_OPTIONS=hard_rss_limit_mb=$((MEMORY / 1024)):detect_leaks=0
build() { make -s -j"$(nproc)" CC="${CC:-cc}" "$@" > ../build.log 2>&1; }

# Runs a suite within limits: limited SECONDS SUITE. Sanitizers, Chromium and Node reserve more memory than that, and two suites test larger
# limits.
limited() {
  (
    case $SANITIZE$2 in
    -* | cli/doc | cli/limits | cli/signals | editors) ;;
    *) ulimit -v "$MEMORY" ;;
    esac
    exec timeout -k 5 "$1" sh "$TREE/tools/mutate.sh" --suite "$2"
  ) > /dev/null 2>&1
}

# Counts the lines that a suite reaches, in $REACH/SUITE/, and writes its time in seconds to $REACH/SUITE.time. A suite that fails in the
# slow build that counts (since it tests limits of time, for instance) is timed in the normal build. 0 means that the suite fails there as
# well, so it cannot detect anything.
measure_suite() {
  [ ! -s "$REACH/$1.time" ] || return 0
  mkdir -p "$REACH/$1"
  began=$(date +%s)
  time=0
  GCOV_PREFIX=$REACH/$1 GCOV_PREFIX_STRIP=$(echo "$TREE/build-reach/obj" | tr -cd / | wc -c) B=build-reach limited 1800 "$1" &&
    time=$(($(date +%s) - began + 1))
  if [ "$time" -eq 0 ]; then
    began=$(date +%s)
    ! B=build limited 1800 "$1" || time=$(($(date +%s) - began + 1))
  fi
  echo "$time" > "$REACH/$1.time"
}

# `sh tools/mutate.sh --measure NAME`, in the copy, measures one suite, so that several are measured at the same time.
if [ "${1:-}" = --measure ]; then
  measure_suite "$2"
  exit
fi

# The coverage build, unless every suite has been measured. gcov finds the notes of the compiler beside the counts. Counts do not go with
# the notes of another build, so all suites are measured again if the code has changed.
measure_suites() {
  for suite in $(all_suites); do
    [ -s "$REACH/$suite.time" ] || break
    suite=
  done
  [ -n "$suite" ] || return 0
  mkdir -p build-reach
  cc -std=c17 -fPIC -c tests/coverage/exit.c -o build-reach/exit.o
  build BUILD=build-reach OPT=-O0 SANITIZE="--coverage -DCAG_ONE_COPY" LDFLAGS="-Wl,--wrap=_exit build-reach/exit.o" test-programs || {
    tail ../build.log
    exit 1
  }
  rm -rf ../notes
  mkdir -p ../notes
  (cd build-reach/obj && find geom interp lang -name '*.gcno' | xargs cp --parents -t ../../../notes)
  diff -rq ../notes "$REACH/notes" > /dev/null 2>&1 || rm -rf "$REACH"
  mkdir -p "$REACH"
  rm -rf "$REACH/notes"
  mv ../notes "$REACH/notes"
  all_suites | xargs -n 1 -P "$(nproc)" sh tools/mutate.sh --measure
}

# reaches SUITE FILE LINE: whether the suite runs the line. A line without code of its own, in a table or in a statement of several lines,
# counts as reached.
reaches() {
  counts=$REACH/$1/${2%.c}.gcda
  [ -e "$counts" ] || return 1
  cp "$REACH/notes/${2%.c}.gcno" ../line.gcno
  cp "$counts" ../line.gcda
  ! gcov --stdout ../line.gcda 2> /dev/null |
    awk -F : -v file="$2" -v line="$3" '
      $3 == "Source" { here = $4 == file }
      here && $2 + 0 == line && $1 ~ /#####/ { found = 1 }
      END { exit !found }'
}

# The suites in the order in which they run for a change to the file.
suites_for() {
  {
    grep -l "\"${1%.c}\.h\"" tests/*/*_test.c | sed 's|\.c$||' || true
    all_suites | while read -r suite; do echo "$(cat "$REACH/$suite.time") $suite"; done | sort -n | cut -d ' ' -f 2
  } | awk '!seen[$0]++'
}

link_suite() {
  case $1 in
  tests/*_test) build "build/$1" ;;
  vectors) build build/tests/vectors/run ;;
  fuzz) build build/tests/fuzz/fuzz ;;
  memory) build build/tests/fuzz/memory ;;
  *) build all ;;
  esac
}

# Prints the suite that fails, and succeeds if there is one: the change to the line is detected.
who_notices() {
  for suite in $(suites_for "$1"); do
    case $SANITIZE$suite in
    -*cli/* | -*examples | -*stdlib | -*memory | -*repl | -*editors | -*scenes) continue ;;
    esac
    seconds=$(cat "$REACH/$suite.time")
    if [ "$seconds" -eq 0 ] || [ "$seconds" -gt "$LONGEST" ] || ! reaches "$suite" "$1" "$2"; then continue; fi
    if ! link_suite "$suite" || ! B=build limited $((4 * seconds + 10)) "$suite"; then
      echo "$suite"
      return 0
    fi
  done
  return 1
}

# The same with the changed file and the tests compiled for sanitizers.
who_notices_sanitized() {
  touch "$1"
  SANITIZE="-fsanitize=address,undefined -fno-sanitize-recover=undefined"
  status=0
  who_notices "$1" "$2" || status=1
  SANITIZE=
  return $status
}

# Prints every change that the table allows: file, line, column, old, new, separated by tabs.
list_changes() {
  # shellcheck disable=SC2086
  find $FOLDERS -name '*.c' | sort | xargs awk -F '\t' '
    NR == FNR { old[++n] = $1; new[n] = $2; next }
    /^ *(\/\/|#)/ || /"/ || /^static_assert/ { next }
    {
      text = $0
      sub(/ *\/\/.*/, "", text)
      for (i = 1; i <= n; i++)
        for (from = 1; (at = index(substr(text, from), old[i])) > 0; from += at)
          print FILENAME "\t" FNR "\t" (from + at - 1) "\t" old[i] "\t" new[i]
    }' tools/mutations.txt
}

# Applies one change to its file.
apply_change() {
  awk -v line="$2" -v column="$3" -v old="$4" -v new="$5" '
    FNR == line { $0 = substr($0, 1, column - 1) new substr($0, column + length(old)) }
    { print }' "$1" > ../changed.c && cp ../changed.c "$1"
}

# Whether the change on the line of the file is in the list of those without effect. The list has the changed line itself.
is_equivalent() {
  [ -e tools/equivalent_mutations.txt ] && grep -qxF "$1$tab$(sed -n "${2}s/^ *//p" "$1")" tools/equivalent_mutations.txt
}

# The changes in random order; the same SEED gives the same order for the same sources.
list_changes | awk -v seed="$SEED" 'BEGIN { srand(seed) } { printf "%.9f\t%s\n", rand(), $0 }' | sort -n | cut -f 2- > ../changes.txt
[ "$SKIP" -gt 0 ] || : > ../survivors.txt
build test-programs || {
  tail ../build.log
  exit 1
}
measure_suites

tried=0 noticed=0
while [ "$tried" -lt $((SKIP + N)) ] && IFS=$tab read -r file line column old new <&3; do
  object=build/obj/${file%.c}.o
  cp -p "$file" ../original.c
  cp -p "$object" ../original.o
  apply_change "$file" "$line" "$column" "$old" "$new"
  if ! is_equivalent "$file" "$line" && build "$object" && ! cmp -s "$object" ../original.o; then
    tried=$((tried + 1))
    change="$file:$line: \`$old\` -> \`$new\`: $(sed -n "${line}s/^ *//p" ../original.c)"
    if [ "$tried" -le "$SKIP" ]; then
      :
    elif suite=$(who_notices "$file" "$line"); then
      noticed=$((noticed + 1))
      echo "$suite: $change"
    elif suite=$(who_notices_sanitized "$file" "$line"); then
      noticed=$((noticed + 1))
      echo "$suite, sanitized: $change"
    else
      echo "not noticed: $change"
      echo "$change" >> ../survivors.txt
    fi
  fi
  cp ../original.c "$file"
done 3< ../changes.txt
awk -v noticed="$noticed" -v tried="$((tried - SKIP))" 'BEGIN { printf "%d of %d changes noticed (%.0f %%)\n", noticed, tried, tried ? 100 * noticed / tried : 0 }'
