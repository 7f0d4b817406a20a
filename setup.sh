#!/bin/sh
# Installs the Debian packages that Hindsight is built from, by sets:
#   ./setup.sh          what building and running the program needs
#   ./setup.sh tests    that, and what the tests, fuzzers and benchmarks need
#   ./setup.sh docs     that, and what makes the figures of the documentation
#   ./setup.sh cluster  what tests campaigns by GNU parallel and a Slurm of one node
#   ./setup.sh all      every set
# Safe to run again: only what is missing is installed.
set -eu

build="build-essential cmake ninja-build ccache
  libeigen3-dev libceres-dev libsuitesparse-dev libgeographiclib-dev
  libfmt-dev libgflags-dev libgoogle-glog-dev libyaml-cpp-dev nlohmann-json3-dev
  libtbb-dev zlib1g-dev libbz2-dev liblz4-dev libarchive-dev libssl-dev libfast-float-dev libpugixml-dev libboost-dev pkg-config
  libjs-dygraphs"
tests="libgtest-dev libgmock-dev libbenchmark-dev locales
  clang-format clang-tidy clang libclang-rt-dev
  chromium chromium-driver python3-selenium python3-numpy
  nodejs eslint node-css-tree"
docs="gcovr"
cluster="parallel munge slurmctld slurmd slurm-client"

fail() {
  echo "setup.sh: $*" >&2
  exit 1
}

packages=$build
for set in "$@"; do
  case "$set" in
    build) ;;
    tests) packages="$packages $tests" ;;
    docs) packages="$packages $tests $docs" ;;
    cluster) packages="$packages $cluster" ;;
    all) packages="$build $tests $docs $cluster" ;;
    *)
      echo "setup.sh: '$set' is no set; expected build, tests, docs, cluster or all" >&2
      exit 2
      ;;
  esac
done

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  fail "this system has no apt-get; Hindsight is set up on Debian 12 or newer." \
    "Elsewhere install the equivalents of:" $packages
fi

missing=""
for package in $packages; do
  case " $missing " in *" $package "*) continue ;; esac
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing="$missing $package"
done

if [ -z "$missing" ]; then
  echo "setup.sh: everything is installed"
else
  as_root=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      fail "not root and no sudo; as root run: apt-get install$missing"
    as_root="sudo"
  fi
  echo "setup.sh: installing$missing"
  $as_root apt-get update -qq || fail "apt-get update failed (network?)"
  $as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends $missing ||
    fail "apt-get could not install$missing"
fi

version=$(cmake --version | sed -n '1s/[^0-9]*\([0-9]*\.[0-9]*\).*/\1/p')
case "$version" in
  [012].* | 3.? | 3.1? | 3.2[0-4])
    fail "CMake $version is too old; Hindsight needs 3.25 (Debian 12 has it)" ;;
esac
