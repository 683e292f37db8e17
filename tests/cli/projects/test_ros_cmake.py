"""The texts of a new package that CMake builds."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from graphflow.cli.projects import ros_cmake
from tests.cases import slow

COMMAND = re.compile(r"\s*(?:#.*|\w+\((?:[^()]|\([^()]*\))*\))?\s*\n")


@pytest.mark.parametrize("node", [None, "one"])
@pytest.mark.parametrize("library", [None, "two"])
def test_the_lists_are_commands(node: str | None, library: str | None) -> None:
    """With and without dependencies, a program and a library."""
    for dependencies in ((), ("std_msgs",)):
        for text in (build("pkg", dependencies, node, library) for build in (ros_cmake.ament, ros_cmake.plain)):
            assert not COMMAND.sub("", text)
            assert ("add_executable(one" in text) == (node is not None)
            assert ("add_library(two" in text) == (library is not None)
            assert ("find_package(std_msgs REQUIRED)" in text) == bool(dependencies)


def test_with_modules() -> None:
    """ament's parts for Python are found before they are used."""
    text = ros_cmake.with_modules(ros_cmake.ament("pkg", (), None, None))
    found, used = text.index("find_package(ament_cmake_python"), text.index("ament_python_install_package")
    assert found < used < text.index("find_package(ament_cmake_pytest") < text.index("ament_package()")


@slow
@pytest.mark.skipif(shutil.which("cmake") is None, reason="there is no cmake")
def test_a_plain_package_is_built(tmp_path: Path) -> None:
    """By CMake itself, with a program that uses the library's folder."""
    files = {
        "CMakeLists.txt": ros_cmake.plain("pkg", (), "one", "two"),
        "pkgConfig.cmake.in": ros_cmake.config("pkg", "one", "two"),
        "pkgConfigVersion.cmake.in": ros_cmake.config_version("pkg"),
        "src/one.cpp": ros_cmake.program("pkg"),
        "src/two.cpp": ros_cmake.library("pkg", "two"),
        "include/pkg/two.hpp": ros_cmake.header("pkg", "two"),
        "include/pkg/visibility_control.h": ros_cmake.visibility("pkg"),
    }
    for path, text in files.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    for words in (["-S", ".", "-B", "build"], ["--build", "build"], ["--install", "build", "--prefix", "there"]):
        subprocess.run(["cmake", *words], cwd=tmp_path, check=True, capture_output=True, timeout=60)
    said = subprocess.run([tmp_path / "there/lib/pkg/one"], check=True, capture_output=True, text=True).stdout
    assert said == "hello world pkg package\n"
