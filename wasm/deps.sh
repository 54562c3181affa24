#!/bin/sh
# Downloads the Debian sources of the libraries that cag needs, and compiles them for WebAssembly.
#   wasm/deps.sh FOLDER        leaves FOLDER/include and FOLDER/libdeps.a
# FOLDER/sources keeps what was downloaded. Needs emscripten, clang, and dpkg-dev.
set -eu
folder=$1
mkdir -p "$folder/sources" "$folder/include" "$folder/obj"
folder=$(cd "$folder" && pwd)
sources=$folder/sources include=$folder/include

# The lists of sources are private, so nothing of the system is changed.
private_apt() {
  apt-get -qq -o "Dir::Etc::sourcelist=$folder/sources.list" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$folder/lists" -o APT::Sandbox::User=root "$@"
}
fetch() {
  lists=$folder/lists
  if [ ! -d "$lists" ]; then
    mkdir -p "$lists/partial"
    . /etc/os-release
    echo "deb-src ${DEBIAN_MIRROR:-http://deb.debian.org/debian} $VERSION_CODENAME main" > "$folder/sources.list"
    private_apt update || { rm -rf "$lists"; return 1; }
  fi
  (cd "$sources" && private_apt source --download-only "$@" > /dev/null)
}
# Unpacks a source package, with Debian's patches, into $sources/NAME.
#   unpack NAME [OPTION]
unpack() {
  [ -d "$sources/$1" ] && return
  fetch "$@"
  rm -rf "$sources/$1.new"
  if [ "${2:-}" = --tar-only ]; then
    mkdir "$sources/$1.new"
    tar -xf "$(ls "$sources/$1"_*.orig.tar.*)" -C "$sources/$1.new" --strip-components=1
  else
    (cd "$sources" && dpkg-source --no-check -x "$(ls "$1"_*.dsc)" "$1.new" > /dev/null)
  fi
  mv "$sources/$1.new" "$sources/$1"
}

unpack utf8proc
unpack zlib
unpack libpng1.6
unpack cjson
unpack libxml2
# Debian changes no source of this package.
unpack libglu --tar-only

cp "$sources/utf8proc/utf8proc.h" "$sources/zlib/zlib.h" "$sources/zlib/zconf.h" "$sources/libpng1.6/png.h" "$sources/libpng1.6/pngconf.h" "$include"
cp "$sources/libpng1.6/scripts/pnglibconf.h.prebuilt" "$include/pnglibconf.h"
mkdir -p "$include/cjson" "$include/GL" "$include/libxml"
cp "$sources/cjson/cJSON.h" "$include/cjson/cJSON.h"
cp "$sources/cjson/cJSON.h" "$include"
cp "$sources/libglu/include/GL/glu.h" "$include/GL"
cp "$sources"/libxml2/include/libxml/*.h "$include/libxml"
# Of libxml2, the parser that makes a tree.
sed -e 's/@VERSION@/2.9/; s/@LIBXML_VERSION_NUMBER@/20900/; s/@LIBXML_VERSION_STRING@/20900/; s/@LIBXML_VERSION_EXTRA@//; s/@MODULE_EXTENSION@//' \
  -e 's/@WITH_TREE@/1/; s/@WITH_SAX1@/1/' -e 's/@WITH_[A-Z0-9_]*@/0/' "$sources/libxml2/include/libxml/xmlversion.h.in" > "$include/libxml/xmlversion.h"
printf '%s\n' '#define HAVE_STDLIB_H 1' '#define HAVE_STRING_H 1' '#define HAVE_SYS_TYPES_H 1' '#define HAVE_SYS_STAT_H 1' '#define HAVE_FCNTL_H 1' \
  '#define HAVE_UNISTD_H 1' '#define HAVE_CTYPE_H 1' '#define HAVE_ERRNO_H 1' '#define HAVE_MATH_H 1' '#define HAVE_FLOAT_H 1' '#define HAVE_LIMITS_H 1' '#define HAVE_STDARG_H 1' \
  '#define HAVE_TIME_H 1' '#define HAVE_STAT 1' '#define HAVE_ISNAN 1' '#define HAVE_ISINF 1' '#define HAVE_VA_COPY 1' '#define HAVE_STDINT_H 1' '#define HAVE_RAND_R 1' > "$include/config.h"

compile() { # NAME FILES OPTIONS
  name=$1 files=$2
  shift 2
  for file in $files; do
    echo "$@" -c "$sources/$name/$file" -o "$folder/obj/$name-$(basename "$file" .c).o"
  done >> "$folder/commands"
}
rm -f "$folder/commands" "$folder"/obj/*.o
compile utf8proc utf8proc.c -DUTF8PROC_STATIC
compile zlib "adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c uncompr.c zutil.c"
compile libpng1.6 "png.c pngerror.c pngget.c pngmem.c pngpread.c pngread.c pngrio.c pngrtran.c pngrutil.c pngset.c pngtrans.c pngwio.c pngwrite.c pngwtran.c pngwutil.c"
compile cjson cJSON.c
compile libglu "src/libtess/dict.c src/libtess/geom.c src/libtess/memalloc.c src/libtess/mesh.c src/libtess/normal.c src/libtess/priorityq.c src/libtess/render.c src/libtess/sweep.c src/libtess/tess.c src/libtess/tessmono.c" "-I$sources/libglu/src/include"
compile libxml2 "SAX2.c buf.c chvalid.c dict.c encoding.c entities.c error.c globals.c hash.c list.c parser.c parserInternals.c threads.c tree.c uri.c valid.c xmlIO.c xmlmemory.c xmlstring.c" -DHAVE_CONFIG_H "-I$sources/libxml2" "-I$sources/libxml2/include"
xargs -P "${JOBS:-2}" -L 1 ${CLANG:-clang} $(emcc --cflags) ${OPT:--Os} -w "-I$include" < "$folder/commands"
rm -f "$folder/libdeps.a"
emar rcs "$folder/libdeps.a" "$folder"/obj/*.o
