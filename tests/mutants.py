"""Mutants: bounds and security checks are taken out of the source, one at a time, and a test must see each.

    python -m tests.mutants                       # all of them; takes half an hour
    python -m tests.mutants --changed             # those of files that the last commit changed
    python -m tests.mutants wire machines/cache   # those of some packages or modules

A bound is a constant of a module whose name ends with `BOUND` or begins with `LONGEST`. Its mutant reads a number
without limit wherever the module's functions read the constant; tests see the constant as it is. A check is a text of
`CHECKS`, replaced by another. Each mutant is tried on the tests of its module and on those that name it. A survivor is
printed, and makes the exit code 1.
"""

from __future__ import annotations

import ast
import re
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

PROJECT = Path(__file__).parents[1]
PACKAGE = PROJECT / "graphflow"
BOUND = re.compile(r"_?([A-Z_]*BOUND|LONGEST[A-Z_]*)\Z")
BEYOND = "(1 << 62)"
MOST_SECONDS, MOST_MEMORY = 60, 6 << 30
"""What the tests of one mutant may take; one that takes more is seen."""

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
    found = []
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign):
            targets = node.targets[0].elts if isinstance(node.targets[0], ast.Tuple) else node.targets
            found += [t.id for t in targets if isinstance(t, ast.Name) and BOUND.match(t.id)]
    return [name for name in found if _reads(source, name)]


def _reads(source: str, name: str) -> list[ast.Name]:
    """Where functions read a constant."""
    functions = [
        n for n in ast.walk(ast.parse(source)) if isinstance(n, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
    ]
    names = [n for function in functions for n in ast.walk(function) if isinstance(n, ast.Name) and n.id == name]
    return list({(n.lineno, n.col_offset): n for n in names}.values())


def _without(source: str, name: str) -> str:
    lines = [line.encode() for line in source.splitlines(keepends=True)]
    for read in sorted(_reads(source, name), key=lambda n: (n.lineno, n.col_offset), reverse=True):
        line, at = lines[read.lineno - 1], read.col_offset
        lines[read.lineno - 1] = line[:at] + BEYOND.encode() + line[at + len(name) :]
    return b"".join(lines).decode()


def tests_of(mutant: Mutant) -> list[str]:
    """The test of the module, and those that name the constant together with the module."""
    own = Path("tests", *mutant.file.parts[1:-1], f"test_{mutant.file.name}")
    found = {own.as_posix()} if (PROJECT / own).exists() else set()
    word = mutant.name if BOUND.match(mutant.name) else mutant.file.stem
    for path in (PROJECT / "tests").rglob("test_*.py"):
        text = path.read_text("utf-8")
        if word in text and mutant.file.stem in text:
            found.add(path.relative_to(PROJECT).as_posix())
    return sorted(found)


def is_seen(mutant: Mutant, copy: Path) -> bool:
    """Whether a test fails, or does not end, with the change in a copy of the project."""
    file = copy / mutant.file
    before = file.read_bytes()
    file.write_text(mutant.text, "utf-8")
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", *tests_of(mutant)]
    try:
        run = subprocess.run(
            command, cwd=copy, capture_output=True, timeout=MOST_SECONDS, check=False, preexec_fn=_limit_memory
        )
    except subprocess.TimeoutExpired:
        return True
    finally:
        file.write_bytes(before)
    return run.returncode == 1


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
