# make install, and a client of the installed library.

it 'make install lays everything out below DESTDIR'
ran='make install'
env -u MAKEFLAGS -u MAKELEVEL make -s -o all -C "$root" install BUILD="$BUILD" PREFIX=/opt/cag DESTDIR="$PWD/dest" > out 2> err
code=$?
status 0
prefix=$PWD/dest/opt/cag
for file in bin/cag lib/libcag.a lib/libcag.so lib/libcag.so.0 lib/pkgconfig/libcag.pc include/cag.h share/man/man1/cag.1 \
  share/man/man1/cag-render.1 share/bash-completion/completions/cag; do
  exists "$prefix/$file"
done

it 'the installed program runs'
ran="$prefix/bin/cag" && "$prefix/bin/cag" eval '6 * 7' > out 2> err
code=$?
prints_exactly 42

it 'the shared library has only the names of cag.h'
nm -D --defined-only "$prefix/lib/libcag.so" | awk '{ print $3 }' | grep -v '^cag_' | grep -v -e '^_' -e asan -e ubsan > others
[ ! -s others ] || wrong "it also has $(head -n 3 others | tr '\n' ' ')"
for name in $(sed -n 's/^CAG_API.*[ *]\(cag_[a-z_]*\)(.*/\1/p' "$root/include/cag.h"); do
  nm -D --defined-only "$prefix/lib/libcag.so" | grep -q " $name\$" || wrong "it lacks $name"
done

# The folders of the file are those of PREFIX, where it will be used; here they are below DESTDIR.
PKG_CONFIG_PATH=$prefix/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR
flags="--define-variable=prefix=$prefix"
sanitize=
if nm "$BUILD/libcag.a" 2> /dev/null | grep -q __asan_init; then sanitize=-fsanitize=address,undefined; fi

it 'the pkg-config file knows the version'
[ "cag $(pkg-config --modversion libcag)" = "$("$CAG" --version)" ] || wrong 'the versions differ'
[ "$(pkg-config --variable=prefix libcag)" = /opt/cag ] || wrong 'the prefix is not that of make install'

it 'a client builds against the shared library and works'
try_command cc -std=c17 -Wall -Wextra -Werror $sanitize "$root/tests/cli/embed.c" $(pkg-config $flags --cflags --libs libcag) -o embed
status 0
LD_LIBRARY_PATH=$prefix/lib ./embed > out 2> err
code=$?
status 0
prints_exactly 'height 200'
exists vase.stl

it 'a client builds against the static library and works'
try_command cc -std=c17 -Wall -Wextra -Werror $sanitize "$root/tests/cli/embed.c" $(pkg-config $flags --cflags libcag) "$prefix/lib/libcag.a" \
  $(pkg-config $flags --static --libs-only-l libcag | sed 's/-lcag//') -o embed_static
status 0
rm -f vase.stl
try_command ./embed_static
status 0
exists vase.stl

it 'a client in C++ builds'
if command -v c++ > /dev/null; then
  printf '#include <cag.h>\nint main() { return cag_version() == nullptr; }\n' > client.cpp
  try_command c++ -Wall -Wextra -Werror $sanitize client.cpp $(pkg-config $flags --cflags --libs libcag) -o client
  status 0
fi

it 'the completion of bash is a script of bash'
if command -v bash > /dev/null; then
  try_command bash -n "$prefix/share/bash-completion/completions/cag"
  status 0
  grep -q -e '--quality' "$prefix/share/bash-completion/completions/cag" || wrong 'it lacks --quality'
fi

it 'the man pages have their sections'
for section in NAME SYNOPSIS EXAMPLES OPTIONS; do
  grep -q "^.SH $section" "$prefix/share/man/man1/cag-render.1" || wrong "cag-render.1 lacks $section"
done

it 'the README shows the example of the library as it is'
awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' "$root/README.md" > shown.c
sed '1,/^$/d' "$root/tests/cli/embed.c" > example.c
cmp -s shown.c example.c || wrong 'README.md and tests/cli/embed.c differ'
