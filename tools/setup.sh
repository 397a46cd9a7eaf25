#!/usr/bin/env bash
# Installs the Debian packages that building and testing need, and unpacks the real meshes of the demo and the tests
# into build/meshes. Does nothing if everything is present.
#
#     tools/setup.sh [PACKAGE...]    # installs these packages too
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
    g++ cmake ninja-build clang-format clang-tidy ccache shellcheck python3
    libopenvdb-dev libboost-dev libboost-iostreams-dev libopenmesh-dev libtbb-dev libhwy-dev libglm-dev
    libnanovdb-dev libopenexr-dev libpng-dev libjpeg-dev zlib1g-dev libfast-float-dev libfmt-dev libcli11-dev nlohmann-json3-dev libembree-dev libmeshoptimizer-dev libdraco-dev
    libeigen3-dev libnanoflann-dev libtomlplusplus-dev libgtest-dev libbenchmark-dev pybind11-dev python3-dev python3-numpy
    "$@"
)

missing=()
for package in "${packages[@]}"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ] && [ -d build/meshes ]; then
    exit 0
fi

if ! command -v apt-get >/dev/null; then
    echo "setup.sh: apt-get not found; install these Debian 12 packages: ${missing[*]} libcgal-demo" >&2
    exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup.sh: run as root or install sudo, to install these packages: ${missing[*]} libcgal-demo" >&2
        exit 1
    fi
    as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
if [ ${#missing[@]} -gt 0 ]; then
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "${missing[@]}"
fi

# The meshes are part of the documentation of CGAL's demos. The package is unpacked rather than installed, because some
# systems do not install documentation.
if [ ! -d build/meshes ]; then
    mkdir -p build
    scratch=$(mktemp -d "$PWD/build/unpacking.XXXXXX")
    trap 'rm -rf "$scratch"' EXIT
    (cd "$scratch" && apt-get download -q -o APT::Sandbox::User=root libcgal-demo &&
        dpkg-deb -x libcgal-demo_*.deb . && tar -xzf usr/share/doc/libcgal-dev/data.tar.gz)
    mv "$scratch/data" build/meshes
fi
