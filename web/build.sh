#!/bin/sh
# Bundles the page into FOLDER, each file compressed. The same sources give the same bytes.
#   web/build.sh FOLDER        after `npm ci` in web/
set -eu
cd "$(dirname "$0")"
case $1 in /*) out=$1 ;; *) out=$OLDPWD/$1 ;; esac
made=$(mktemp -d)
trap 'rm -rf "$made"' EXIT
bundle() { esbuild "$1" --bundle --minify --charset=utf8 --legal-comments=none --log-level=warning "--outfile=$made/$2" --target=es2022 --format=esm '--external:./editor.bundle.js'; }
bundle src/main.js page.js
# The editor is loaded after the first picture.
bundle src/editor.js editor.bundle.js
esbuild src/page.css --minify --log-level=warning "--outfile=$made/page.css"
cp src/index.html src/icon.svg "$made"
# The bundles contain these packages.
for name in three codemirror @codemirror/view @codemirror/state @lezer/common @lezer/highlight style-mod w3c-keyname crelt; do
  printf '%s %s\n\n' "$name" "$(sed -n 's/^ *"version": "\(.*\)",$/\1/p' "node_modules/$name/package.json")"
  cat "node_modules/$name/LICENSE"
  echo
done > "$made/licenses.txt"
mkdir -p "$out"
for file in "$made"/*; do gzip -9n < "$file" > "$out/$(basename "$file").gz"; done
