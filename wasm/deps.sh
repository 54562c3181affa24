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
    tar -xf "$(ls "$sources/$1"_*.orig.tar.*)" -C "$sources/$1.new" --strip-components=1 --exclude='*/test'
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
unpack fribidi
# Debian changes no source of these packages.
unpack libglu --tar-only
unpack harfbuzz --tar-only

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

# Of FriBidi, the algorithm for both directions. Its tables are in the source.
cp "$sources"/fribidi/lib/fribidi*.h "$include"
version() { sed -n "s/^m4_define(fribidi_$1, *\([0-9]*\).*/\1/p" "$sources/fribidi/configure.ac"; }
sed -e "s/@FRIBIDI_MAJOR_VERSION@/$(version major_version)/; s/@FRIBIDI_MINOR_VERSION@/$(version minor_version)/; s/@FRIBIDI_MICRO_VERSION@/$(version micro_version)/" \
  -e "s/@FRIBIDI_INTERFACE_VERSION@/$(version interface_version)/; s/@SIZEOF_INT@/4/; s/@PACKAGE[A-Z_]*@/fribidi/; s/@FRIBIDI_VERSION@/fribidi/; /@FRIBIDI_MSVC/d" \
  "$sources/fribidi/lib/fribidi-config.h.in" > "$include/fribidi-config.h"

# Of HarfBuzz, what the compiled-in fonts need: TrueType outlines, without variations, hints, or instructions for scripts that they do not have. With
# that, a text is shaped as by the whole library.
cp "$sources"/harfbuzz/src/hb*.h "$include"
printf '#undef %s\n' HB_NO_DRAW HB_NO_VERTICAL HB_NO_OT_SHAPE_FRACTIONS HB_NO_OT_SHAPE_FALLBACK HB_NO_LAYOUT_RARELY_USED HB_NO_UCD_UNASSIGNED > "$include/config-override.h"
others='arabic indic khmer myanmar use'
sed -E "/ot-shaper-(vowel|syllabic|$(echo $others | tr ' ' '|'))/d" "$sources/harfbuzz/src/harfbuzz.cc" > "$sources/harfbuzz/src/few.cc"
as_default=$(printf -- '-D_hb_ot_shaper_%s=_hb_ot_shaper_default ' $others)
sysroot=$(emcc --cflags | sed -n 's/.*--sysroot=\([^ ]*\).*/\1/p')

compile() { # NAME FILES OPTIONS
  name=$1 files=$2
  shift 2
  for file in $files; do
    echo "$@" -c "$sources/$name/$file" -o "$folder/obj/$name-$(basename "$file" .c).o"
  done >> "$folder/commands"
}
rm -f "$folder/commands" "$folder"/obj/*.o
# wasm/base/unicode.c replaces what needs the tables of utf8proc.
compile utf8proc utf8proc.c -DUTF8PROC_STATIC -Dutf8proc_category=unused_category -Dutf8proc_charwidth=unused_charwidth -Dutf8proc_map=unused_map \
  -Dutf8proc_toupper=unused_toupper -Dutf8proc_tolower=unused_tolower
compile zlib "adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c uncompr.c zutil.c"
compile libpng1.6 "png.c pngerror.c pngget.c pngmem.c pngpread.c pngread.c pngrio.c pngrtran.c pngrutil.c pngset.c pngtrans.c pngwio.c pngwrite.c pngwtran.c pngwutil.c"
compile cjson cJSON.c
compile libglu "src/libtess/dict.c src/libtess/geom.c src/libtess/memalloc.c src/libtess/mesh.c src/libtess/normal.c src/libtess/priorityq.c src/libtess/render.c src/libtess/sweep.c src/libtess/tess.c src/libtess/tessmono.c" "-I$sources/libglu/src/include"
compile libxml2 "SAX2.c buf.c chvalid.c dict.c encoding.c entities.c error.c globals.c hash.c list.c parser.c parserInternals.c threads.c tree.c uri.c valid.c xmlIO.c xmlmemory.c xmlstring.c" -Oz -DHAVE_CONFIG_H "-I$sources/libxml2" "-I$sources/libxml2/include"
compile fribidi "lib/fribidi.c lib/fribidi-bidi.c lib/fribidi-bidi-types.c lib/fribidi-brackets.c lib/fribidi-mirroring.c lib/fribidi-run.c" -Oz -DFRIBIDI_LIB_STATIC -DHAVE_STDLIB_H -DHAVE_STRING_H -DHAVE_STRINGIZE \
  "-I$sources/fribidi/lib"
compile harfbuzz src/few.cc -x c++ -Oz -std=c++17 -fno-exceptions -fno-rtti -fno-threadsafe-statics -isystem "$sysroot/include/c++/v1" -DHB_TINY -DHAVE_CONFIG_OVERRIDE_H $as_default
xargs -P "${JOBS:-2}" -L 1 ${CLANG:-clang} $(emcc --cflags) ${OPT:--Os} -w "-I$include" < "$folder/commands"
rm -f "$folder/libdeps.a"
emar rcs "$folder/libdeps.a" "$folder"/obj/*.o
