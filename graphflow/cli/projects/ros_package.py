"""The files of a new ROS 2 package, as `ros2 pkg create` lays them out, for each of its build types."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import escape, quoteattr

from graphflow.cli.projects import ros_cmake

BUILD_TYPES = ("ament_python", "ament_cmake", "cmake")
TEMPLATES = {"ament_python": "ament_python", "ament_cmake": "ament_cmake", "cmake": "cmake"} | {
    "ament_cmake_python": "ament_cmake"
}
"""Templates, each with its build type: a CMake package may have Python modules, too."""
LICENSES = Path(__file__).parent / "licenses"
"""The texts of licenses; each file's name is an SPDX identifier."""


@dataclass(frozen=True, kw_only=True)
class Description:
    """The settings of a new package."""

    name: str
    template: str
    package_format: int = 3
    description: str = "TODO: Package description"
    license: str = "TODO: License declaration"
    maintainer_name: str
    maintainer_email: str
    dependencies: tuple[str, ...] = ()
    node_name: str | None = None
    library_name: str | None = None

    @property
    def build_type(self) -> str:
        return TEMPLATES[self.template]

    def lines(self) -> Iterator[str]:
        """Format the settings as `ros2 pkg create` prints them."""
        yield f"package format: {self.package_format}"
        yield "version: 0.0.0"
        yield f"description: {self.description}"
        yield f"maintainer: {[f'{self.maintainer_name} <{self.maintainer_email}>']}"
        yield f"licenses: {[self.license]}"
        yield f"build type: {self.build_type}"
        yield f"dependencies: {list(self.dependencies)}"
        if self.node_name:
            yield f"node_name: {self.node_name}"
        if self.library_name:
            yield f"library_name: {self.library_name}"


class Part(NamedTuple):
    """A file or folder of a package."""

    path: str
    text: str | None
    """Contents; None for a folder."""


def parts(new: Description) -> Iterator[Part]:
    """Yield the folders and files of a package in the order of `ros2 pkg create`; paths are relative to its folder."""
    yield Part("package.xml", package_xml(new))
    yield from _python(new) if new.build_type == "ament_python" else _cmake(new)


def license_text(identifier: str) -> str | None:
    """Return the text of a license; None if it is not known."""
    return (LICENSES / f"{identifier}.txt").read_text(encoding="utf-8") if identifier in known_licenses() else None


def known_licenses() -> list[str]:
    """Return the identifiers of the licenses whose texts are known."""
    return sorted(file.stem for file in LICENSES.glob("*.txt"))


def package_xml(new: Description) -> str:
    """Return the manifest, with the package's maintainer, dependencies and build tools.

    Source: REP 140 and REP 149.
    """
    schema = f"http://download.ros.org/schema/package_format{new.package_format}.xsd"
    language = "http://www.w3.org/2001/XMLSchema"
    tools = _BUILD_TOOLS[new.template]
    if new.library_name:  # ament_cmake_ros makes libraries shared by default, as ROS's own are
        tools = tuple("ament_cmake_ros" if tool == "ament_cmake" else tool for tool in tools)
    needed = {"buildtool_depend": tools, "depend": new.dependencies, "test_depend": _TEST_TOOLS[new.template]}
    blocks = ["".join(f"  <{tag}>{escape(name)}</{tag}>\n" for name in names) for tag, names in needed.items() if names]
    return "\n".join(
        [
            f"""\
<?xml version="1.0"?>
<?xml-model href="{schema}" schematypens="{language}"?>
<package format="{new.package_format}">
  <name>{new.name}</name>
  <version>0.0.0</version>
  <description>{escape(new.description)}</description>
  <maintainer email={quoteattr(new.maintainer_email)}>{escape(new.maintainer_name)}</maintainer>
  <license>{escape(new.license)}</license>
""",
            *blocks,
            f"  <export>\n    <build_type>{new.build_type}</build_type>\n  </export>\n</package>\n",
        ]
    )


_BUILD_TOOLS: dict[str, tuple[str, ...]] = {
    "ament_python": (),
    "cmake": (),
    "ament_cmake": ("ament_cmake",),
    "ament_cmake_python": ("ament_cmake", "ament_cmake_python"),
}
_TEST_TOOLS: dict[str, tuple[str, ...]] = {
    "ament_python": ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest"),
    "cmake": (),
    "ament_cmake": ("ament_lint_auto", "ament_lint_common"),
    "ament_cmake_python": ("ament_lint_auto", "ament_lint_common", "ament_cmake_pytest"),
}


def _python(new: Description) -> Iterator[Part]:
    yield Part(new.name, None)
    yield Part("setup.py", _setup_py(new))
    lib = f"$base/lib/{new.name}"
    yield Part("setup.cfg", f"[develop]\nscript_dir={lib}\n[install]\ninstall_scripts={lib}\n")
    yield Part("resource", None)
    yield Part(f"resource/{new.name}", "")
    yield Part(f"{new.name}/__init__.py", "")
    yield Part("test", None)
    for linter, (arguments, more) in _LINTERS.items():
        yield Part(f"test/test_{linter}.py", _TEST.format(linter=linter, arguments=arguments, more=more))
    if new.node_name:
        yield Part(f"{new.name}/{new.node_name}.py", _NODE.format(name=new.name))
    if new.library_name:
        yield Part(f"{new.name}/{new.library_name}", None)
        yield Part(f"{new.name}/{new.library_name}/__init__.py", "")


def _setup_py(new: Description) -> str:
    node = f"            '{new.node_name} = {new.name}.{new.node_name}:main',\n" if new.node_name else ""
    return f"""\
from setuptools import find_packages, setup

package_name = '{new.name}'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={new.maintainer_name!r},
    maintainer_email={new.maintainer_email!r},
    description={new.description!r},
    license={new.license!r},
    tests_require=['pytest'],
    entry_points={{
        'console_scripts': [
{node}        ],
    }},
)
"""


_NODE = """\
def main():
    print('Hi from {name}.')


if __name__ == '__main__':
    main()
"""
_LINTERS = {
    "copyright": ("['.', 'test']", "@pytest.mark.skip(reason='the files have no copyright headers yet')\n"),
    "flake8": ("[]", ""),
    "pep257": ("['.', 'test']", ""),
}
"""The linters of ament that a package's tests run, their arguments, and further decorators of the test."""
_TEST = """\
import pytest

linter = pytest.importorskip('ament_{linter}.main', reason='ament_{linter} comes with ROS 2')


{more}@pytest.mark.linter
@pytest.mark.{linter}
def test_{linter}():
    assert linter.main(argv={arguments}) == 0
"""


def _cmake(new: Description) -> Iterator[Part]:
    yield Part("src", None)
    yield Part(f"include/{new.name}", None)
    yield Part("CMakeLists.txt", _lists(new))
    if new.template == "cmake":
        yield Part(f"{new.name}Config.cmake.in", ros_cmake.config(new.name, new.node_name, new.library_name))
        yield Part(f"{new.name}ConfigVersion.cmake.in", ros_cmake.config_version(new.name))
    if new.template == "ament_cmake_python":
        yield Part(new.name, None)
        yield Part(f"{new.name}/__init__.py", "")
        yield Part("test", None)
    if new.node_name:
        yield Part(f"src/{new.node_name}.cpp", ros_cmake.program(new.name))
    if new.library_name:
        header = f"include/{new.name}"
        yield Part(f"{header}/{new.library_name}.hpp", ros_cmake.header(new.name, new.library_name))
        yield Part(f"src/{new.library_name}.cpp", ros_cmake.library(new.name, new.library_name))
        yield Part(f"{header}/visibility_control.h", ros_cmake.visibility(new.name))


def _lists(new: Description) -> str:
    build = ros_cmake.plain if new.template == "cmake" else ros_cmake.ament
    text = build(new.name, new.dependencies, new.node_name, new.library_name)
    return ros_cmake.with_modules(text) if new.template == "ament_cmake_python" else text
