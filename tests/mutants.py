"""Mutants: bounds and security checks are taken out of the source, one at a time, and a test must see each.

    python -m tests.mutants                       # all of them; takes half an hour
    python -m tests.mutants --changed             # those of files that the last commit changed
    python -m tests.mutants wire machines/cache   # those of some packages or modules

A bound is a constant of a module whose name ends with `BOUND` or begins with `LONGEST`. Its mutant reads a number
without limit wherever one module reads the constant; tests see the constant as it is. A check is a text of
`CHECKS`, replaced by another. Each mutant is tried on the tests of its module, and on those that name its constant. A
survivor is printed, and makes the exit code 1.
"""

from __future__ import annotations

import ast
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple

import pytest

PROJECT = Path(__file__).parents[1]
PACKAGE = PROJECT / "graphflow"
BOUND = re.compile(r"_?([A-Z_]*BOUND|LONGEST[A-Z_]*)\Z")
BEYOND = "(1 << 62)"
MOST_SECONDS, MOST_MEMORY = 60, 6 << 30
"""What the tests of one mutant may take; one that takes more is seen."""
_PASSED = (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)

CHECKS: dict[str, tuple[tuple[str, str], ...]] = {}
"""Security checks by their files: the text of each, and what takes its place."""
SURVIVORS: dict[str, str] = {}
"""Mutants that no test sees, and why that is right: `file CONSTANT` or `file text`."""


class Mutant(NamedTuple):
    """One change of the source that a test must see."""

    file: Path
    """Relative to the project."""
    name: str
    """The constant, or the text of a check."""
    text: str
    """The whole file with the change."""


def mutants_of(file: Path) -> Iterator[Mutant]:
    """The mutants of one file."""
    source = (PROJECT / file).read_text("utf-8")
    for name in _bounds(source):
        yield Mutant(file, name, _without(source, name))
    for text, other in CHECKS.get(file.as_posix(), ()):
        assert source.count(text) == 1, f"{file} has {text!r} {source.count(text)} times"
        yield Mutant(file, text, source.replace(text, other))


def _bounds(source: str) -> list[str]:
    """The bounds that a file reads, its own and those of other modules."""
    nodes = list(ast.walk(ast.parse(source)))
    found = {n.id for n in nodes if isinstance(n, ast.Name)} | {n.attr for n in nodes if isinstance(n, ast.Attribute)}
    return sorted(name for name in found if BOUND.match(name) and _reads(ast.parse(source), name))


def _reads(tree: ast.AST, name: str, *, in_text: bool = False) -> list[ast.expr]:
    """Where a constant is read, also as `module.NAME`, except to compute another constant."""
    if isinstance(tree, ast.JoinedStr) and not in_text:  # its parts have wrong places before Python 3.12
        return [tree] if _reads(tree, name, in_text=True) else []
    if isinstance(tree, ast.Assign) and all(isinstance(t, ast.Name) and BOUND.match(t.id) for t in tree.targets):
        return []
    if isinstance(tree, ast.Name) and tree.id == name and isinstance(tree.ctx, ast.Load):
        return [tree]
    if isinstance(tree, ast.Attribute) and tree.attr == name and isinstance(tree.value, ast.Name):
        return [tree]
    return [read for part in ast.iter_child_nodes(tree) for read in _reads(part, name, in_text=in_text)]


def _without(source: str, name: str) -> str:
    text = source.encode()
    starts = [0, *accumulate(len(line) + 1 for line in text.split(b"\n"))]
    for read in sorted(_reads(ast.parse(source), name), key=lambda n: (n.lineno, n.col_offset), reverse=True):
        assert read.end_lineno is not None
        assert read.end_col_offset is not None
        begin, end = starts[read.lineno - 1] + read.col_offset, starts[read.end_lineno - 1] + read.end_col_offset
        other = re.sub(rf"(\w+\.)?\b{name}\b", BEYOND, text[begin:end].decode())
        text = text[:begin] + other.encode() + text[end:]
    return text.decode()


def tests_of(mutant: Mutant) -> list[str]:
    """The test of the module, and of a bound those that name it together with the module."""
    own = Path("tests", *mutant.file.parts[1:-1], f"test_{mutant.file.name}")
    found = {own.as_posix()} if (PROJECT / own).exists() else set()
    if BOUND.match(mutant.name):
        for path in (PROJECT / "tests").rglob("test_*.py"):
            text = path.read_text("utf-8")
            if mutant.name in text and mutant.file.stem in text:
                found.add(path.relative_to(PROJECT).as_posix())
    return sorted(found)


def is_seen(mutant: Mutant, copy: Path) -> bool:
    """Whether a test fails, or does not end, with the change in a copy of the project; it must pass without it."""
    file = copy / mutant.file
    before = file.read_bytes()
    file.write_text(mutant.text, "utf-8")
    tests = tests_of(mutant)
    cases = "few"
    try:
        code, out = _run(tests, copy, cases)
        if code in _PASSED:  # of a test with many cases, only some are tried by default
            cases = "full"
            code, out = _run(tests, copy, cases)
    finally:
        file.write_bytes(before)
    if code in _PASSED:
        return False
    failed = re.search(r"^(?:FAILED|ERROR) ([^\s:]+)", out, re.MULTILINE)
    _sound((failed[1],) if failed else tuple(tests), copy, cases)
    return True


@cache
def _sound(tests: tuple[str, ...], copy: Path, cases: str) -> None:
    """Check that tests pass without a change."""
    code, out = _run(tests, copy, cases)
    if code:
        sys.exit(f"{' '.join(tests)} must pass, and within {MOST_SECONDS} s, without a mutant:\n{out[-2000:]}")


def _run(tests: Sequence[str], copy: Path, cases: str) -> tuple[int | None, str]:
    """Run tests in a copy; the exit code is None if they do not end."""
    if not tests:  # pytest would run all
        return 0, ""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", *tests]
    environment = os.environ | {
        "PYTHONPATH": str(copy),
        "GRAPHFLOW_CASES": cases,
    }  # the path for processes that tests start
    try:
        run = subprocess.run(
            command,
            cwd=copy,
            env=environment,
            capture_output=True,
            text=True,
            timeout=MOST_SECONDS,
            check=False,
            preexec_fn=_limit_memory,
        )
    except subprocess.TimeoutExpired:
        return None, ""
    return run.returncode, run.stdout


def _limit_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def chosen() -> list[Path]:
    """The files that the command line names."""
    files = [p.relative_to(PROJECT) for p in sorted(PACKAGE.rglob("*.py"))]
    if "--changed" in sys.argv:
        diff = ["git", "diff", "--name-only", "HEAD^", "--", "graphflow"]
        changed = subprocess.run(diff, cwd=PROJECT, capture_output=True, text=True, check=False).stdout.split()
        return [file for file in files if file.as_posix() in changed]
    words = [f"graphflow/{word.removeprefix('graphflow/')}" for word in sys.argv[1:]]
    return [file for file in files if not words or any(file.as_posix().startswith(word) for word in words)]


def main() -> int:
    """Try the mutants, print each with the outcome, and the score."""
    mutants = [mutant for file in chosen() for mutant in mutants_of(file)]
    survived = 0
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder)
        tracked = subprocess.run(["git", "ls-files", "-z"], cwd=PROJECT, capture_output=True, check=True).stdout
        pack = ["tar", "-c", "--null", "-T", "-"]
        packed = subprocess.run(pack, cwd=PROJECT, input=tracked, capture_output=True, check=True).stdout
        subprocess.run(["tar", "-x", "-C", folder], input=packed, check=True)
        for mutant in mutants:
            name = f"{mutant.file.relative_to('graphflow')} {mutant.name}"
            seen = is_seen(mutant, copy)
            why = "" if seen else SURVIVORS.get(name, "NO TEST SEES IT")
            survived += why == "NO TEST SEES IT"
            print(f"{'seen' if seen else 'survives'}  {name}{': ' * bool(why)}{why}", flush=True)
    print(f"{len(mutants) - survived} of {len(mutants)} mutants are seen, or need not be")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
