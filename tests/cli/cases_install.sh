# make install, and a client of the installed library.

it 'make install lays everything out below DESTDIR'
ran='make install'
env -u MAKEFLAGS -u MAKELEVEL make -s -o all -C "$root" install BUILD="$BUILD" PREFIX=/opt/cag DESTDIR="$PWD/dest" > out 2> err
code=$?
status 0
prefix=$PWD/dest/opt/cag
for file in bin/cag lib/libcag.a lib/libcag.so lib/libcag.so.0 lib/pkgconfig/libcag.pc include/cag.h share/man/man1/cag.1 \
  share/man/man1/cag-render.1 share/man/man7/cag-language.7 share/bash-completion/completions/cag \
  share/zsh/site-functions/_cag share/doc/cag/README.md share/doc/cag/examples/vase.cag share/doc/cag/examples/vase.png \
  share/doc/cag/docs/architecture.md share/vim/vimfiles/syntax/cag.vim share/vim/vimfiles/ftdetect/cag.vim \
  share/cag/editors/vscode/package.json share/cag/editors/vscode/syntaxes/cag.tmLanguage.json; do
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
if needs c++; then
  printf '#include <cag.h>\nint main() { return cag_version() == nullptr; }\n' > client.cpp
  try_command c++ -Wall -Wextra -Werror $sanitize client.cpp $(pkg-config $flags --cflags --libs libcag) -o client
  status 0
fi

# --- Completion ---

mkdir -p files/parts
: > files/a.cag
: > 'files/b c.cag'
: > files/x.exr
: > files/y.png
cd files || exit 1

# proposes LINE WORDS: what the shell proposes behind a line, joined by spaces.
proposes() {
  ran="$shell: $1"
  [ "$2" = "$(paste -sd' ' out)" ] || wrong "expected $2, got $(paste -sd' ' out)"
}
bash_proposes() {
  shell=bash
  line=$1 expected=$2
  shift 2
  bash "$root/tests/cli/shells/ask.bash" "$prefix/share/bash-completion/completions/cag" "$@" > out 2> err
  code=$?
  status 0
  says_nothing
  proposes "$line" "$expected"
}
it 'bash completes commands, options, their values, and files by their endings'
if needs bash; then
  bash_proposes 'cag ren' render cag ren
  bash_proposes 'cag run ' 'a.cag b c.cag parts' cag run ''
  bash_proposes 'cag render a.cag --qu' '--quality' cag render a.cag --qu
  bash_proposes 'cag render --quality ' 'draft final normal' cag render --quality ''
  bash_proposes 'cag render --format ' 'exr png' cag render --format ''
  bash_proposes 'cag export --format=g' 'glb gltf' cag export --format = g
  bash_proposes 'cag compare ' 'parts x.exr y.png' cag compare ''
  bash_proposes 'cag run -I ' 'parts' cag run -I ''
  bash_proposes 'cag explain E015' "$("$CAG" explain | sed -n 's/^ *\(E015[0-9]\).*/\1/p' | sort | paste -sd' ')" cag explain E015
  bash_proposes 'cag doc bspl' 'bspline bspline_surface' cag doc bspl
  bash_proposes 'cag fmt --d' '--diagnostics --diff' cag fmt --d
fi

zsh_proposes() {
  shell=zsh
  timeout 60 zsh -f "$root/tests/cli/shells/ask.zsh" "$prefix/share/zsh/site-functions" "$1" > out 2> err
  code=$?
  status 0
  says_nothing
  proposes "$1" "$2"
}
it 'zsh completes commands, options, their values, and files by their endings'
if needs zsh; then
  zsh_proposes 'cag ren' render
  zsh_proposes 'cag run ' 'a.cag b\ c.cag parts'
  zsh_proposes 'cag render a.cag --qu' '--quality'
  zsh_proposes 'cag render --quality ' 'draft final normal'
  zsh_proposes 'cag export --format=g' 'glb gltf'
  zsh_proposes 'cag compare ' 'parts x.exr y.png'
  zsh_proposes 'cag doc bspl' 'bspline bspline_surface'
fi
cd ..

# --- Man pages ---

it 'there is a man page for each command, with its sections'
for command in $("$CAG" --help | sed -n '/^Commands:/,/^$/s/^  \([a-z]\{1,\}\).*/\1/p'); do
  exists "$prefix/share/man/man1/cag-$command.1"
  grep -q "^\\.BR cag.-$command (1)" "$prefix/share/man/man1/cag.1" || wrong "cag.1 does not name cag-$command"
done
for section in NAME SYNOPSIS DESCRIPTION EXAMPLES OPTIONS 'EXIT STATUS' 'SEE ALSO'; do
  grep -q "^.SH $section" "$prefix/share/man/man1/cag-render.1" || wrong "cag-render.1 lacks $section"
done
grep -q ':render' "$prefix/share/man/man1/cag-repl.1" || wrong 'cag-repl.1 lacks the commands of the REPL'
grep -q 'bspline' "$prefix/share/man/man7/cag-language.7" || wrong 'cag-language.7 lacks the built-in names'

it 'mandoc has nothing to say about the man pages'
if needs mandoc; then
  for page in "$prefix"/share/man/man?/*; do
    try_command mandoc -Tlint -W warning "$page"
    [ ! -s out ] || wrong 'mandoc has something to say'
  done
fi

it 'groff sets the man pages without warnings'
if needs groff; then
  for page in "$prefix"/share/man/man?/*; do
    try_command groff -ww -man -Tutf8 -K utf8 "$page"
    says_nothing
  done
fi

# --- The Debian packages ---

it 'the Debian packages hold the installation and say what they depend on'
if [ -n "$sanitize" ]; then
  skip 'this is a build with sanitizers'
elif needs dpkg-shlibdeps; then
  ran='make deb'
  env -u MAKEFLAGS -u MAKELEVEL make -s -o all -C "$root" deb BUILD="$BUILD" > out 2> err
  code=$?
  status 0
  for package in cag libcag0 libcag-dev; do
    deb=$(echo "$BUILD/deb/${package}"_*.deb)
    exists "$deb"
    dpkg-deb -I "$deb" > "$package.info" && dpkg-deb -c "$deb" > "$package.list" || wrong "dpkg-deb cannot read $deb"
  done
  for library in libc6 libopenexr libedit2 liblapacke libpng16 libutf8proc; do
    grep '^ Depends:' cag.info | grep -q "$library" || wrong "cag does not depend on $library"
  done
  grep -q '^ Recommends:.*povray' cag.info || wrong 'cag does not recommend povray'
  grep -q '^ Depends: libcag0 (= .*libopenexr-dev' libcag-dev.info || wrong 'libcag-dev does not depend on what is linked'
  for file in usr/bin/cag usr/share/man/man1/cag.1.gz usr/share/man/man7/cag-language.7.gz usr/share/bash-completion/completions/cag \
    usr/share/zsh/vendor-completions/_cag usr/share/doc/cag/copyright usr/share/doc/cag/examples/vase.cag usr/share/vim/vimfiles/syntax/cag.vim; do
    grep -q " ./$file\$" cag.list || wrong "cag lacks $file"
  done
  grep -q 'libcag.so.0 -> ' libcag0.list || wrong 'libcag0 lacks libcag.so.0'
  grep -q 'usr/include/cag.h$' libcag-dev.list || wrong 'libcag-dev lacks cag.h'
  ! awk '$2 != "root/root"' cag.list libcag0.list libcag-dev.list | grep -q . || wrong 'a file is not owned by root'
  if needs lintian; then
    try_command lintian --allow-root --tag-display-limit 0 "$BUILD"/deb/*.deb
    ! grep '^E:' out || wrong 'lintian finds errors'
  fi
fi

it 'the README shows the example of the library as it is'
awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' "$root/README.md" > shown.c
sed '1,/^$/d' "$root/tests/cli/embed.c" > example.c
cmp -s shown.c example.c || wrong 'README.md and tests/cli/embed.c differ'
