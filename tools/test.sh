#!/bin/sh
# Installs what the tests need, builds, and runs all tests. Some of them also run in a Clang build with sanitizers. The last line is `N
# passed, N failed, N skipped`.
set -u
cd "$(dirname "$0")/.."
. tools/packages.sh

# Clang's sanitizers are in a separate package for each version.
install_clang() {
  install_packages clang && install_packages "libclang-rt-$(clang -dumpversion | cut -d . -f 1)-dev"
}

if install_packages $BUILD_PACKAGES $TEST_PACKAGES && install_clang && install_extra_packages $EXTRA_PACKAGES &&
  make -j"$(nproc)" test-programs && make -j"$(nproc)" test-programs-clang &&
  make -j"$(nproc)" test-programs-threads; then
  BUILD=build SANITIZED=build-clang sh tests/run_all.sh
else
  echo "the tests could not be built"
  echo "0 passed, 1 failed, 0 skipped"
  exit 1
fi
