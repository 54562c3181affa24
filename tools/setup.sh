#!/bin/sh
# Sets up a Debian 12 machine: installs what cag needs, builds it, and renders the vase to vase.png.
set -eu
cd "$(dirname "$0")/.."
. tools/packages.sh
install_packages $BUILD_PACKAGES
make -j"$(nproc)"
build/cag render examples/vase.cag -o vase.png
echo "built build/cag and rendered vase.png"
