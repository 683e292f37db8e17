"""Command-line arguments that neither graphflow nor the program reads."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from graphflow.analysis.user_code import is_installed, is_users
from graphflow.names import nearest
from graphflow.reading import found_text
from graphflow.runtime.callables import file_of

if TYPE_CHECKING:
    from graphflow.runtime.node import Node

_READERS = re.compile(
    r"argv|getopt|\b(argparse|optparse|click|typer|tyro|fire|docopt|absl|gflags|hydra|simple_parsing|jsonargparse)\b"
)
"""Names that a program contains if it reads its command line."""

_OF_FILES = ("params", "param", "param-file", "params-file", "parameters", "parameters-file", "config", "file", "f")
"""Other tools' options for a parameter file."""
_OF_ROS = {
    **dict.fromkeys(("--name", "--node-name", "--node_name", "-n"), "-r __node:=VALUE"),
    **dict.fromkeys(("--namespace", "--ns"), "-r __ns:=VALUE"),
    **dict.fromkeys(("--debug", "--verbose"), "--log-level debug"),
    **dict.fromkeys(("--quiet", "-q"), "--log-level error"),
    **dict.fromkeys(("--sim-time", "--use-sim-time", "--use_sim_time"), "-p use_sim_time:=true"),
}
"""Options of other tools, with the equivalent ROS 2 arguments."""
_FILE = re.compile(r"\.ya?ml\Z")


def unread(arguments: Sequence[str], classes: Sequence[type[Node]], *, is_own_program: bool) -> str:
    """Return a complaint about unused command-line arguments; "" if the program may read them.

    Args:
        arguments: The arguments that are not ROS 2's.
        classes: The classes of the nodes.
        is_own_program: Whether a program of the user's runs them, rather than `graphflow run`.
    """
    if not arguments or any(_may_read(file) for file in _files(classes, is_own_program)):
        return ""
    argument = arguments[0]
    name, _, value = argument.partition("=")
    value = value if value else arguments[1] if arguments[1:] and not arguments[1].startswith("-") else "VALUE"
    known = [param.name for cls in classes for param in cls.interface().params]
    if name.startswith("-") and _FILE.search(value) and name.lstrip("-").replace("_", "-") in _OF_FILES:
        return f"nothing reads the option {name!r}; pass a parameter file with --params-file {value}"
    if (way := _OF_ROS.get(name)) is not None:
        return f"nothing reads the option {name!r}; write {way.replace('VALUE', value)}"
    for cls in classes:
        if argument == cls.__name__:
            return f"{argument} is a class, not an argument; write graphflow run {cls.__module__}:{argument}"
    near = nearest(name.lstrip("-").replace("-", "_"), known)
    way = f"; to set the parameter write -p {near}:={value}" if near else ""
    if not way and known:
        way = f"; -p NAME:=VALUE sets a parameter: {', '.join(known)}"
    return f"nothing reads the {'option' if argument.startswith('-') else 'argument'} {argument!r}{way}"


def _files(classes: Sequence[type[Node]], is_own_program: bool) -> Iterator[str]:
    """List the program's files: the user's own, those of the nodes' packages, and of modules it imports."""
    packages = {cls.__module__.partition(".")[0] for cls in classes}
    for name, module in list(sys.modules.items()):
        file = file_of(module)
        if name == "__main__":
            if not is_own_program:
                continue
            yield file if file is not None and not is_installed(file) else ""
        elif file is None or not is_users(file) or (is_installed(file) and name.partition(".")[0] not in packages):
            continue
        else:
            yield file
        yield from _imported(module)


def _imported(module: ModuleType) -> Iterator[str]:
    """List the files of installed modules from which a module imports."""
    for value in list(vars(module).values()):
        found = value if isinstance(value, ModuleType) else sys.modules.get(str(getattr(value, "__module__", "")))
        file = file_of(found)
        if file is not None and is_users(file) and is_installed(file):
            yield file


def _may_read(file: str) -> bool:
    """Whether a file mentions the command line, or is unreadable."""
    try:
        return _READERS.search(found_text(Path(file), "replace")) is not None
    except OSError:
        return True
