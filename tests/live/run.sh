#!/bin/sh
# Tests of the language server with clients. The last line is `N passed, N failed, N skipped`. Tests that need a missing tool are skipped.
#
#   BUILD=build sh tests/live/run.sh           with 300 random edits
#   EDITS=10000 sh tests/live/run.sh           the long run
set -u
cd "$(dirname "$0")/../.."
here=$PWD
build=${BUILD:-build}
case $build in /*) ;; *) build=$PWD/$build ;; esac
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0

# result NAME STATUS TEXT: counts a test, and shows the text if it failed.
result() {
  if [ "$2" = 0 ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED $1"
    [ -z "${3-}" ] || printf '%s\n' "$3" | head -n 20 | sed 's/^/  /'
  fi
}

# counted COMMAND: runs tests that print counts.
counted() {
  "$@" > "$work/out" 2>&1
  status=$?
  grep -v ' passed, ' "$work/out"
  counts=$(tail -n 1 "$work/out" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed, \([0-9]*\) skipped$/\1 \2 \3/p')
  set -- ${counts:-0 1 0}
  [ "$status" -eq 0 ] || [ "$2" -gt 0 ] || set -- "$1" 1 "$3"
  passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3))
}

counted python3 tests/live/requests.py "$build/cag"
counted python3 tests/live/hostile.py "$build/cag"
found=$(python3 tests/live/random_edits.py "$build/cag" "${EDITS:-300}" "${SEED:-1}" 2>&1)
result 'random edits' $? "$found"

# write_files FOLDER: the files of the tests with editors. a.cag has one error.
write_files() {
  mkdir -p "$1"
  printf 'import std.materials as mat\nimport b\nring(outer, inner) = outer + inner\nprint raduis, mat.brass.color, b.x, ring(2, 1)\nradius = 3\nshow []\n' > "$1/a.cag"
  echo 'x = 2' > "$1/b.cag"
}

if command -v nvim > /dev/null; then
  write_files "$work/files"
  (cd "$work/files" && OUT=$work/neovim EDITORS=$here/editors CAG=$build/cag XDG_CACHE_HOME=$work/cache XDG_STATE_HOME=$work/state HOME=$work \
    timeout 120 nvim --headless -u NONE -i NONE -n -S "$here/tests/live/neovim.lua" a.cag < /dev/null > "$work/nvim" 2>&1)
  result 'Neovim ends' $? "$(cat "$work/nvim")"
  sed -n 's/^FAILED /FAILED Neovim: /p' "$work/neovim"
  passed=$((passed + $(grep -c '^ok ' "$work/neovim"))) failed=$((failed + $(grep -c '^FAILED ' "$work/neovim")))
else
  count=$(grep -c '^ *check("' tests/live/neovim.lua)
  echo "skipped: $count tests with Neovim: nvim is missing"
  skipped=$((skipped + count))
fi

if command -v script > /dev/null && vim -N -es -u NONE -i NONE -c 'packadd ale' -c 'if exists(":ALELint") | qall! | endif' -c 'cquit!' < /dev/null > /dev/null 2>&1; then
  write_files "$work/vim"
  (cd "$work/vim" && OUT=$work/ale EDITORS=$here/editors CAG=$build/cag XDG_CACHE_HOME=$work/cache HOME=$work \
    timeout 60 script -qec "vim -u '$here/tests/live/ale.vim' -i NONE -n -c 'call Start()'" /dev/null < /dev/null > "$work/out" 2>&1)
  [ "$(cat "$work/ale" 2> /dev/null)" = "cag
4:7 E0201: unknown name \`raduis\` help: did you mean \`radius\`?" ]
  result 'Vim with ALE shows the error' $? "$(cat "$work/ale" 2>&1)"
else
  echo 'skipped: 1 test with Vim: its plugin ALE, or script, is missing'
  skipped=$((skipped + 1))
fi

if command -v emacs > /dev/null && HOME=$work emacs --batch --eval '(progn (package-initialize) (require (quote eglot)))' > /dev/null 2>&1; then
  write_files "$work/emacs"
  (cd "$work/emacs" && EDITORS=$here/editors CAG=$build/cag XDG_CACHE_HOME=$work/cache HOME=$work \
    timeout 120 emacs --batch -l "$here/tests/live/emacs.el" < /dev/null > "$work/out" 2> "$work/err")
  result 'Emacs ends' $? "$(tail -n 5 "$work/err")"
  sed -n 's/^FAILED /FAILED Emacs: /p' "$work/out"
  passed=$((passed + $(grep -c '^ok ' "$work/out"))) failed=$((failed + $(grep -c '^FAILED ' "$work/out")))
else
  count=$(grep -c '(check "' tests/live/emacs.el)
  echo "skipped: $count tests with Emacs: emacs, or its package eglot, is missing"
  skipped=$((skipped + count))
fi

# The extension of Visual Studio Code, from its package.
if command -v node > /dev/null && command -v unzip > /dev/null; then
  make -s BUILD="$build" "$build/cag.vsix" > "$work/make" 2>&1
  result 'make vsix' $? "$(cat "$work/make")"
  mkdir "$work/model"
  unzip -q "$build/cag.vsix" -d "$work/vsix" && xmllint --noout "$work/vsix/extension.vsixmanifest" "$work/vsix/[Content_Types].xml"
  result 'the package is a zip file with a manifest' $?
  XDG_CACHE_HOME=$work/cache timeout 120 node tests/live/vscode.js "$work/vsix/extension" "$build/cag" "$work/model" > "$work/vscode" 2>&1
  result 'the extension ends' $? "$(grep -v '^ok ' "$work/vscode")"
  passed=$((passed + $(grep -c '^ok ' "$work/vscode")))
  # The preview in a panel, whose page is shown by Chromium.
  browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome)
  if [ -z "$browser" ]; then
    count=$(sed -n '/^async function withBrowser/,$p' tests/live/vscode_preview.js | grep -c '^ *await check("')
    echo "skipped: $count tests of the page in a panel: chromium is missing"
    skipped=$((skipped + count))
  fi
  mkdir "$work/preview"
  XDG_CACHE_HOME=$work/cache timeout 300 node tests/live/vscode_preview.js "$work/vsix/extension" "$build/cag" "$work/preview" $browser > "$work/vscode" 2>&1
  result 'the preview ends' $? "$(grep -v '^ok ' "$work/vscode")"
  passed=$((passed + $(grep -c '^ok ' "$work/vscode")))
else
  count=$(cat tests/live/vscode.js tests/live/vscode_preview.js | grep -c '^ *await check("')
  echo "skipped: $count tests of the extension of Visual Studio Code: node or unzip is missing"
  skipped=$((skipped + count))
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
