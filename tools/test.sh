#!/bin/sh
# Runs all tests, after installing what they need and building; a part of them also in a build by Clang with sanitizers. The last line is
# `N passed, N failed, N skipped`.
set -u
cd "$(dirname "$0")/.."
. tools/packages.sh

# Clang's sanitizers come in a package of its version.
install_clang() {
  install_packages clang && install_packages "libclang-rt-$(clang -dumpversion | cut -d . -f 1)-dev"
}

if install_packages $BUILD_PACKAGES $TEST_PACKAGES && install_clang && install_extra_packages $EXTRA_PACKAGES &&
  make -j"$(nproc)" test-programs && make -j"$(nproc)" test-programs-clang; then
  BUILD=build SANITIZED=build-clang sh tests/run_all.sh
else
  echo "the tests could not be built"
  echo "0 passed, 1 failed, 0 skipped"
  exit 1
fi
