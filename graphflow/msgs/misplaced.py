"""Advice on files of definitions that lie in a wrong folder or have a wrong name."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from graphflow.wire import idl

IN_CAMEL = ": names of interfaces are in camel case"
"""The reason to rename the file of an interface."""


def camel(name: str) -> str:
    """Convert a name with underscores or small letters to that of an interface: `SetGoal` for `set_goal`."""
    return "".join(part[:1].upper() + part[1:] for part in re.split("[_-]", name))


def misplaced(folder: Path, package: str) -> dict[Path, Path]:
    """Return the definitions in a package's folder that are not read, with their right paths."""
    patterns = ("*", "*/*", f"{package}/*/*")
    found = {f: folder / k / f.name for k in idl.KINDS for at in patterns for f in sorted(folder.glob(f"{at}.{k}"))}
    return {file: right for file, right in found.items() if file != right}


def without_kinds(package: str, own: Path | None, roots: Sequence[Path]) -> str:
    """Describe what a package's folder lacks, definitions or the package's name; empty if nothing.

    Args:
        own: The folder of the package by itself; None for one below `roots`.
    """
    if own is not None:
        wrong = next(iter(misplaced(own, package).items()), None)
        none = f"; {own} has no .msg, .srv or .action files"
        return none if wrong is None else f"; {wrong[0]} must be {wrong[1]}"
    found = [root / package for root in roots if package.isidentifier() and (root / package).is_dir()]
    if found:
        return f"; {found[0]} has no folder msg, srv or action"
    for root in roots:
        for kind in idl.KINDS:
            for file in (*sorted((root / kind).glob(f"*.{kind}")), *sorted(root.glob(f"*.{kind}"))):
                return f"; {file} lies in no package: move it to {root / package / kind / file.name}"
    alike = (folder for root in roots for folder in root.iterdir() if folder.name.replace("-", "_") == package)
    return next((f"; rename {folder} to {package}" for folder in alike if folder.is_dir()), "")


def meant(name: str, folders: Sequence[Path]) -> str:
    """Describe the move or renaming of a file that seems to be meant but lies elsewhere; else empty.

    A file with a legal place and name is not to be renamed: then the requested name is wrong.

    Args:
        folders: Those of the package.
    """
    for folder in folders:
        for file in sorted(file for kind in idl.KINDS for file in folder.rglob(f"*.{kind}")):
            kind = file.suffix[1:]
            if file.stem.replace("_", "").lower() == name.replace("_", "").lower():
                if file.parent == folder / kind and file.stem != name and idl.is_type_name(file.stem):
                    return f"; did you mean {file.stem!r}?"
                right = folder / kind / f"{name if idl.is_type_name(name) else camel(name)}.{kind}"
                if file != right:
                    return f"; {file} must be {right}{'' if idl.is_type_name(file.stem) else IN_CAMEL}"
    return ""
