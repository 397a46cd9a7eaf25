"""Builds and installs the Python module: pip install --no-build-isolation ."""
from skbuild import setup

setup(
    name="alcove",
    version="0.2.0",
    description="Ambient occlusion on sparse signed-distance grids",
    license="MIT",
    packages=["alcove"],
    package_dir={"": "python"},
    package_data={"alcove": ["py.typed", "__init__.pyi"]},
    python_requires=">=3.9",
    install_requires=["numpy"],
    cmake_args=["-DALCOVE_TESTS=OFF", "-DALCOVE_BENCH=OFF", "-DALCOVE_FIT=OFF", "-DBUILD_SHARED_LIBS=OFF",
                "-DALCOVE_PYTHON=ON", "-DALCOVE_PYTHON_DIR=python"],
    cmake_install_target="alcove_python_install",
)
