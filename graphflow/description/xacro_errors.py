"""Errors of xacro, which have no lines, at the lines of the source that they are about."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from xml.parsers.expat import ExpatError

from graphflow.errors import Place, Problem
from graphflow.names import did_you_mean
from graphflow.reading import found_text

NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
_LONGEST = 1_000_000
"""Characters of a file that are searched."""

Texts = Mapping[str, str]
"""The files that xacro has read, with their text."""
_Explain = Callable[[re.Match[str], Texts], tuple[str, str]]
"""From a message of xacro to the pattern of the line that it is about, and the text of the problem."""


def problem(error: Exception, files: Sequence[str]) -> Problem:
    """Return an error of xacro as a problem with its place, as far as the source shows that.

    Args:
        files: The files that xacro has read, the one that it was reading last at the end.
    """
    from xacro import XacroException

    inner, macros = (error.exc, error.macros) if isinstance(error, XacroException) else (None, [])
    for one in (error, inner):
        if isinstance(one, ExpatError):
            text = str(one).partition(": line ")[0]
            way = f": write <robot {NAMESPACE} ...>" if text == "unbound prefix" else ""
            return Problem(Place(files[-1], one.lineno, one.offset + 1), f"not valid XML: {text}{way}")
    message, texts = str(error) or type(error).__name__, {file: _text(file) for file in reversed(files)}
    message = f"{message} in {macros[0].body.getAttribute('name')}" if macros else message
    for pattern, explain in _MESSAGES:
        if found := re.search(pattern, message, re.DOTALL):
            line, text = explain(found, texts)
            return Problem(_place(line, texts) or Place(files[0]), text)
    quoted = re.search(r'"([^"]+)"|: (\S+)$', message)
    word = re.escape(quoted[1] or quoted[2]) if quoted else "$^"
    place = _place(rf'(?<="){word}(?=")', texts) or Place(files[-1])
    return Problem(place, f"xacro: {' '.join(message.split())}")


def _text(file: str) -> str:
    try:
        return found_text(Path(file), "replace")[:_LONGEST]
    except OSError:
        return ""


def _place(pattern: str, texts: Texts) -> Place | None:
    """Return the place of the first match, the file that was read last first."""
    for file, text in texts.items():
        if found := re.search(pattern, text):
            before = text[: found.start()]
            return Place(file, before.count("\n") + 1, found.start() - before.rfind("\n"))
    return None


def _defined(texts: Texts, kinds: str) -> list[str]:
    names: Iterator[str] = (
        name for text in texts.values() for name in re.findall(rf'<xacro:(?:{kinds})\s[^>]*?\bname="(\w+)"', text)
    )
    return sorted(set(names))


def _undefined_name(found: re.Match[str], texts: Texts) -> tuple[str, str]:
    name, expression = found[1], re.escape(found[2])
    known = [*_defined(texts, "property"), *(p for text in texts.values() for p in _parameters(text))]
    return rf"\$\{{\s*{expression}\s*\}}", f"there is no property {name!r}{did_you_mean(name, known)}"


def _parameters(text: str) -> list[str]:
    return [word.partition(":")[0] for given in re.findall(r'\bparams="([^"]*)"', text) for word in given.split()]


def _failed_expression(found: re.Match[str], _texts: Texts) -> tuple[str, str]:
    return rf"\$\{{\s*{re.escape(found[2])}\s*\}}", f"the expression {found[2]!r} fails: {found[1].strip()}"


def _unknown_macro(found: re.Match[str], texts: Texts) -> tuple[str, str]:
    name = found[1].removeprefix("xacro:")
    hint = did_you_mean(name, _defined(texts, "macro"))
    return rf"<{re.escape(found[1])}\b", f"there is no macro {name!r}{hint}"


def _missing_parameters(found: re.Match[str], _texts: Texts) -> tuple[str, str]:
    names = found[1].split(",")
    lacks = "".join(rf"(?![^>]*\s{re.escape(name)}=)" for name in names)
    return rf"<xacro:{found[2]}\b{lacks}", f"the macro {found[2]!r} needs {' and '.join(names)}, which is not given"


def _strange_parameter(found: re.Match[str], texts: Texts) -> tuple[str, str]:
    name, macro = found[1], found[2]
    params = [p for text in texts.values() for p in re.findall(rf'name="{macro}"\s+params="([^"]*)"', text)]
    known = [word.partition(":")[0] for given in params for word in given.split()]
    line = rf"<xacro:{macro}\b[^>]*\s{re.escape(name)}="
    return line, f"the macro {macro!r} has no parameter {name!r}{did_you_mean(name, known)}"


def _missing_package(found: re.Match[str], _texts: Texts) -> tuple[str, str]:
    return rf"\$\(find\s+{re.escape(found[1])}\s*\)", f"there is no package {found[1]!r} in this workspace"


def _missing_argument(found: re.Match[str], texts: Texts) -> tuple[str, str]:
    name = found[1]
    hint = did_you_mean(name, _defined(texts, "arg")) or f': declare <xacro:arg name="{name}" default="..."/>'
    return rf"\$\(arg\s+{re.escape(name)}\s*\)", f"there is no argument {name!r}{hint}"


def _missing_file(found: re.Match[str], _texts: Texts) -> tuple[str, str]:
    name = Path(found[1]).name
    return rf'(filename="|load_yaml\(.?)[^"]*{re.escape(name)}', f"there is no file {found[1]}"


_MESSAGES: Sequence[tuple[str, _Explain]] = (
    (r"name '(\w+)' is not defined.*when evaluating expression '(.*?)'", _undefined_name),
    (r"unknown macro name: (\S+)", _unknown_macro),
    (r"Undefined parameters \[(.*?)\] in (\w+)", _missing_parameters),
    (r'Invalid parameter "(\w+)" in (\w+)', _strange_parameter),
    (r"package '(\S+?)' not found", _missing_package),
    (r"Undefined substitution argument (\w+)", _missing_argument),
    (r"No such file or directory: '?([^' ]+)", _missing_file),
    (r"^(.*?)\s*when evaluating expression '(.*?)'", _failed_expression),
)
