"""Faults of a `package.xml` that ROS's build tools refuse; graphflow itself reads only the name."""

from __future__ import annotations

import ast
from pathlib import Path
from xml.parsers import expat

from graphflow.reading import found_text


def fault_of(file: Path) -> str | None:
    """Return the place and the reason if a file is no XML; None if it is."""
    try:
        text = found_text(file, "replace")
    except OSError as error:
        return f"{file}: {error.strerror}"
    if "<!ENTITY" in text:  # entities may expand to any length
        return None
    try:
        expat.ParserCreate().Parse(text, True)
    except expat.ExpatError as error:
        open_tag = "; is </package> there at the end?" if "</package>" not in text else ""
        return f"{file}:{error.lineno}: {expat.ErrorString(error.code)}: ROS 2 does not build it{open_tag}"
    return None


def name_fault(folder: Path, name: str) -> str | None:
    """Return the place where `setup.py` has another name than `package.xml`; None if the names agree."""
    file = folder / "setup.py"
    try:
        tree = ast.parse(found_text(file, "replace"))
    except (OSError, SyntaxError, ValueError):  # there is none, or its fault is reported elsewhere
        return None
    known: dict[str, str] = {}
    for node in ast.walk(tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=word)], value=ast.Constant(value=str(text))):
                known[word] = text
            case ast.Call(func=ast.Name(id="setup") | ast.Attribute(attr="setup"), keywords=keywords):
                for keyword in keywords:
                    if keyword.arg == "name" and (called := _text(keyword.value, known)) not in (None, name):
                        line = keyword.value.lineno
                        return f"{file}:{line}: the package is called {called!r} here, and {name!r} in package.xml"
    return None


def _text(value: ast.expr, known: dict[str, str]) -> str | None:
    match value:
        case ast.Constant(value=str(text)):
            return text
        case ast.Name(id=word):
            return known.get(word)
    return None
