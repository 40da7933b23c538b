"""`pip install .`: builds the Python module with CMake, from the same sources and for this Python.

It needs what the program needs to build (the list in ./dev) and pybind11. HYDRODIP_BUILD_DIR names a
configured build to take it from instead.
"""

import os
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = os.path.dirname(os.path.abspath(__file__))


def version():
    for name, pattern in (
        ("CMakeLists.txt", r"project\(hydrodip VERSION ([0-9.]+)"),
        (os.path.join("cmake", "version.cmake"), r"HYDRODIP_NUMBER ([0-9.]+)"),
    ):
        file = os.path.join(HERE, name)
        if os.path.exists(file):
            with open(file, encoding="utf-8") as text:
                found = re.search(pattern, text.read())
            if found:
                return found.group(1)
    raise SystemExit("the version stands neither in CMakeLists.txt nor in cmake/version.cmake")


def has_tools_for_the_viewer():
    return all(shutil.which(tool) for tool in ("node", "npm", "esbuild"))


class CMakeBuild(build_ext):
    def run(self):
        build = os.environ.get("HYDRODIP_BUILD_DIR")
        if not build:
            build = os.path.join(HERE, "build", "pip")
            options = {
                "CMAKE_BUILD_TYPE": "Release",
                "HYDRODIP_TESTS": "OFF",
                "HYDRODIP_PYTHON_EXECUTABLE": sys.executable,
                "HYDRODIP_VIEWER": "ON" if has_tools_for_the_viewer() else "OFF",
                "HYDRODIP_NPM_DIR": os.path.join(HERE, "build", "npm"),
            }
            subprocess.run(
                ["cmake", "-S", HERE, "-B", build, "-G", "Ninja"] + [f"-D{k}={v}" for k, v in options.items()],
                check=True)
        subprocess.run(
            ["cmake", "--build", build, "--parallel", str(os.cpu_count()), "--target", "hydrodip_python_package"],
            check=True)
        target = os.path.join(HERE if self.inplace else self.build_lib, "hydrodip")
        shutil.copytree(
            os.path.join(build, "python", "hydrodip"), target, dirs_exist_ok=True,
            ignore=shutil.ignore_patterns("__pycache__"))

    def get_outputs(self):
        return []


setup(
    version=version(),
    packages=[],
    py_modules=[],
    ext_modules=[Extension("hydrodip._core", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
)
