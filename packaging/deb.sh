#!/bin/sh
# Builds the Debian packages of a build that is there, in $BUILD/deb: cag (the program with all that belongs to it), cag-brep (if Open
# CASCADE was there for the build), libcag0 and libcag-dev. What they depend on is found by dpkg-shlibdeps. It needs dpkg-dev, and no rights of root.
#   BUILD=build VERSION=0.1.0 sh packaging/deb.sh
set -eu
cd "$(dirname "$0")/.."
here=$PWD/packaging
case $BUILD in /*) ;; *) BUILD=$PWD/$BUILD ;; esac
command -v dpkg-shlibdeps > /dev/null || { echo "make deb requires dpkg-dev: apt-get install dpkg-dev" >&2; exit 1; }
umask 022
out=$BUILD/deb
architecture=$(dpkg-architecture -qDEB_HOST_ARCH)
triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH)
version=$(dpkg-parsechangelog -l "$here/changelog" -S Version)
[ "${version%-*}" = "$VERSION" ] || { echo "packaging/changelog has version ${version%-*}, but the program has version $VERSION" >&2; exit 1; }
SOURCE_DATE_EPOCH=$(dpkg-parsechangelog -l "$here/changelog" -S Timestamp)
export SOURCE_DATE_EPOCH
maintainer=${DEBFULLNAME:-$(dpkg-parsechangelog -l "$here/changelog" -S Maintainer | sed 's/ <.*//')}
address=${DEBEMAIL:-$(dpkg-parsechangelog -l "$here/changelog" -S Maintainer | sed 's/.*<\(.*\)>/\1/')}
rm -rf "$out"
mkdir -p "$out/work/debian"

# Everything is installed once, and each package takes its part.
all=$out/work/all
make -s install BUILD="$BUILD" PREFIX=/usr LIBDIR="lib/$triplet" DESTDIR="$all"

# take PACKAGE PATH ...: moves what is below /usr from the installation into a package.
take() {
  package=$1
  shift
  for path; do
    mkdir -p "$out/work/$package/usr/$(dirname "$path")"
    mv "$all/usr/$path" "$out/work/$package/usr/$path"
  done
}
take libcag0 "lib/$triplet/libcag.so.$VERSION" "lib/$triplet/libcag.so.0"
take libcag-dev "lib/$triplet/libcag.so" "lib/$triplet/libcag.a" "lib/$triplet/pkgconfig/libcag.pc" include/cag.h
packages='cag libcag0 libcag-dev'
if [ -e "$all/usr/lib/cag/cag-brep" ]; then
  packages="$packages cag-brep"
  take cag-brep lib/cag/cag-brep lib/cag/cag-brep-exchange.so lib/cag/cag-brep-operations.so
fi
take cag bin share
find "$all" ! -type d > "$out/work/left"
[ ! -s "$out/work/left" ] || { echo "these files belong to no package:" >&2; cat "$out/work/left" >&2; exit 1; }

# As Debian has it: zsh looks into vendor-completions, pages are compressed, nothing has symbols of a debugger.
share=$out/work/cag/usr/share
mv "$share/zsh/site-functions" "$share/zsh/vendor-completions"
find "$share/man" -type f -exec gzip -9n {} +
strip --strip-unneeded --remove-section=.comment --remove-section=.note "$out/work/cag/usr/bin/cag" "$out/work/libcag0/usr/lib/$triplet/libcag.so.$VERSION"
chmod 644 "$out/work/libcag0/usr/lib/$triplet/libcag.so.$VERSION"
strip --strip-debug --enable-deterministic-archives "$out/work/libcag-dev/usr/lib/$triplet/libcag.a"
[ ! -d "$out/work/cag-brep" ] || strip --strip-unneeded --remove-section=.comment --remove-section=.note "$out/work/cag-brep/usr/lib/cag/"cag-brep*
for package in $packages; do
  documents=$out/work/$package/usr/share/doc/$package
  mkdir -p "$documents"
  cp "$here/copyright" "$documents/copyright"
  gzip -9nc "$here/changelog" > "$documents/changelog.Debian.gz"
done

# What the packages depend on. dpkg-shlibdeps wants a folder debian/ with a control file.
{
  printf 'Source: cag\n\n'
  cat "$here/control"
} > "$out/work/debian/control"
libraries() { (cd "$out/work" && dpkg-shlibdeps -O "$@" 2> shlibdeps.log | sed -n 's/^shlibs:Depends=//p') || { cat "$out/work/shlibdeps.log" >&2; exit 1; }; }
developers=$(sed -n '/^NEEDS/,/[^\\]$/p' Makefile | tr ' ' '\n' | sed -n 's/^[^:]*:\(lib.*-dev\|[a-z0-9]*-dev\)$/\1/p' | sort | sed -n 'H; ${x; s/^\n//; s/\n/, /g; p}')

# write_control PACKAGE LIBRARIES: its paragraph of packaging/control with what is known now.
write_control() {
  folder=$out/work/$1
  mkdir -p "$folder/DEBIAN"
  awk -v package="$1" -v version="$version" -v maintainer="$maintainer <$address>" -v architecture="$architecture" -v libraries="$2" \
    -v developers="$developers" -v size="$(du -sk --exclude=DEBIAN "$folder" | cut -f1)" '
    BEGIN { RS = ""; FS = "\n" }
    $1 == "Package: " package {
      gsub(/\$\{shlibs:Depends\}/, libraries); gsub(/\$\{version\}/, version); gsub(/\$\{devs:Depends\}/, developers)
      sub(/Architecture: any/, "Architecture: " architecture)
      print $1 "\nSource: cag\nVersion: " version "\nMaintainer: " maintainer "\nInstalled-Size: " size "\nPriority: optional"
      for (i = 2; i <= NF; i++) print $i
    }' "$here/control" | sed "s/^Source: cag\$/$([ "$1" = cag ] && echo '@' || echo 'Source: cag')/" | grep -v '^@$' > "$folder/DEBIAN/control"
  (cd "$folder" && find . -type f ! -path './DEBIAN/*' -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' md5sum) > "$folder/DEBIAN/md5sums"
}
write_control cag "$(libraries "$out/work/cag/usr/bin/cag")"
write_control libcag0 "$(libraries "$out/work/libcag0/usr/lib/$triplet/libcag.so.$VERSION")"
write_control libcag-dev ''
[ ! -d "$out/work/cag-brep" ] || write_control cag-brep "$(libraries "$out/work/cag-brep/usr/lib/cag/"cag-brep*)"
echo "libcag 0 libcag0 (>= $VERSION)" > "$out/work/libcag0/DEBIAN/shlibs"
echo 'activate-noawait ldconfig' > "$out/work/libcag0/DEBIAN/triggers"

for package in $packages; do
  find "$out/work/$package" -type d -exec chmod 755 {} +
  dpkg-deb --root-owner-group -Zxz --build "$out/work/$package" "$out/${package}_${version}_$architecture.deb" > /dev/null
  echo "$out/${package}_${version}_$architecture.deb"
done
rm -rf "$out/work"
