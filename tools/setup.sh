#!/usr/bin/env bash
# Installs what building and testing take, from Debian's packages, and unpacks the real meshes of the demo and the
# tests into build/meshes. Does nothing where all of it is there.
#
#     tools/setup.sh [PACKAGE...]    # these as well
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(
    g++ cmake ninja-build clang-format clang-tidy ccache shellcheck python3
    libopenvdb-dev libboost-dev libboost-iostreams-dev libopenmesh-dev libtbb-dev libhwy-dev libglm-dev
    libnanovdb-dev libopenexr-dev libpng-dev zlib1g-dev libfast-float-dev libfmt-dev libcli11-dev nlohmann-json3-dev libembree-dev
    libeigen3-dev libtomlplusplus-dev libgtest-dev libbenchmark-dev
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
    echo "setup.sh: no apt-get here; these Debian 12 packages are needed: ${missing[*]} libcgal-demo" >&2
    exit 1
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "setup.sh: run it as root, or install sudo, to get these packages: ${missing[*]} libcgal-demo" >&2
        exit 1
    fi
    as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
if [ ${#missing[@]} -gt 0 ]; then
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "${missing[@]}"
fi

# The meshes come inside the documentation of CGAL's demos. It is unpacked, not installed: some systems leave
# documentation out of what they install.
if [ ! -d build/meshes ]; then
    mkdir -p build
    scratch=$(mktemp -d "$PWD/build/unpacking.XXXXXX")
    trap 'rm -rf "$scratch"' EXIT
    (cd "$scratch" && apt-get download -q -o APT::Sandbox::User=root libcgal-demo &&
        dpkg-deb -x libcgal-demo_*.deb . && tar -xzf usr/share/doc/libcgal-dev/data.tar.gz)
    mv "$scratch/data" build/meshes
fi
