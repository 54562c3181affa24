#!/bin/sh
# Tests of the command line: runs the real program on real files. BUILD is the build folder (default build).
#   sh tests/cli/run.sh [NAME ...]      all files cases_*.sh, or some: usage bad_input ...
# The last line is `N passed, N failed, N skipped`.
set -u
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
BUILD=${BUILD:-$root/build}
case $BUILD in /*) ;; *) BUILD=$root/$BUILD ;; esac
CAG=$BUILD/cag
passed=0 failed=0 skipped=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$here/harness.sh"

[ $# -gt 0 ] || set -- $(cd "$here" && ls cases_*.sh | sed "s/^cases_\(.*\)\.sh$/\1/")
for name in "$@"; do
  mkdir "$work/$name"
  cd "$work/$name" || exit 1
  . "$here/cases_$name.sh"
  it ''
  cd "$root" || exit 1
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
