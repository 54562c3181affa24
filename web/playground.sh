#!/bin/sh
# Bundles the playground into FOLDER: the page with its engine, and the worker.
#   web/playground.sh FOLDER CAG.MJS SOURCES     CAG.MJS is emscripten's part of the program, with cag.wasm beside it; SOURCES has the sources of
#                                               the libraries in the program, for their licenses
set -eu
out=$(mkdir -p "$1" && cd "$1" && pwd) program=$(cd "$(dirname "$2")" && pwd)/$(basename "$2") sources=$(cd "$3" && pwd)
cd "$(dirname "$0")"
bundle() { esbuild "$1" --bundle --minify --charset=utf8 --legal-comments=none --log-level=warning "--outfile=$out/$2" --target=es2022 --format=esm "--alias:cag-wasm=$program" '--external:./editor.bundle.js'; }
bundle src/boot.js boot.js
bundle src/playground.js playground.js
bundle src/editor.js editor.bundle.js
bundle src/worker.js worker.js
cat src/page.css src/playground.css | esbuild --loader=css --minify --log-level=warning > "$out/page.css"
cp src/icon.svg "$out"
mkdir -p "$out/fonts"
cp ../fonts/*.ttf "$out/fonts"
cp "${program%.mjs}.wasm" "$out"
# The page is that of cag view, with another entry, and with a policy that the server would send.
policy="default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; img-src 'self' data:; base-uri 'none'; form-action 'none'; object-src 'none'"
notice='Loading. If nothing appears, the page must be served: run <code>python3 -m http.server<\/code> in its folder, and open <code>http:\/\/localhost:8000<\/code>.'
sed -e "s|<meta charset=\"utf-8\">|&\\
<meta http-equiv=\"Content-Security-Policy\" content=\"$policy\">|" \
  -e 's|<script type="module" src="page.js"></script>|<script type="module" src="boot.js"></script>\
<link rel="modulepreload" href="worker.js">\
<script type="module" src="playground.js"></script>|' -e "s/<p id=\"notice\" role=\"alert\" hidden><\/p>/<p id=\"notice\" role=\"alert\">$notice<\/p>/" src/index.html > "$out/index.html"
grep -q playground.js "$out/index.html" && grep -q http.server "$out/index.html" && grep -q wasm-unsafe-eval "$out/index.html"
{
  for name in three codemirror @codemirror/view @codemirror/state @lezer/common @lezer/highlight style-mod w3c-keyname crelt; do
    printf '%s %s\n\n' "$name" "$(sed -n 's/^ *"version": "\(.*\)",$/\1/p' "node_modules/$name/package.json")"
    cat "node_modules/$name/LICENSE"
    echo
  done
  for name in utf8proc zlib libpng1.6 cjson libxml2 fribidi; do
    printf '%s\n\n' "$name"
    cat "$sources/$name/debian/copyright"
    echo
  done
  printf 'The terms of FriBidi let you change it and link the program with your version: its source is the package fribidi of Debian, %s,\nwhich `make playground` in the source of cag downloads, compiles, and links.\n\n' \
    "$(sed -n 's/^.* (\(.*\)) .*/version \1/p;q' "$sources/fribidi/debian/changelog")"
  cat "$sources/fribidi/COPYING"
  printf '\nharfbuzz\n\n'
  cat "$sources/harfbuzz/COPYING"
  printf '\nfonts\n\n'
  cat ../fonts/OFL.txt
  printf '\nlibglu\n\n'
  sed -n '1,/^ \*\//p' "$sources/libglu/src/libtess/tess.c"
  for package in libeigen3-dev emscripten; do
    printf '\n%s\n\n' "$package"
    cat "/usr/share/doc/$package/copyright"
  done
} > "$out/licenses.txt"
