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
  share/cag/editors/vscode/package.json share/cag/editors/vscode/syntaxes/cag.tmLanguage.json share/cag/editors/vscode/extension.js \
  share/cag/editors/neovim/plugin/cag_lsp.lua share/cag/editors/emacs/cag-mode.el; do
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

it 'the static library has only names that begin with cag_'
nm -g --defined-only "$prefix/lib/libcag.a" 2> /dev/null | awk 'NF == 3 { print $3 }' | grep -v '^cag_' | grep -v -e '^_' -e asan -e ubsan > others
[ ! -s others ] || wrong "it also has $(head -n 3 others | tr '\n' ' ')"

# The folders in the file are those of PREFIX, where it will be used. Here, they are below DESTDIR.
PKG_CONFIG_PATH=$prefix/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR
flags="--define-variable=prefix=$prefix"
sanitize=
if nm "$BUILD/libcag.a" 2> /dev/null | grep -q __asan_init; then sanitize=-fsanitize=address,undefined; fi

it 'the pkg-config file knows the version'
[ "cag $(pkg-config --modversion libcag)" = "$("$CAG" --version)" ] || wrong 'the versions differ'
[ "$(pkg-config --variable=prefix libcag)" = /opt/cag ] || wrong 'the prefix is not that of make install'

# builds OUTPUT LINK LANGUAGE COMPILER SOURCE: a client against the shared or the static library, without warnings.
builds() {
  case $3 in c) standard=c17 ;; c++) standard=c++17 ;; esac
  libraries=$(pkg-config $flags --libs libcag)
  [ "$2" = shared ] || libraries=$(pkg-config $flags --static --libs libcag | sed 's/-lcag/-l:libcag.a/')
  try_command "$4" -x "$3" -std=$standard -Wall -Wextra -Werror $sanitize $(pkg-config $flags --cflags libcag) "$5" -x none $libraries -o "$1"
  status 0
}

# The program tests/cli/embed.c with its output, and the files that it writes.
embeds() {
  rm -f vase.obj vase.mtl vase.png
  ran="$1 200" code=0
  LD_LIBRARY_PATH=$prefix/lib "./$1" 200 > out 2> err || code=$?
  status 0
  [ "$(sed -n 1,2p out)" = "$(printf 'height 200\n2 items, 3 lights, camera `automatic`')" ] || wrong 'it prints something else'
  exists vase.obj
  exists vase.mtl
  if command -v povray > /dev/null; then exists vase.png; fi
}

for language in c c++; do
  it "a client in $language builds against the shared library and works"
  case $language in c) compiler=cc ;; c++) compiler=c++ ;; esac
  if needs $compiler; then
    builds "embed_$language" shared $language $compiler "$root/tests/cli/embed.c"
    embeds "embed_$language"
  fi

  it "a client in $language builds against the static library and works"
  if needs $compiler; then
    builds "embed_static_$language" static $language $compiler "$root/tests/cli/embed.c"
    embeds "embed_static_$language"
  fi
done

it 'a client builds with Clang'
if needs clang && needs clang++; then
  try_command clang -std=c17 -Wall -Wextra -Werror $(pkg-config $flags --cflags libcag) -c "$root/tests/cli/embed.c" -o clang.o
  status 0
  try_command clang++ -x c++ -std=c++17 -Wall -Wextra -Werror $(pkg-config $flags --cflags libcag) -c "$root/tests/cli/embed.c" -o clang.o
  status 0
fi

it 'cag.h compiles as C99 and as C++11'
echo '#include <cag.h>' > include.c
try_command cc -std=c99 -pedantic -Wall -Wextra -Werror $(pkg-config $flags --cflags libcag) -fsyntax-only include.c
status 0
if needs c++; then
  try_command c++ -x c++ -std=c++11 -pedantic -Wall -Wextra -Werror $(pkg-config $flags --cflags libcag) -fsyntax-only include.c
  status 0
fi

it 'a client is told what is wrong'
# client_fails ARGUMENT STATUS LINE: the client fails, and prints this line.
client_fails() {
  ran="embed_static_c $1" code=0
  ./embed_static_c "$1" > out 2> err || code=$?
  status "$2"
  grep -qFx -e "$3" err || wrong "it does not print: $3"
}
client_fails tall 1 'error E0201: unknown name `tall`'
client_fails 20 1 '  in vase.cag, line 1, column 7'
client_fails 'len([for i in 0..<1e9: i])' 5 'error E0602: exceeded the memory limit of 64 MiB (--max-memory)'

it 'a client interrupts a run'
ran='embed_static_c, interrupted' code=0
./embed_static_c 'reduce(0..<1e12, 0, (a, b) => a + b)' > out 2> err &
client=$!
# The run is in a second thread.
while kill -0 $client && [ "$(ls /proc/$client/task | wc -l)" -lt 2 ]; do sleep 0.1; done
kill -INT $client
wait $client || code=$?
status 130
grep -q '^error E[0-9]*: interrupted$' err || wrong 'it does not say that it was interrupted'

# The examples of the documentation are complete programs, or the body of `main`.
it 'the example in cag.h compiles and works'
{
  printf '#include <cag.h>\nint main(void) {\n'
  sed -n '1,/^#ifndef/s|^//     ||p' "$root/include/cag.h"
  echo '}'
} > header.c
echo 'show revolve(line([9, 0], [5, 20]))' > vase.cag
rm -f vase.stl
builds header shared c cc header.c
ran=header code=0
LD_LIBRARY_PATH=$prefix/lib ./header > out 2> err || code=$?
status 0
exists vase.stl
if needs c++; then builds header_cxx shared c++ c++ header.c; fi

it 'the example in the README compiles and works'
awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' "$root/README.md" > readme.c
rm -f vase.stl
builds readme shared c cc readme.c
ran=readme code=0
LD_LIBRARY_PATH=$prefix/lib ./readme > out 2> err || code=$?
status 0
prints_exactly 'height 200'
exists vase.stl
if needs c++; then builds readme_cxx shared c++ c++ readme.c; fi

it 'cag.h lists the formats that there are'
formats=$("$CAG" export --help | sed -n '/^Formats:/,$s/^  \([a-z0-9]*\) .*/"\1"/p')
[ -n "$formats" ] || wrong 'no formats are listed'
sed -n '/^\/\/ Writes the scene to a file/,/^CAG_API/p' "$root/include/cag.h" > comment
[ "$(grep -o '"[a-z0-9]*"' comment | sort)" = "$(echo "$formats" | sort)" ] || wrong 'the comment on cag_session_export lists others'

it 'docs/embedding.md shows the client as it is'
awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' "$root/docs/embedding.md" > shown.c
cmp -s shown.c "$root/tests/cli/embed.c" || wrong 'docs/embedding.md and tests/cli/embed.c differ'

# --- Completion ---

mkdir -p files/parts
: > files/a.cag
: > 'files/b c.cag'
: > files/x.exr
: > files/y.png
cd files || exit 1

# proposes LINE WORDS: the proposals of the shell after a line, joined by spaces.
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
  grep -q "^.fBcag.-$command.fP(1)" "$prefix/share/man/man1/cag.1" || wrong "cag.1 does not name cag-$command"
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

helper=
it 'the Debian packages hold the installation and say what they depend on'
if [ -n "$sanitize" ]; then
  skip 'this is a build with sanitizers'
elif needs dpkg-shlibdeps; then
  ran='make deb'
  env -u MAKEFLAGS -u MAKELEVEL make -s -o all -C "$root" deb BUILD="$BUILD" > out 2> err
  code=$?
  status 0
  [ ! -x "$BUILD/cag-brep" ] || helper=cag-brep
  for package in cag libcag0 libcag-dev $helper; do
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
  for file in $helper ${helper:+$helper-exchange.so $helper-operations.so}; do
    grep -q "usr/lib/cag/$file\$" cag-brep.list || wrong "cag-brep lacks $file"
  done
  [ -z "$helper" ] || grep '^ Depends:' cag-brep.info | grep -q libocct-data-exchange || wrong 'cag-brep does not depend on what its modules link'
  grep -q 'usr/include/cag.h$' libcag-dev.list || wrong 'libcag-dev lacks cag.h'
  ! awk '$2 != "root/root"' cag.list libcag0.list libcag-dev.list | grep -q . || wrong 'a file is not owned by root'
  if needs lintian; then
    try_command lintian --allow-root --tag-display-limit 0 "$BUILD"/deb/*.deb
    ! grep '^E:' out || wrong 'lintian finds errors'
  fi
fi
