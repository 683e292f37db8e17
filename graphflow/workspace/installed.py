"""Nodes and graph files of installed distributions: entry points, and `graphs/` and `interfaces/` of their packages.

A distribution names its node classes in the group `graphflow.nodes`: `blinker = "my_robot.blinker:Blinker"`.
Programs for rclpy are its console scripts, as those of ROS 2 packages are. Nothing is imported to find them.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from graphflow.reading import found_bytes
from graphflow.workspace.setup_file import EntryPoint
from graphflow.workspace.source_kinds import uses_ros

if TYPE_CHECKING:
    from importlib.metadata import Distribution

GROUP = "graphflow.nodes"
"""The group of entry points that are node classes."""
SITE_FOLDERS = ("site-packages", "dist-packages")
"""Names of the folders of installed distributions."""


@dataclass(frozen=True)
class Installed:
    """The nodes of a distribution."""

    name: str
    """The name as a ROS 2 package has it: letters, digits and `_`."""
    nodes: Mapping[str, str]
    """The class paths of its node classes, by executable."""
    programs: Mapping[str, tuple[Path, EntryPoint]]
    """Files and functions of its programs for rclpy, by executable."""
    folders: tuple[Path, ...]
    """The folders of its Python packages."""

    @property
    def executables(self) -> list[str]:
        return sorted({*self.nodes, *self.programs})

    @property
    def graphs(self) -> dict[str, Path]:
        """Its graph files, by name: `robot`, `arms/left`."""
        tops = [top / "graphs" for folder in self.folders for top in _tops(folder)]
        return {f.relative_to(top).with_suffix("").as_posix(): f for top in tops for f in sorted(top.rglob("*.yaml"))}


@cache
def installed() -> dict[str, Installed]:
    """Return the distributions with nodes or programs for rclpy, by name."""
    from importlib.metadata import distributions  # slow to import: a tenth of a short command's start

    found: dict[str, Installed] = {}
    for one in map(_read, distributions()):
        if one is not None:
            found.setdefault(one.name, one)  # Python imports the first of the same name on its path
    return found


def package_of(name: str) -> Installed | None:
    """Find a distribution by its own name or that of one of its packages."""
    known = installed()
    return known.get(name) or next((one for one in known.values() if any(f.name == name for f in one.folders)), None)


def packages_with(executable: str) -> list[Installed]:
    """Return the distributions that have an executable."""
    return [one for one in installed().values() if executable in one.nodes or executable in one.programs]


def graphs() -> dict[str, list[Path]]:
    """Return all installed graph files by `robot` and by `my_robot/robot`; a name may be that of several."""
    found: dict[str, list[Path]] = {}
    for one in installed().values():
        for name, file in one.graphs.items():
            for key in {name, *(f"{word}/{name}" for word in (one.name, *(folder.name for folder in one.folders)))}:
                found.setdefault(key, []).append(file)
    return found


def interfaces() -> dict[str, Path]:
    """Return the folders of interface packages in installed distributions, by name."""
    tops = [top / "interfaces" for one in installed().values() for folder in one.folders for top in _tops(folder)]
    return {folder.name: folder for top in tops if top.is_dir() for folder in top.iterdir() if folder.is_dir()}


def _tops(folder: Path) -> list[Path]:
    """Return the folders with a package's `graphs/`: its own, and its project's if that is installed as editable."""
    return [folder, *([folder.parent] if (folder.parent / "pyproject.toml").is_file() else [])]


def _read(distribution: Distribution) -> Installed | None:
    points = distribution.entry_points
    nodes = {point.name: point.value for point in points.select(group=GROUP)}
    scripts = points.select(group="console_scripts")
    programs = {p.name: found for p in scripts if (found := _program(distribution, p.module, p.attr)) is not None}
    if not nodes and not programs:
        return None
    modules = {*(path.partition(":")[0] for path in nodes.values()), *(entry.module for _, entry in programs.values())}
    tops = sorted({module.partition(".")[0] for module in modules})
    folders = [folder for top in tops if (folder := _located(distribution, top)).is_dir()]
    name = re.sub(r"[-_.]+", "_", distribution.name).lower()
    return Installed(name, nodes, programs, tuple(folders))


def _program(distribution: Distribution, module: str, function: str) -> tuple[Path, EntryPoint] | None:
    """Return the file and function of a console script written for rclpy; None for any other."""
    file = _located(distribution, module).with_suffix(".py")
    try:
        is_ours = b"rclpy" in found_bytes(file) and uses_ros(file)
    except OSError:  # the module is a package's `__init__.py`, or its file has been moved
        return None
    return (file, EntryPoint(module, function)) if is_ours else None


def _located(distribution: Distribution, module: str) -> Path:
    """Return the path of a module without its suffix: as installed, or in its project if that is editable."""
    path = Path(*module.split("."))
    there = Path(str(distribution.locate_file("")))
    tops = (top for top in (there, *map(Path, sys.path)) if (top / path.parts[0] / "__init__.py").is_file())
    return next(tops, there) / path
