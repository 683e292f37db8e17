"""What graphflow imports is declared in pyproject.toml, and nothing else is."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from tests.conftest import PROJECT
from tests.test_layers import imports

PROJECT_TABLE = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
FILES = sorted(file for folder in ("graphflow", "nodes") for file in (PROJECT / folder).rglob("*.py"))
OTHER_NAMES = {"eclipse-zenoh": "zenoh", "pillow": "PIL", "pyyaml": "yaml", "ruamel.yaml": "ruamel"}
OTHER_NAMES |= {"rerun-sdk": "rerun", "textual-image": "textual_image", "textual-serve": "textual_serve"}
"""Modules that are not called as their distributions are."""
USERS_CHOICE = {
    "cv2": "OpenCV comes in several distributions; cv_bridge names one where it is needed",
    "hypothesis": "the plugin imports it for tests that do",
    "pytest": "the plugin is imported by pytest only",
    "transforms3d": "tf_transformations names it; as in ROS 2, its users install it",
    "typing_extensions": "only type checkers import it, and they bring it along",
}
"""Packages that graphflow does not install for anybody."""


def modules(requirements: Iterable[str]) -> set[str]:
    """The modules that requirements install."""
    names = (re.match(r"[\w.-]+", requirement) for requirement in requirements)
    return {OTHER_NAMES.get(found[0], found[0]) for found in names if found}


NEEDED = modules(PROJECT_TABLE["dependencies"])
OPTIONAL = {
    module
    for extra, requirements in PROJECT_TABLE["optional-dependencies"].items()
    if extra not in ("dev", "docs")
    for module in modules(requirements)
}


@cache
def own() -> set[str]:
    """Packages that come with graphflow, those under ROS's names included."""
    folders = (PROJECT / folder for folder in ("graphflow/msgs", "graphflow/rclpy/site", "graphflow/rclpy/packages"))
    return {"graphflow", "nodes", *(child.name for folder in folders for child in folder.iterdir() if child.is_dir())}


def foreign(file: Path) -> set[str]:
    """The packages that a file imports which neither Python nor graphflow has."""
    text, package = file.read_text(encoding="utf-8"), ".".join(file.relative_to(PROJECT).parts[:-1])
    named = {found.module.partition(".")[0] for found in imports(text, package)}
    return named - sys.stdlib_module_names - own() - {"__main__"}


@cache
def imported() -> dict[str, set[str]]:
    """The foreign packages that each file imports, of the files that import any."""
    return {str(file.relative_to(PROJECT)): found for file in FILES if (found := foreign(file))}


def test_every_imported_package_is_declared() -> None:
    """None comes along by chance, as a dependency of a dependency."""
    known = NEEDED | OPTIONAL | set(USERS_CHOICE)
    assert {file: found - known for file, found in imported().items() if found - known} == {}


def test_every_declared_package_is_imported() -> None:
    """Nobody installs what nothing uses."""
    assert (NEEDED | OPTIONAL) - set().union(*imported().values()) == set()


def test_extras_repeat_no_dependency() -> None:
    """An extra has only what is not installed anyway."""
    assert not OPTIONAL & NEEDED
