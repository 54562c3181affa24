#!/bin/sh
# Prints which fraction of each folder's lines and branches the tests reach. BUILD names a build with --coverage whose tests have run.
# FILES=1 prints files instead of folders.
set -eu
cd "$(dirname "$0")/.."
if ! command -v gcovr > /dev/null; then
  echo "make coverage requires gcovr: apt-get install gcovr" >&2
  exit 1
fi

# gcovr runs in a single process because with -j it can deadlock.
csv=$(mktemp)
trap 'rm -f "$csv"' EXIT
gcovr --root . --object-directory "$BUILD" --filter '(base|cli|geom|interp|lang|live)/' --csv -o "$csv" "$BUILD"

# The columns of gcovr's table: filename, line_total, line_covered, line_percent, branch_total, branch_covered, branch_percent ...
awk -F, -v files="${FILES:-}" '
  function percent(part, whole) { return whole ? 100 * part / whole : 100 }
  function row(name) {
    return sprintf("%-32s %7d %6.1f %9d %6.1f", name, lines[name], percent(lines_met[name], lines[name]), branches[name],
                   percent(branches_met[name], branches[name]))
  }
  function add(name) { lines[name] += $2; lines_met[name] += $3; branches[name] += $5; branches_met[name] += $6 }
  NR > 1 {
    name = $1
    if (!files) sub("/[^/]*$", "", name)
    add(name)
    add("all")
  }
  END {
    printf "%-32s %7s %6s %9s %6s\n", "", "lines", "%", "branches", "%"
    for (name in lines) if (name != "all") print row(name) | "sort"
    close("sort")
    print row("all")
  }' "$csv"
