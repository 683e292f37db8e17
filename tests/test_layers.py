"""The layers: which package may import which, who knows which library, and that no files import in a circle."""

from __future__ import annotations

import ast
from collections import deque
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.cases import slow

PACKAGE = Path(__file__).parents[1] / "graphflow"

PURE = (
    *("errors", "typographic", "names", "qos", "times", "interface", "system", "domain", "reading"),
    *("wire", "msgs", "machines"),
)
"""Decides: it neither waits, nor looks at a clock, nor logs, nor reads files or the environment."""
FILES = ("folders", "workspace", "markup", "launchfiles", "console", "graph", "analysis")
"""Reads files and the environment; nothing that waits."""
RUNTIME = ("transport", "executor", "deadlock", "runtime")
"""Where waiting happens."""
TOOLS = (
    "tf",
    "maps",
    "introspect",
    "description",
    "simulator",
    "bag",
    "viewer",
    "supervisor",
    "testing",
    "nodes",
    "rclpy",
)
ENTRY_POINTS = ("cli", "tui")
PACKAGES = (*PURE, *FILES, *RUNTIME, *TOOLS, *ENTRY_POINTS)
"""From the bottom up: a package imports itself and those before it. No entry point imports another."""

ONLY_IN = {
    "zenoh": ("transport",),
    "textual": ("tui",),
    "click": ("cli",),
    "websockets": ("viewer",),
    "rosbags": ("bag",),
    "mujoco": ("simulator",),
    "PIL": ("maps", "introspect"),
    "xacro": ("description",),
    "rerun": ("viewer",),
}
"""Libraries that one package knows."""

OPENS = {"cli/graphs/console.py": ("graphflow.tui.main", "graphflow.tui.web")}
"""The one file through which the command line opens the console, and what of it."""

WAITING = (
    *("asyncio", "threading", "concurrent", "multiprocessing", "socket", "selectors", "subprocess"),
    *("time", "random", "logging"),
)
"""Neither the pure layer nor the file layer imports these."""
OUTSIDE = ("os", "shutil", "io", "tempfile", "glob")
"""Nor the pure layer these."""
IMPURE = {
    "domain.py": "reads the variables that every command and process shares",
    "system.py": "asks which system this is",
    "reading.py": "opens files for all others, and only regular ones",
    "wire/process.py": "writes and reads what processes say of themselves",
    "wire/profile.py": "reads the variable that chooses a distribution",
    "analysis/user_code.py": "compares frames with those of asyncio's own loop",
    "launchfiles/python/stand_ins.py": "is imported by a process that runs a launch file",
}
"""Files that break one of these two rules, and why."""

PRINTS = "cli/output.py"
"""The only file that prints."""


class Import(NamedTuple):
    """One module named by an import statement, or by `import_module` with a literal name."""

    line: int
    module: str


def statements(tree: ast.AST) -> Iterator[ast.AST]:
    """Every statement of a file, which is a fifth of its nodes."""
    todo = [tree]
    while todo:
        node = todo.pop()
        yield node
        for _, value in ast.iter_fields(node):
            if isinstance(value, list):
                todo += [part for part in value if isinstance(part, (ast.stmt, ast.excepthandler, ast.match_case))]


@cache
def imports(text: str, package: str) -> list[Import]:
    """Every import of a file, those hidden inside functions too; three tests ask for those of all files.

    Args:
        package: The package of the file, which relative imports start from.
    """
    tree, found = ast.parse(text), list[Import]()
    for node in ast.walk(tree) if "import_module" in text or "__import__" in text else statements(tree):
        if isinstance(node, ast.Import):
            found += [Import(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            above = ".".join(package.split(".")[: len(package.split(".")) + 1 - node.level]) if node.level else ""
            base = ".".join(part for part in (above, node.module) if part)
            # `from graphflow import msgs` names a package, `from graphflow.names import split` does not.
            found += [Import(node.lineno, f"{base}.{alias.name}") for alias in node.names]
        elif isinstance(node, ast.Call) and _called(node) in ("import_module", "__import__"):
            found += [Import(node.lineno, str(a.value)) for a in node.args[:1] if isinstance(a, ast.Constant)]
    return found


def _called(call: ast.Call) -> str:
    return call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")


def broken_rules(text: str, file: str) -> list[str]:
    """The rules that one file breaks, each as `file:line: what`.

    Args:
        file: The file, relative to the package.
    """
    parts = Path(file).with_suffix("").parts
    if parts in (("__init__",), ("__main__",)):  # the facade above all packages; tests/test_exports.py holds it
        return []
    package = parts[0]
    if package not in PACKAGES:
        return [f"{file}:1: {package!r} has no layer; add it to a table in {Path(__file__).name}"]
    allowed = OPENS.get(file, ())
    used = [i for i in imports(text, ".".join(("graphflow", *parts[:-1]))) if i.module not in allowed]
    found = [(i.line, fault) for i in used if (fault := _fault(package, i.module, is_pure=file not in IMPURE))]
    if file != PRINTS and "print(" in text:
        calls = [n for n in ast.walk(ast.parse(text)) if isinstance(n, ast.Call) and _called(n) == "print"]
        found += [(n.lineno, f"only {PRINTS} prints; use output.data or output.talk") for n in calls]
    return [f"{file}:{line}: {fault}" for line, fault in sorted(found)]


def _fault(package: str, module: str, *, is_pure: bool) -> str | None:
    top, *rest = module.split(".")
    if top != "graphflow":
        if top in ONLY_IN and package not in ONLY_IN[top]:
            return f"{package} imports {top}, which only {', '.join(ONLY_IN[top])} may know"
        if is_pure and package in (*PURE, *FILES) and top in WAITING:
            return f"{package} imports {top}; neither the pure nor the file layer waits, logs or looks at a clock"
        if is_pure and package in PURE and top in OUTSIDE:
            return f"{package} imports {top}; the pure layer reads neither files nor the environment"
        return None
    other = rest[0] if rest else ""
    if other not in PACKAGES:
        if package not in (*PURE, *FILES) and other == "__version__":
            return None
        return f"{package} imports {module}, the facade above it; import from where it is defined"
    if other != package and package in ENTRY_POINTS and other in ENTRY_POINTS:
        return f"the entry point {package} imports the entry point {other}"
    if PACKAGES.index(other) > PACKAGES.index(package):
        return f"{package} imports {other}, which is above it; imports only go down"
    return None


def test_exceptions_are_needed() -> None:
    """A file that no longer breaks a rule of purity is taken from the list."""
    for file in IMPURE:
        names = {i.module.split(".")[0] for i in imports((PACKAGE / file).read_text("utf-8"), "graphflow")}
        assert names & {*WAITING, *OUTSIDE}, file


def test_every_import_goes_down() -> None:
    """No file breaks a rule of the layers."""
    faults = [
        fault
        for path in sorted(PACKAGE.rglob("*.py"))
        for fault in broken_rules(path.read_text(encoding="utf-8"), path.relative_to(PACKAGE).as_posix())
    ]
    assert not faults, "\n" + "\n".join(faults)


def test_every_package_has_a_layer() -> None:
    """The tables name every module and folder, so that none escapes the rules."""
    there = {p.stem for p in PACKAGE.iterdir() if p.suffix == ".py" or (p / "__init__.py").exists()}
    assert there - {"__init__", "__main__"} <= set(PACKAGES)


LONGEST_FILE = 450
"""Lines of a file of the package, at most."""
LONGER = {
    "runtime/node.py": "one class: all that users call on a node",
}
"""Files of up to 500 lines, and why they are not divided."""


def import_graph(files: Mapping[str, str]) -> dict[str, set[str]]:
    """Which modules each module imports, type-only imports and those inside functions included.

    Args:
        files: The text of each module by its name, as in `graphflow.wire.cdr.codec`.
    """
    found: dict[str, set[str]] = {}
    for module, text in files.items():
        package = module if any(other.startswith(f"{module}.") for other in files) else module.rpartition(".")[0]
        named = {i.module for i in imports(text, package)}
        # `from graphflow.wire import idl` names a module, `from graphflow.wire.idl import parse` something in one.
        found[module] = {name if name in files else name.rpartition(".")[0] for name in named} & set(files) - {module}
    return found


def at_run_time(text: str) -> str:
    """A file without what only type checkers read."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            node.body = [ast.Pass()]
    return ast.unparse(tree)


def shortest_circle(graph: Mapping[str, set[str]]) -> list[str]:
    """The modules of the shortest circle of imports, in order; empty if there is none."""
    circles = []
    for start in sorted(graph):
        came_from: dict[str, str] = {}
        todo = deque([start])
        while todo and start not in came_from:
            module = todo.popleft()
            for other in sorted(graph[module]):
                if other not in came_from:
                    came_from[other] = module
                    todo.append(other)
        if start in came_from:
            circle = [start]
            while (before := came_from[circle[-1]]) != start:
                circle.append(before)
            circles.append(circle[::-1])
    return min(circles, key=len, default=[])


@slow
def test_no_files_import_each_other_in_a_circle() -> None:
    """Nowhere in the package, whichever way the import is written.

    The classes of rclpy name each other in signatures, as ROS 2's do: there, imports for type checkers do not count.
    """
    files = {}
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
        if "site" in parts:
            parts, text = parts[parts.index("site") + 1 :], at_run_time(text)  # imported under ROS's names
        files[".".join(parts).removesuffix(".__init__")] = text
    circle = shortest_circle(import_graph(files))
    assert not circle, "a circle of imports: " + " -> ".join([*circle, circle[0]])


@pytest.mark.parametrize(
    ("files", "circle"),
    [
        ({"p": "", "p.a": "import p.b", "p.b": ""}, []),
        ({"p": "", "p.a": "import p.b", "p.b": "import p.a"}, ["p.b", "p.a"]),
        ({"p": "", "p.a": "from p.b import x", "p.b": "from p import a"}, ["p.b", "p.a"]),
        ({"p": "", "p.a": "def f():\n    from .b import x", "p.b": "from .a import y"}, ["p.b", "p.a"]),
        ({"p": "", "p.a": "if TYPE_CHECKING:\n    from p.b import x", "p.b": "from p.a import y"}, ["p.b", "p.a"]),
        ({"p": "", "p.a": "import_module('p.b')", "p.b": "from p.a import y"}, ["p.b", "p.a"]),
        ({"p": "from p.a import x", "p.a": "from p import y"}, ["p.a", "p"]),
        (
            {"p.a": "import p.b", "p.b": "import p.c", "p.c": "import p.a\nimport p.d", "p.d": "import p.c"},
            ["p.d", "p.c"],
        ),
    ],
)
def test_a_planted_circle_is_found(files: dict[str, str], circle: list[str]) -> None:
    """Of several, the shortest; in whichever way it is hidden."""
    assert shortest_circle(import_graph(files)) == circle


def test_no_file_is_too_long() -> None:
    """One idea a file; one that needs more lines has two."""
    lengths = {p.relative_to(PACKAGE).as_posix(): len(p.read_text("utf-8").splitlines()) for p in PACKAGE.rglob("*.py")}
    long = {file: n for file, n in lengths.items() if n > LONGEST_FILE}
    assert {*long} == {*LONGER}
    assert max(long.values()) <= 500


def test_every_module_has_a_test_of_its_name() -> None:
    """`graphflow/a/b.py` is tested by `tests/a/test_b.py`, so that both are found by the name of one."""
    files = [p for p in PACKAGE.rglob("*.py") if not p.stem.startswith("__")]
    modules = [p.relative_to(PACKAGE) for p in files if not p.name.endswith("launch.py")]  # run by tests of `launch`
    tests = Path(__file__).parent
    assert not [m.as_posix() for m in modules if not (tests / m.parent / f"test_{m.name}").exists()]


@pytest.mark.parametrize(
    ("file", "text", "fault"),
    [
        ("names.py", "import graphflow.qos", "names imports qos, which is above it; imports only go down"),
        ("wire/cdr/codec.py", "from graphflow.msgs import registry", "wire imports msgs, which is above it"),
        ("wire/cdr/codec.py", "from graphflow import msgs", "wire imports msgs, which is above it"),
        ("wire/cdr/codec.py", "from ...msgs.base import Message", "wire imports msgs, which is above it"),
        ("wire/__init__.py", "from ..msgs import base", "wire imports msgs, which is above it"),
        ("graph/check.py", "def f():\n    from graphflow.runtime.node import Node", "graph imports runtime"),
        ("graph/check.py", "import_module('graphflow.runtime.node')", "graph imports runtime"),
        ("graph/check.py", "importlib.import_module('zenoh')", "graph imports zenoh, which only transport may know"),
        ("runtime/node.py", "import zenoh.handlers", "runtime imports zenoh, which only transport may know"),
        ("cli/main.py", "from textual import app", "cli imports textual, which only tui may know"),
        ("tui/app.py", "import click", "tui imports click, which only cli may know"),
        ("tui/app.py", "from graphflow.cli import output", "the entry point tui imports the entry point cli"),
        ("cli/main.py", "from graphflow.tui import app", "the entry point cli imports the entry point tui"),
        ("runtime/node.py", "from graphflow import Node", "runtime imports graphflow.Node, the facade above it"),
        ("runtime/node.py", "import graphflow", "runtime imports graphflow, the facade above it"),
        ("runtime/node.py", "print('hello')", "only cli/output.py prints"),
        ("extras/new.py", "", "'extras' has no layer"),
        *((f"graph/{i}.py", f"def f():\n    import {name}", f"graph imports {name}") for i, name in enumerate(WAITING)),
        *(("names.py", f"import {name}", f"names imports {name}") for name in (*WAITING, *OUTSIDE)),
    ],
)
def test_a_planted_violation_is_seen(file: str, text: str, fault: str) -> None:
    """The check itself sees each kind of violation, and names file, line and rule."""
    line = text.count("\n") + 1
    (found,) = broken_rules(text, file)
    assert found.startswith(f"{file}:{line}: {fault}")


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("cli/output.py", "print('hello')"),
        ("cli/main.py", "from graphflow import __version__\nimport click\nfrom graphflow.runtime.node import Node"),
        ("transport/zenoh.py", "import zenoh, asyncio\nfrom graphflow.wire import cdr"),
        ("wire/cdr/codec.py", "import struct\nfrom .schema import Field\nfrom graphflow.names import split"),
        ("supervisor/launch.py", "import graphflow.supervisor.supervisor\nimport time"),
    ],
)
def test_what_is_allowed_passes(file: str, text: str) -> None:
    """Imports of the same package, of those below, and of one's own library are no violation."""
    assert broken_rules(text, file) == []
