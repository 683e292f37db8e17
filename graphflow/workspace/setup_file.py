"""The `setup.py` of a package, read without running it: executables and faults."""

from __future__ import annotations

import ast
import os
import re
import symtable
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from graphflow.names import did_you_mean, nearest
from graphflow.reading import lenient_text, parsed

_SCRIPT = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*(?:\[[\w\s.,-]*\]\s*)?")
"""An entry point; extras in brackets are ignored."""
_MAKES_NAMES = {"exec", "globals", "setattr", "vars"}
"""Functions that may define names which the source does not show."""


class EntryPoint(NamedTuple):
    """A function of a module that is an executable."""

    module: str
    function: str


@dataclass(frozen=True)
class SetupFile:
    """A `setup.py`.

    Args:
        file: Its path.
        text: Its content; empty if it does not exist.
    """

    file: Path
    text: str

    @cached_property
    def tree(self) -> ast.Module | SyntaxError:
        """The syntax tree, or the error in the file."""
        try:
            return parsed(self.text)
        except SyntaxError as error:
            return error
        except ValueError as error:  # null bytes, for example
            return SyntaxError(str(error))

    @property
    def _module(self) -> ast.Module:
        return self.tree if isinstance(self.tree, ast.Module) else ast.Module([], [])

    @cached_property
    def _constants(self) -> dict[str, str]:
        return constants(self._module)

    @cached_property
    def _folders(self) -> dict[str, Path]:
        """Its `package_dir`: folders by package name, with "" for all other packages."""
        found = {}
        for node in ast.walk(self._module):
            match node:
                case ast.keyword(arg="package_dir", value=ast.Dict(keys=keys, values=values)):
                    for key, value in zip(keys, values, strict=True):
                        name = constant_text(key, self._constants) if key is not None else None
                        if name is not None and (folder := constant_text(value, self._constants)):
                            found[name] = Path(folder)
        return found

    @property
    def package_dir(self) -> str:
        """The root folder of its modules: `src` for `{"": "src"}`, and for `{"lamp": "src/lamp"}`."""
        above = [folder.parent for name, folder in self._folders.items() if name == folder.name]
        return str(next(iter(above), Path())) if "" not in self._folders else str(self._folders[""])

    @property
    def renamed(self) -> dict[str, Path]:
        """Folders whose names differ from those of their packages, by package."""
        return {name: folder for name, folder in self._folders.items() if name not in ("", folder.name)}

    @cached_property
    def _scripts(self) -> dict[str, tuple[EntryPoint, int]]:
        """The entry points, `name = module:function`, with their lines; constants of the file are substituted."""
        found = {}
        for node in _of_console_scripts(self._module):
            text = constant_text(node, self._constants)
            script = None if text is None else entry_point(text)
            if script is not None:
                found[script[0]] = script[1], getattr(node, "lineno", 1)
        return found

    @property
    def entry_points(self) -> dict[str, EntryPoint]:
        """Executables, by name."""
        return {name: entry for name, (entry, _) in self._scripts.items()}

    @property
    def lines(self) -> dict[str, int]:
        """Lines of the executables, by name."""
        return {name: line for name, (_, line) in self._scripts.items()}

    @property
    def computes_scripts(self) -> bool:
        """Whether some executables are computed, and not literal."""
        return any(
            not isinstance(value, (ast.List, ast.Tuple))
            or any(constant_text(one, self._constants) is None for one in value.elts)
            for value in _under_console_scripts(self._module)
        )

    @cached_property
    def finds_packages(self) -> int | None:
        """The line of its call of `find_packages`, which ignores folders without an `__init__.py`; None for no call."""
        for node in ast.walk(self._module):
            match node:
                case ast.Call(func=ast.Name(id="find_packages") | ast.Attribute(attr="find_packages")):
                    return node.lineno
        return None

    @cached_property
    def faults(self) -> list[str]:
        """Reasons why some or all executables are unknown, each with its line."""
        if isinstance(self.tree, SyntaxError):
            line, why = self.tree.lineno or 1, self.tree.msg
            return [f"{self.file}:{line}: SyntaxError: {why}; until that is corrected it has no executables"]
        found = [
            *_misspelt(self.tree),
            *_unimported(self.tree),
            *(fault for node in self._elements() if (fault := self._fault_of(node))),
        ]
        return [f"{self.file}:{line}: {text}" for line, text in [*found, *self._twice()]]

    def without_executables(self, package: str) -> list[str]:
        """Return the fault that no executable is named, with the line for a module that has a `main()`; or empty."""
        if self.computes_scripts or not self.file.is_file():
            return []
        for file in sorted((self.file.parent / package).glob("*.py")):
            if re.search(r"^def main\(", lenient_text(file), re.MULTILINE):
                line = f"{file.stem} = {package}.{file.stem}:main"
                return [f"{self.file} names no executable: add '{line}', to its console_scripts"]
        return []

    def _twice(self) -> Iterator[tuple[int, str]]:
        """Yield executables with the name of another, of which only the last counts."""
        first: dict[str, int] = {}
        for node in self._elements():
            script = entry_point(constant_text(node, self._constants) or "")
            if script is None:
                continue
            if script[0] in first:
                where = f"the executable in line {first[script[0]]}"
                yield node.lineno, f"{script[0]!r} is the name of {where}, too; rename one of them"
            first.setdefault(script[0], node.lineno)

    def _elements(self) -> Iterator[ast.expr]:
        for value in _under_console_scripts(self._module):
            if isinstance(value, (ast.List, ast.Tuple)):
                yield from value.elts

    def _fault_of(self, node: ast.expr) -> tuple[int, str] | None:
        """Return the line and the fault of a text that is no entry point; None if it is one."""
        text = constant_text(node, self._constants)
        if text is None or entry_point(text) is not None:
            return None
        near = next((way for way in _corrections(text, self.file.parent) if entry_point(way) is not None), None)
        if near is not None:
            return node.lineno, f"{text!r} names no function; did you mean {near!r}?"
        if text.count(":") > 1 or text.count("=") > 1:
            return node.lineno, f"{text!r} is one text: a comma is missing between two executables"
        return node.lineno, f"{text!r} names no function; write 'NAME = PACKAGE.MODULE:FUNCTION'"


def _corrections(text: str, folder: Path) -> Iterator[str]:
    """Yield corrections of a text that is no entry point.

    Args:
        folder: The root folder of the package's modules.
    """
    text = text.replace("()", "")
    yield text
    if "=" not in text:
        yield re.sub(r"^\s*([\w.-]+)\s*:\s*", r"\1 = ", text)
        return
    name, _, path = (part.strip() for part in text.partition("="))
    if (folder / path.replace(".", "/")).with_suffix(".py").is_file():
        yield f"{name} = {path}:main"
    yield f"{name} = {path.replace('/', '.')}"
    module, _, function = path.rpartition(".")
    yield f"{name} = {module}:{function}"


def _misspelt(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield misspellings of `entry_points` and `console_scripts`, which lose executables without an error."""
    for node in ast.walk(tree):
        match node:
            case ast.keyword(arg=str(name), value=ast.Dict(keys=keys)):
                if _is_slip(name, "entry_points"):
                    yield node.lineno, f"setup() has no argument {name!r}; did you mean 'entry_points'?"
                if name == "entry_points" or _is_slip(name, "entry_points"):
                    for key in keys:
                        match key:
                            case ast.Constant(value=str(group)) if _is_slip(group, "console_scripts"):
                                yield key.lineno, f"nobody reads the group {group!r}; did you mean 'console_scripts'?"


def _unimported(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yield names that `data_files` needs and nothing imports, and lists that lack a comma between two tuples."""
    nodes = list(ast.walk(tree))
    known = {alias.asname or alias.name.partition(".")[0] for alias in nodes if isinstance(alias, ast.alias)}
    known |= {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    known |= {node.name for node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    known |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    if "*" in known:
        known |= {"glob", "os"}
    for node in nodes:
        match node:
            case ast.Call(func=ast.Tuple()):
                yield node.lineno, "a comma is missing between two tuples of the list"
            case ast.Call(func=ast.Name(id="glob")) if "glob" not in known:
                yield node.lineno, "glob is not imported; write at the top: from glob import glob"
            case ast.Attribute(value=ast.Name(id="os")) if "os" not in known:
                yield node.lineno, "os is not imported; write at the top: import os"


def _is_slip(word: str, meant: str) -> bool:
    return word != meant and nearest(word, [meant], cutoff=0.8) is not None


def entry_point(text: str) -> tuple[str, EntryPoint] | None:
    """Parse an entry point, such as `go = lamp.go:main`; None if it is none."""
    found = _SCRIPT.fullmatch(text)
    return None if found is None else (found[1], EntryPoint(found[2], found[3]))


def function_fault(entry: EntryPoint, file: Path, source: str) -> str | None:
    """Return why an entry point cannot start its module, as the end of a message; None if the source shows no fault.

    Args:
        file: The file of the module.
        source: Its text.
    """
    try:
        tree, names = ast.parse(source), symtable.symtable(source, str(file), "exec").get_symbols()
    except (SyntaxError, ValueError):  # Python reports it, with its line, when the module runs
        return None
    name = entry.function.partition(".")[0]
    if any(_may_make(node, name) for node in ast.walk(tree)):
        return None
    functions = [node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
    if not {name, "__getattr__"} & {one.get_name() for one in names if one.is_assigned() or one.is_imported()}:
        return f"{file} has no function {entry.function!r}{did_you_mean(name, functions)}"
    if any(isinstance(node, ast.ClassDef) and node.name == entry.function for node in tree.body):
        return f"{entry.function} is a class: name a function that makes one and spins it, such as main"
    return None


def starts_nodes(source: str, name: str) -> bool:
    """Return whether a module has a top-level function of a name that calls anything."""
    try:
        body = ast.parse(source).body
    except (SyntaxError, ValueError):
        return False
    functions = [node for node in body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))]
    return any(one.name == name and any(isinstance(part, ast.Call) for part in ast.walk(one)) for one in functions)


def _may_make(node: ast.AST, name: str) -> bool:
    """Return whether a node of a module may define a name without showing it at the top level."""
    match node:
        case ast.alias(name="*"):
            return True
        case ast.Global(names=names):
            return name in names
        case ast.Name(id=word):
            return word in _MAKES_NAMES
    return False


def _under_console_scripts(tree: ast.Module) -> list[ast.expr]:
    dicts = (node for node in ast.walk(tree) if isinstance(node, ast.Dict))
    pairs = (pair for one in dicts for pair in zip(one.keys, one.values, strict=True))
    return [value for key, value in pairs if isinstance(key, ast.Constant) and key.value == "console_scripts"]


def _of_console_scripts(tree: ast.Module) -> Iterator[ast.AST]:
    """Yield the nodes of entry points: in a literal list, or else anywhere in a file with such a group."""
    literal = [value for value in _under_console_scripts(tree) if isinstance(value, (ast.List, ast.Tuple))]
    texts = (node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str))
    tops: list[ast.AST] = [*literal] if literal else [tree] if any("console_scripts" in text for text in texts) else []
    return (node for top in tops for node in ast.walk(top))


def constants(tree: ast.Module) -> dict[str, str]:
    """Return the names that a module assigns constant texts."""
    known: dict[str, str] = {}
    for statement in tree.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                text = constant_text(value, known)
                if text is not None:
                    known[name] = text
    return known


def constant_text(node: ast.AST, known: Mapping[str, str]) -> str | None:
    """Return the text of an expression; None if it is not constant."""
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.Name(id=name):
            return known.get(name)
        case ast.JoinedStr(values=values):
            parts = [constant_text(value, known) for value in values]
            return None if any(part is None for part in parts) else "".join(part or "" for part in parts)
        case ast.FormattedValue(value=value):
            return constant_text(value, known)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            one, other = constant_text(left, known), constant_text(right, known)
            return None if one is None or other is None else one + other
        case ast.Call(func=ast.Attribute(attr="join"), args=[_, *_] as parts):
            texts = [constant_text(part, known) for part in parts]
            return None if None in texts else os.path.join(*map(str, texts))
    return None
