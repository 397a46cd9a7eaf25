#!/usr/bin/env bash
# Builds Debian packages in build-package: alcove (program), libalcove0.2, libalcove-dev, python3-alcove,
# alcove-blender, and a source tarball. Checks them with lintian, and lists the licences of everything that is linked.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/setup.sh dpkg-dev help2man lintian
cmake -S . -B build-package -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DALCOVE_PACKAGES=ON \
    -DALCOVE_TESTS=OFF -DALCOVE_BENCH=OFF -DALCOVE_FIT=OFF -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
cmake --build build-package
rm -f build-package/*.deb
(cd build-package && cpack -G DEB && cpack --config CPackSourceConfig.cmake)
ls build-package/*.deb build-package/*.tar.gz
lintian --fail-on error build-package/*.deb
echo "Licences of what is linked:"
for library in $(ldd build-package/alcove | grep -oE '/[^ ]+'); do
    package=$(dpkg -S "$(realpath "$library")" 2>/dev/null | head -1 | cut -d: -f1 || true)
    [ -n "$package" ] || continue
    licence=$(grep -hE '^License:' "/usr/share/doc/$package/copyright" 2>/dev/null | sed 's/License: *//' | sort -u | paste -sd, - || true)
    echo "    $package: ${licence:-see /usr/share/doc/$package/copyright}"
done | sort -u
