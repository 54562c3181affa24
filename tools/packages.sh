# The Debian packages that cag needs, and their installation; sourced by setup.sh and test.sh.

# LAPACK uses Debian's reference BLAS. OpenBLAS starts threads in every process, which busy-wait longer than most scripts run.
BUILD_PACKAGES="gcc libc6-dev make pkg-config libopenexr-dev liblapacke-dev libedit-dev libcjson-dev
  libpng-dev libutf8proc-dev libglu1-mesa-dev zlib1g-dev libcmark-gfm-dev libcmark-gfm-extensions-dev libxml2-dev libmicrohttpd-dev
  libharfbuzz-dev libfribidi-dev libfontconfig-dev povray povray-includes"
# For cag-brep, the helper for exact boundaries of solids. Everything else is built without them.
BUILD_PACKAGES="$BUILD_PACKAGES g++ libocct-modeling-algorithms-dev libocct-data-exchange-dev"
TEST_PACKAGES="munge slurm-client slurmctld slurmd libcmocka-dev fonts-dejavu-core fonts-liberation fonts-urw-base35 clang-format clang-tidy tmux zsh mandoc groff-base vim vim-ale neovim strace dpkg-dev lintian libxml2-utils occt-draw admesh assimp-utils unzip liburdfdom-tools esbuild"
# Needed by the Khronos glTF validator. If they were installed from another source, Debian's packages would conflict with them.
command -v node > /dev/null 2>&1 || TEST_PACKAGES="$TEST_PACKAGES nodejs"
command -v npm > /dev/null 2>&1 || TEST_PACKAGES="$TEST_PACKAGES npm"
command -v python3 > /dev/null 2>&1 || TEST_PACKAGES="$TEST_PACKAGES python3"

# Tests that need these are skipped if they are not available. They are large, and nothing else needs them.
EXTRA_PACKAGES="chromium emscripten libeigen3-dev openscad"
# The time limit of their download in seconds.
EXTRA_SECONDS=240

# Installs the missing packages, as root or with sudo.
install_packages() {
  find_missing "$@"
  [ -n "$missing" ] || return 0
  echo "installing$missing"
  $as_root apt-get update -q
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
}

# The same for optional packages: those that cannot be downloaded in time are only reported.
install_extra_packages() {
  find_missing "$@"
  [ -n "$missing" ] || return 0
  echo "installing$missing"
  $as_root timeout $EXTRA_SECONDS apt-get update -q
  $as_root timeout $EXTRA_SECONDS apt-get install -q -y --no-install-recommends --download-only $missing &&
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing ||
    echo "these could not be installed, and their tests are skipped:$missing"
}

# Sets `missing` to the packages that are not installed, and `as_root` to the prefix for root commands.
find_missing() {
  missing= as_root=
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
  done
}
