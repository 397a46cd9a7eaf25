"""Builds and installs the Python module, with the libraries of Alcove inside: see docs/install.md."""
import re
import sys
from pathlib import Path

from skbuild import setup

version = re.search(r"project\(alcove VERSION ([0-9.]+)", Path("CMakeLists.txt").read_text()).group(1)
setup(
    name="alcove",
    version=version,
    description="Ambient occlusion on sparse signed-distance grids",
    license="MIT",
    packages=["alcove"],
    package_dir={"": "python"},
    package_data={"alcove": ["__init__.pyi", "py.typed"]},
    python_requires=">=3.9",
    install_requires=["numpy"],
    cmake_args=["-DPython_EXECUTABLE=" + sys.executable],
)
