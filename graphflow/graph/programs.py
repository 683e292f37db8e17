"""The command lines of a graph's programs: executables of packages, files, and commands, each with its prefix."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from shutil import which

from graphflow.errors import Place, Problem
from graphflow.graph.checks.validation import Problems
from graphflow.graph.model import NodeSpec
from graphflow.markup import source
from graphflow.markup.source import Source
from graphflow.markup.substitutions import Outside
from graphflow.workspace.executables import NoExecutable, command_of, spelling_fault
from graphflow.workspace.packages import Workspace, find_workspace
from graphflow.workspace.project import home_hint


class Programs:
    """The programs of a graph; the workspace is read at most once.

    Args:
        graph_files: The graph files, to which paths are relative, by the names that messages have for them.
    """

    def __init__(self, src: Source, graph_files: Mapping[str, Path], outside: Outside, problems: Problems) -> None:
        self._src, self._files, self._outside, self._problems = src, graph_files, outside, problems
        self.left_out: dict[str | int, Problem] = {}
        """Nodes of launch files whose programs are not installed, by name."""

    @cached_property
    def _workspace(self) -> Workspace:
        return find_workspace(self._outside.root)

    def command(self, spec: NodeSpec, at: source.Path) -> tuple[str, ...] | None:
        """Return the command line of a node's program: empty for a class, None for one that is left out."""
        command = self._executable(spec, at) if spec.exec_ else self._foreign(spec, at)
        before = None if command is None else self._prefix(spec, at)
        if command is None or before is None:
            return None
        return (*before, *command, *map(str, spec.args)) if spec.exec_ else command

    def _foreign(self, spec: NodeSpec, at: source.Path) -> tuple[str, ...] | None:
        """Return the words of `command:`; None for a program of a launch file that is not installed."""
        words = tuple(map(str, spec.command))
        place = self._src.place((*at, "command"))
        if words and place.file in self._problems.launch_files and which(words[0], path=self._path) is None:
            text = f"{words[0]} is left out: there is no program of that name on the PATH"
            self.left_out[at[-1]] = Problem(place, text)
            return None
        return words

    @property
    def _path(self) -> str | None:
        # That of the environment in which the graph will run, which need not be this process's.
        return self._outside.env.get("PATH")

    def _executable(self, spec: NodeSpec, at: source.Path) -> tuple[str, ...] | None:
        """Return the command line of an executable; None for one that is left out, as it is not installed."""
        place = self._src.place((*at, "exec"))
        if not spec.pkg:
            return self._file(spec, place)
        package = self._workspace.packages.get(spec.pkg)
        if package is not None and (fault := spelling_fault(package, spec.exec_)) is not None:
            self._problems.remark(place, fault)
        try:
            return command_of(spec.pkg, spec.exec_, self._workspace, self._outside.env)
        except NoExecutable as error:
            if not error.is_slip and place.file in self._problems.launch_files:
                self.left_out[at[-1]] = Problem(place, f"{spec.exec_} is left out: {error}")
                return None
            if error.is_slip or spec.pkg in self._workspace.packages:
                self._problems.add(place, str(error))
            return ("ros2", "run", spec.pkg, spec.exec_)

    def _file(self, spec: NodeSpec, place: Place) -> tuple[str, ...]:
        """Return the command line of an executable given as a file: a Python script, or any executable file."""
        file = self._files[place.file].parent / spec.exec_
        if not file.is_file():
            self._problems.add(place, f"exec: there is no file {file}{home_hint(file)}")
        elif file.suffix != ".py" and not os.access(file, os.X_OK):
            self._problems.add(place, f"exec: {file} is no executable file; to make it one: chmod +x {file}")
        return ("graphflow", "run", str(file)) if file.suffix == ".py" else (str(file),)

    def _prefix(self, spec: NodeSpec, at: source.Path) -> list[str] | None:
        """Return the words of `prefix:`; None if the program is left out, as that of the prefix is not installed."""
        place = self._src.place((*at, "prefix"))
        try:
            words = shlex.split(spec.prefix)
        except ValueError as error:
            self._problems.add(place, f"prefix: {error}")
            return []
        if words and not spec.exec_:
            run = f"graphflow run --prefix {shlex.quote(spec.prefix)} {spec.class_}"
            text = f"prefix: goes with pkg: and exec:; to run this class by itself with it: {run}"
            self._problems.add_unless_ros(place, text)
        elif words and which(words[0], path=self._path) is None:
            rules = "".join(f" -r {old}:={new}" for old, new in spec.remap.items())
            run = f"run it by itself: graphflow run {executable_of(spec)}{rules and f' --ros-args{rules}'}"
            text = f"there is no program {words[0]!r} on the PATH, which prefix: names; {run}"
            if place.file not in self._problems.launch_files:
                self._problems.add(place, text)
            self.left_out[at[-1]] = Problem(place, f"{spec.exec_} is left out: {text}")
            return None
        return words


def executable_of(spec: NodeSpec) -> str:
    """Return the package and executable of a node, or its file; empty for a class or a foreign program."""
    return f"{spec.pkg} {spec.exec_}".strip()
