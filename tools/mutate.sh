#!/bin/sh
# Measures how many random changes to the code the tests notice (a mutation score). Not part of the tests: 100 changes take hours.
#
#     N=100 SEED=1 sh tools/mutate.sh
#
# SKIP=20 skips the first 20 changes of the seed, to continue an earlier run. FOLDERS="geom/curve" changes only files in these folders.
#
# Works on a copy of the tree in build-mutate/. Each change replaces one operator or constant on one line of geom, interp or lang, by
# the table tools/mutations.txt. A change that does not compile, or does not change the object file, is replaced with another one. The
# suites run until one fails, starting with those that are quick and likely to detect the change: unit tests that include the changed
# file's header, the other unit tests of its part, scripts, vectors, the rest, and finally the command line. Each suite has a memory limit
# and a time limit, which is 10 s plus 4 times the time for the unchanged code. Undetected changes are printed and stored in
# build-mutate/survivors.txt.
set -eu
cd "$(dirname "$0")/.."
N=${N:-100} SEED=${SEED:-1} SKIP=${SKIP:-0} FOLDERS=${FOLDERS:-geom interp lang}
[ -n "$N" ] || N=100
[ -n "$SEED" ] || SEED=1
TREE=$PWD/build-mutate/tree
MEMORY=4000000 # KiB

# Runs a suite by name. The name of a unit test is its program, which is linked again before it runs.
run_suite() {
  case $1 in
  build/tests/*_test) "$1" ;;
  scripts) build/cag test --no-pictures tests/language stdlib ;;
  vectors) for file in tests/data/0*.json; do BUILD=build tests/vectors/run "$file" || return 1; done ;;
  examples) build/cag test --no-pictures examples ;;
  fuzz) build/tests/fuzz/fuzz 1 ;;
  repl) BUILD=$TREE/build sh tests/repl/run.sh ;;
  scenes) build/cag test tests/scenes ;;
  cli) BUILD=$TREE/build sh tests/cli/run.sh ;;
  esac
}
# `sh tools/mutate.sh --suite NAME`, in the copy, runs one suite, because timeout needs a program.
if [ "${1:-}" = --suite ]; then
  TREE=$PWD
  run_suite "$2"
  exit
fi

mkdir -p "$TREE"
git ls-files -z | xargs -0 cp -p --parents -t "$TREE"
cd "$TREE"
TIMES=$TREE/../times
mkdir -p "$TIMES"
build() { make -s -j"$(nproc)" OPT=-O1 CFLAGS=-Wno-error "$@" > ../build.log 2>&1; }
build test-programs || { tail ../build.log; exit 1; }

link_suite() {
  case $1 in
  build/tests/*_test) build "$1" ;;
  vectors) build build/tests/vectors/run ;;
  fuzz) build build/tests/fuzz/fuzz ;;
  *) build all ;;
  esac
}

# Runs a suite within limits: limited SECONDS SUITE.
limited() {
  (
    ulimit -v "$MEMORY"
    exec timeout -k 5 "$1" sh "$TREE/tools/mutate.sh" --suite "$2"
  ) > /dev/null 2>&1
}

# The time in seconds that a suite takes for the unchanged code, measured once. 0 means that it fails, so it cannot detect anything.
usual_time() {
  kept=$TIMES/$(echo "$1" | tr / _)
  if [ ! -s "$kept" ]; then
    began=$(date +%s)
    if limited 1800 "$1"; then echo $(($(date +%s) - began + 1)) > "$kept"; else echo 0 > "$kept"; fi
  fi
  cat "$kept"
}

# The suites in the order in which they run for a change to the file.
suites_for() {
  header=${1%.c}.h
  part=${1%%/*}
  {
    grep -l "\"$header\"" tests/*/*_test.c || true
    grep -l "\"$(dirname "$1")/" tests/"$part"/*_test.c || true
    ls tests/"$part"/*_test.c
  } | sed 's|^|build/|; s|\.c$||' | awk '!seen[$0]++'
  echo scripts
  echo vectors
  ls tests/*/*_test.c | grep -v "^tests/$part/" | sed 's|^|build/|; s|\.c$||'
  printf '%s\n' examples fuzz repl scenes cli
}

# Prints the suite that fails, and succeeds if there is one: the change is detected.
who_notices() {
  for suite in $(suites_for "$1"); do
    seconds=$(cat "$TIMES/$(echo "$suite" | tr / _)")
    [ "$seconds" -gt 0 ] || continue
    if ! link_suite "$suite" || ! limited $((4 * seconds + 10)) "$suite"; then
      echo "$suite"
      return 0
    fi
  done
  return 1
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

# The changes in random order; the same SEED gives the same order for the same sources.
list_changes | awk -v seed="$SEED" 'BEGIN { srand(seed) } { printf "%.9f\t%s\n", rand(), $0 }' | sort -n | cut -f 2- > ../changes.txt
: > ../survivors.txt
for suite in $(suites_for geom/status.c); do usual_time "$suite" > /dev/null; done

tried=0 noticed=0
tab=$(printf '\t')
while [ "$tried" -lt $((SKIP + N)) ] && IFS=$tab read -r file line column old new <&3; do
  object=build/obj/${file%.c}.o
  cp -p "$file" ../original.c
  cp -p "$object" ../original.o
  apply_change "$file" "$line" "$column" "$old" "$new"
  if build "$object" && ! cmp -s "$object" ../original.o; then
    tried=$((tried + 1))
    change="$file:$line: \`$old\` -> \`$new\`: $(sed -n "${line}s/^ *//p" ../original.c)"
    if [ "$tried" -le "$SKIP" ]; then
      :
    elif suite=$(who_notices "$file"); then
      noticed=$((noticed + 1))
      echo "$suite: $change"
    else
      echo "not noticed: $change"
      echo "$change" >> ../survivors.txt
    fi
  fi
  cp ../original.c "$file"
done 3< ../changes.txt
awk -v noticed="$noticed" -v tried="$((tried - SKIP))" 'BEGIN { printf "%d of %d changes noticed (%.0f %%)\n", noticed, tried, tried ? 100 * noticed / tried : 0 }'
