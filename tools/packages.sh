# The Debian packages that cag needs, and their installation; read by setup.sh and test.sh.

BUILD_PACKAGES="gcc libc6-dev make pkg-config libopenexr-dev liblapacke-dev libopenblas-dev libedit-dev libcjson-dev
  libpng-dev libutf8proc-dev libglu1-mesa-dev zlib1g-dev libcmark-gfm-dev libcmark-gfm-extensions-dev libxml2-dev povray povray-includes"
TEST_PACKAGES="munge slurm-client slurmctld slurmd libcmocka-dev clang-format tmux zsh mandoc groff-base vim dpkg-dev lintian libxml2-utils occt-draw admesh assimp-utils unzip liburdfdom-tools"
# The Khronos validator of glTF runs on these; where they came from elsewhere, Debian's would be in their way.
command -v node > /dev/null 2>&1 || TEST_PACKAGES="$TEST_PACKAGES nodejs"
command -v npm > /dev/null 2>&1 || TEST_PACKAGES="$TEST_PACKAGES npm"

# Installs those of the packages that are not here; as root, or with sudo.
install_packages() {
  missing=
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0
  echo "installing$missing"
  as_root=
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  $as_root apt-get update -q
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
}
