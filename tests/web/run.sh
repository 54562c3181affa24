#!/bin/sh
# Tests the page of `cag view`: its modules in node, and the page itself in Chromium. BUILD is the folder of the build. The last line is
# `N passed, N failed, N skipped`.
set -u
cd "$(dirname "$0")/../.."
BUILD=${BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0

# run COMMAND ...: adds the counts of a command to those of the suite.
run() {
  "$@" > "$work/log" 2>&1 < /dev/null
  status=$?
  cat "$work/log"
  counts=$(tail -n 1 "$work/log" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed, \([0-9]*\) skipped$/\1 \2 \3/p')
  [ -n "$counts" ] || counts="0 1 0"
  set -- $counts
  [ $status -eq 0 ] || [ "$2" -gt 0 ] || set -- "$1" 1 "$3"
  passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3))
}
skip() {
  echo "skipped: $1"
  skipped=$((skipped + 1))
}

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
if ! command -v node > /dev/null; then
  skip 'node is missing'
else
  # Some modules import three.js.
  if make -s web/node_modules > "$work/log" 2>&1; then
    run node tests/web/units.mjs
  else
    skip 'the packages of web/ are missing'
  fi
  if [ -n "$browser" ]; then
    run node tests/web/page.js "$browser" "$BUILD/cag" view --no-open
  else
    skip 'chromium is missing'
  fi
fi
# The playground is built where emscripten is installed. Without pictures, that takes less than half of the time.
if ! command -v emcc > /dev/null || ! command -v node > /dev/null || ! command -v esbuild > /dev/null || ! command -v dpkg-source > /dev/null || [ ! -d /usr/include/eigen3 ]; then
  skip 'emscripten, libeigen3-dev, dpkg-dev, node, or esbuild is missing'
elif ! make -s playground BUILD="$BUILD" PLAYGROUND_PICTURES=--no-pictures > "$work/log" 2>&1; then
  # The sources of the libraries are downloaded.
  if [ -f "$BUILD/playground-deps/libdeps.a" ]; then
    tail -n 20 "$work/log"
    echo 'FAILED: make playground'
    failed=$((failed + 1))
  else
    skip 'the sources of the libraries of the playground cannot be downloaded'
  fi
else
  run node tests/web/playground.mjs "$BUILD/cag" "$BUILD/wasm/cag.mjs"
  if [ -n "$browser" ]; then
    PLAYGROUND=1 run node tests/web/page.js "$browser" node tests/web/playground_server.js "$BUILD/playground"
    run node tests/web/playground_page.js "$browser" "$BUILD/playground"
  fi
fi
# The committed bundle is what the sources give. Another esbuild writes other bytes.
if [ "$(esbuild --version 2> /dev/null)" != 0.17.0 ] || ! make -s web/node_modules > "$work/log" 2>&1; then
  skip 'esbuild 0.17.0 or the packages of web/ are missing'
elif make -s check-web BUILD="$BUILD" > "$work/log" 2>&1; then
  passed=$((passed + 1))
else
  cat "$work/log"
  echo 'FAILED: web/dist is not what the sources give; run `make web`'
  failed=$((failed + 1))
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed -eq 0 ]
