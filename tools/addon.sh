#!/usr/bin/env bash
# Packs the Blender add-on: build/alcove_blender.zip, for Edit > Preferences > Add-ons > Install.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build
rm -f build/alcove_blender.zip
cmake -E chdir blender cmake -E tar cf ../build/alcove_blender.zip --format=zip alcove_ao/__init__.py alcove_ao/backend.py \
    alcove_ao/operator.py alcove_ao/preview.py
echo "build/alcove_blender.zip"
