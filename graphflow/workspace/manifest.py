"""Faults of a `package.xml` that ROS's build tools refuse; graphflow itself reads only the name."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from xml.parsers import expat

from graphflow.reading import found_text, lenient_text

_SCRIPTS = re.compile(r"\s*(?:script[-_]dir|install[-_]scripts)\s*=\s*\$base/lib/([\w.-]+)\s*$")
_PACKAGES = re.compile(r"\bpackages\s*=\s*\[([^\]]*)\]")
"""A list of a setup.py."""
_LITERAL = re.compile(r"[\"']([A-Za-z_][\w.]*)[\"']\Z")
"""An element of it that is nothing but a name."""
_MISMATCHED = expat.errors.codes[expat.errors.XML_ERROR_TAG_MISMATCH]


def fault_of(file: Path) -> str | None:
    """Return the place and the reason if a file is no XML; None if it is."""
    try:
        text = found_text(file, "replace")
    except OSError as error:
        return f"{file}: {error.strerror}"
    if "<!ENTITY" in text:  # entities may expand to any length
        return None
    parser = expat.ParserCreate()
    is_open: list[tuple[str, int]] = []
    parser.StartElementHandler = lambda name, _: is_open.append((name, parser.CurrentLineNumber))
    parser.EndElementHandler = lambda _: is_open.pop()
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        if error.code == _MISMATCHED and is_open:
            name, line = _unclosed(text.splitlines()[error.lineno - 1][error.offset :], is_open)
            return f"{file}:{line}: <{name}> is not closed, and ROS 2 does not build it: write </{name}>"
        open_tag = "; is </package> there at the end?" if "</package>" not in text else ""
        return f"{file}:{error.lineno}: {expat.ErrorString(error.code)}: ROS 2 does not build it{open_tag}"
    return None


def _unclosed(end: str, is_open: list[tuple[str, int]]) -> tuple[str, int]:
    """Return the name and line of the element that an end tag should have closed.

    Args:
        end: The text that begins with the name in that tag.
        is_open: The names and lines of the elements that are open, the outermost first.
    """
    name = end.partition(">")[0].strip()
    around = next((place for place, (other, _) in reversed([*enumerate(is_open)]) if other == name), len(is_open) - 2)
    return is_open[min(around + 1, len(is_open) - 1)]


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


def leftovers(folder: Path, name: str) -> Iterator[str]:
    """Yield the places where a package's files still have the name of the package that they were copied from."""
    setup, cfg = folder / "setup.py", folder / "setup.cfg"
    for number, line in enumerate(lenient_text(cfg).splitlines(), 1):
        if (found := _SCRIPTS.match(line)) is not None and found[1] != name:
            yield f"{cfg}:{number}: ROS 2 looks for the executables in lib/{name}: write $base/lib/{name}"
    text = lenient_text(setup)
    marker = folder / "resource" / name
    if re.search(rf"resource/(?:[\"']\s*\+|\{{|{re.escape(name)}[\"'])", text) and not marker.is_file():
        yield f"{setup} installs resource/{name}, which is not there: touch {marker}"
    if (packages := _PACKAGES.search(text)) is not None:
        number = text.count("\n", 0, packages.start()) + 1
        literals = (_LITERAL.match(element.strip()) for element in packages[1].split(","))
        for word in (literal[1] for literal in literals if literal is not None):
            if not (folder / word.replace(".", "/")).is_dir() and "package_dir" not in text:
                yield f"{setup}:{number}: there is no folder {word}, which packages names: write {name}"


def _text(value: ast.expr, known: dict[str, str]) -> str | None:
    match value:
        case ast.Constant(value=str(text)):
            return text
        case ast.Name(id=word):
            return known.get(word)
    return None
