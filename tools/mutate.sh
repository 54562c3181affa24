#!/bin/sh
# Measures how many random changes to the code the tests notice (a mutation score). Not part of the tests: 100 changes take hours.
#
#     N=100 SEED=1 sh tools/mutate.sh
#
# Works on a copy of the tree in build-mutate/. Each change replaces one operator or constant on one line of geom, interp or lang, by
# the table tools/mutations.txt. A change that does not compile, or that leaves the object file as it was, is drawn again. The suites
# run until one fails. Changes that no suite notices are printed, and kept in build-mutate/survivors.txt.
set -eu
cd "$(dirname "$0")/.."
N=${N:-100} SEED=${SEED:-1}
[ -n "$N" ] || N=100
[ -n "$SEED" ] || SEED=1
TREE=$PWD/build-mutate/tree

mkdir -p "$TREE"
git ls-files -z | xargs -0 cp -p --parents -t "$TREE"
cd "$TREE"
make -s -j"$(nproc)" test-programs > ../build.log 2>&1 || { tail ../build.log; exit 1; }

# Prints every change that the table allows: file, line, column, old, new, separated by tabs.
list_changes() {
  find geom interp lang -name '*.c' | sort | xargs awk -F '\t' '
    FILENAME != "tools/mutations.txt" && FNR == 1 { file = FILENAME }
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

# Succeeds when a suite fails: the change is noticed. A suite that takes far longer than it should has failed.
is_noticed() {
  for program in build/tests/*/*_test; do
    timeout 120 "$program" > /dev/null 2>&1 || return 0
  done
  timeout 300 build/cag test --no-pictures tests/language stdlib > /dev/null 2>&1 || return 0
  for vectors in tests/data/0*.json; do
    BUILD=build timeout 300 tests/vectors/run "$vectors" > /dev/null 2>&1 || return 0
  done
  BUILD=$PWD/build timeout 900 sh tests/repl/run.sh > /dev/null 2>&1 || return 0
  BUILD=$PWD/build timeout 1800 sh tests/cli/run.sh > /dev/null 2>&1 || return 0
  timeout 600 build/cag test tests/scenes > /dev/null 2>&1 || return 0
  return 1
}

# The changes in random order; the same SEED gives the same order for the same sources.
list_changes | awk -v seed="$SEED" 'BEGIN { srand(seed) } { printf "%.9f\t%s\n", rand(), $0 }' | sort -n | cut -f 2- > ../changes.txt
: > ../survivors.txt

tried=0 noticed=0
tab=$(printf '\t')
while [ "$tried" -lt "$N" ] && IFS=$tab read -r file line column old new <&3; do
  object=build/obj/${file%.c}.o
  cp -p "$file" ../original.c
  cp -p "$object" ../original.o
  apply_change "$file" "$line" "$column" "$old" "$new"
  if make -s "$object" > ../build.log 2>&1 && ! cmp -s "$object" ../original.o && make -s -j"$(nproc)" test-programs > ../build.log 2>&1; then
    tried=$((tried + 1))
    change="$file:$line: \`$old\` -> \`$new\`: $(sed -n "${line}s/^ *//p" ../original.c)"
    if is_noticed; then
      noticed=$((noticed + 1))
    else
      echo "not noticed: $change"
      echo "$change" >> ../survivors.txt
    fi
  fi
  cp "../original.c" "$file"
done 3< ../changes.txt
awk -v noticed="$noticed" -v tried="$tried" 'BEGIN { printf "%d of %d changes noticed (%.0f %%)\n", noticed, tried, tried ? 100 * noticed / tried : 0 }'
