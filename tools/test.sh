#!/bin/sh
# Runs all tests, after installing what they need and building. The last line is `N passed, N failed, N skipped`.
set -u
cd "$(dirname "$0")/.."
. tools/packages.sh
if install_packages $BUILD_PACKAGES $TEST_PACKAGES && install_extra_packages $EXTRA_PACKAGES && make -j"$(nproc)" test-programs; then
  BUILD=build sh tests/run_all.sh
else
  echo "the tests could not be built"
  echo "0 passed, 1 failed, 0 skipped"
  exit 1
fi
