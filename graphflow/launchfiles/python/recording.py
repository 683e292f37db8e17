"""The state of a launch file in Python while it runs against the stand-ins."""

from __future__ import annotations

import inspect
import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Protocol

from graphflow.folders import newest_logs
from graphflow.launchfiles.recorded import Finding
from graphflow.markup.substitutions import Outside, Run, SubstitutionError, Substitutions
from graphflow.names import did_you_mean
from graphflow.workspace.executables import package_prefix, package_share
from graphflow.workspace.packages import find_workspace
from graphflow.workspace.project import project_root


class PackageNotFoundError(KeyError):
    """The error of ament_index_python for a package that is not found."""

    def __str__(self) -> str:
        near = self.args[1] if len(self.args) > 1 else ""
        return f"package {self.args[0]!r} not found{near or '; it is neither in the workspace nor installed'}"


class _Call(Protocol):
    @property
    def line(self) -> int: ...


class Recording:
    """The state of a launch file while it runs against the stand-ins."""

    def __init__(self) -> None:
        self.file = ""
        """The file's path, as its frames have it."""
        self.values: dict[str, str] | None = None
        """The arguments with which it is being started; None if it is only converted."""
        self.defaults: dict[str, str] = {}
        """Defaults of the arguments declared so far."""
        self.needed: set[str] = set()
        """Arguments declared without a default."""
        self.set: dict[str, str] = {}
        """Launch configurations set so far."""
        self.env: dict[str, str] = {}
        """Environment variables set so far."""
        self.descriptions: list[object] = []
        """All launch descriptions, to which functions may add while they are called."""
        self.problems: list[Finding] = []
        """Parts that a graph file cannot express."""
        self.remarks: list[Finding] = []
        """Parts that are left out."""
        self.written_at = 1
        """The line of the action that was converted last."""
        self.run: Run | None = None
        """Runs the programs of `$(command ...)`; without it, such a substitution stays as it is."""
        self.carry_out: Callable[[object], None] = lambda _: None
        """Converts an action that the file's code executes itself; `actions` sets it."""

    def problem(self, call: _Call, message: str) -> None:
        """Add a problem at a call's line."""
        self.problems.append({"line": call.line, "message": message})

    def remark(self, call: _Call, message: str) -> None:
        """Add a remark at a call's line."""
        self.remarks.append({"line": call.line, "message": message})

    def line(self) -> int:
        """Return the line of the launch file that is being executed."""
        frame = inspect.currentframe()
        while frame is not None and frame.f_code.co_filename != self.file:
            frame = frame.f_back
        return frame.f_lineno if frame is not None else 1

    def known(self, text: str) -> str:
        """Return a text with its substitutions made if the file is being started; unchanged if not.

        Raises:
            SubstitutionError: A substitution cannot be made.
        """
        if self.values is None:
            return text
        missing = next(
            (name for name in self.needed - self.values.keys() - self.defaults.keys() if f"$(var {name})" in text), None
        )
        if missing is not None:
            raise SubstitutionError(f"the argument {missing!r} has no default; give {missing}:=VALUE")
        return self._made(text, self.arguments())

    def arguments(self) -> dict[str, str]:
        """Return the known launch configurations: given arguments, defaults, and values set so far."""
        found = dict(self.values or {})
        # In the order of declaration: a default may use the arguments before it.
        for name, default in self.defaults.items():
            if name not in found:
                found[name] = self._made(default, found)
        return found | self.set

    def _made(self, text: str, values: Mapping[str, str]) -> str:
        file = Path(self.file)
        env = {**os.environ, **self.env}
        outside = Outside(env, project_root(file), newest_logs(file.name.removesuffix(".launch.py")), self.run)
        return str(Substitutions(values, file, outside, is_launch=True).apply(text, is_word=True))

    def folder(self, what: str, package: str) -> str:
        """Return the `share` folder or `prefix` of a package; its substitution if the file is only converted.

        Raises:
            PackageNotFoundError: There is no such package.
        """
        if self.values is None:
            return f"$(find-pkg-{what} {package})"
        find = package_prefix if what == "prefix" else package_share
        found = find(package, project_root(Path(self.file)), os.environ)
        if found is None:
            near = did_you_mean(package, (), hidden=find_workspace(Path(self.file)).packages)
            raise PackageNotFoundError(package, near)
        return str(found)


RECORDING = Recording()
"""The state of this process's launch file: a process runs only one."""


def as_text(value: object) -> str:
    """Convert a value to text, as launch configurations are all texts."""
    return value if isinstance(value, str) else json.dumps(value)
