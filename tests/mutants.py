"""Mutants: bounds and security checks are taken out of the source, one at a time, and a test must see each.

    python -m tests.mutants                       # all of them; takes half an hour
    python -m tests.mutants --changed             # those of files that the last commit changed, or their tests
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
"""Limits of one mutant's tests in seconds and bytes; tests that exceed them have seen it."""
_PASSED = (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)

CHECKS: dict[str, tuple[tuple[str, str], ...]] = {
    "graphflow/bag/formats/metadata.py": (('raise ValueError("it has aliases")', "pass"),),
    "graphflow/bag/reader.py": (("Path(_text(name)).name", "Path(_text(name))"),),
    "graphflow/cli/output.py": (
        ('_write(f"{harmless(text)}\\n")', '_write(f"{text}\\n")'),
        ('_write(f"{harmless(text)}\\n", flush=False)', '_write(f"{text}\\n", flush=False)'),
        ("{harmless(head)}", "{head}"),
        ("{uncoloured(text)}", "{text}"),
        ("\\x1b[2K{harmless(text)}", "\\x1b[2K{text}"),
        ("print(harmless(text), file=sys.stderr", "print(text, file=sys.stderr"),
    ),
    "graphflow/errors.py": (
        ("return harmless(text[:LONGEST_TEXT])", "return text[:LONGEST_TEXT]"),
        ("if text.isprintable():", "if True:"),
    ),
    "graphflow/folders.py": (
        ("mode=0o700", "mode=0o755"),
        ("found.st_uid != user_id() or ", ""),
    ),
    "graphflow/machines/cache.py": (
        ("if e.type.startswith(_OF_EVERY_NODE) or is_hidden(e.name)", "if e.type.startswith(_OF_EVERY_NODE)"),
    ),
    "graphflow/msgs/registry.py": (
        (
            """    name = _SAME_DEFINITIONS.get(package, package)
    if not name.isidentifier():""",
            """    name = _SAME_DEFINITIONS.get(package, package)
    if False:""",
        ),
    ),
    "graphflow/reading.py": (
        ("_refuse_others(os.stat(path), path)", "os.stat(path)"),
        ("        _refuse_others(about, path)\n", ""),
        ("not stat.S_ISREG(about.st_mode)", "False"),
    ),
    "graphflow/runtime/endpoints/shared_memory.py": (
        ("self._session.is_neighbour(reader.zid, reader.pid, reader.fd)", "True"),
    ),
    "graphflow/supervisor/control/clients.py": (
        ("printable(name[:TEXT_BOUND])", "name"),
        ("printable(text[:TEXT_BOUND])", "text"),
        ("printable(by[:TEXT_BOUND])", "by"),
    ),
    "graphflow/supervisor/control/server.py": (
        ("os.umask(0o177)", "os.umask(0)"),
        ('_peer_uid(writer.get_extra_info("socket")) in (None, user_id())', "True"),
        ("if not hmac.compare_digest(request.token.encode(), self._token.encode()):", "if False:"),
    ),
    "graphflow/supervisor/processes/worker.py": (('if job["allow_control"]:', "if True:"),),
    "graphflow/supervisor/rundir.py": (('node.strip("/").replace("/", ".")', "node"),),
    "graphflow/transport/rendezvous.py": (("parts[2] in here and parts[3] != str(user_id())", "False"),),
    "graphflow/transport/shared_memory/ring.py": (
        ('os.readlink(path) == f"/memfd:{_PROOF_NAME} {zid} (deleted)"', "os.path.exists(path)"),
        ("is_named and os.stat(path).st_uid == os.geteuid()", "is_named"),
        ("    if not _is_ring(path):\n        return None\n    try:\n        fd", "    try:\n        fd"),
        ("found.st_uid == os.geteuid() and ", ""),
        ("fcntl.fcntl(self._fd, fcntl.F_ADD_SEALS, _seals())", "_seals()"),
        ("fcntl.fcntl(fd, fcntl.F_GET_SEALS) & _seals() != _seals()", "False"),
    ),
    "graphflow/tui/feeds/log_feed.py": (('_ESCAPES.sub("", text).expandtabs(4)', "text.expandtabs(4)"),),
    "graphflow/viewer/bridge.py": (
        ("if self._is_read_only:", "if False:"),
        ("if not (is_hidden(entity.name) or is_hidden(entity.node_name)):", "if not is_hidden(entity.node_name):"),
        ("is_hidden(entity.name) or is_hidden(entity.node_name)", "is_hidden(entity.name)"),
    ),
    "graphflow/viewer/parameters.py": (("cache.services()", "cache.services(hidden=True)"),),
    "graphflow/viewer/server.py": (
        ("printable(origin[:200])", "origin"),
        ("origin not in self._pages and not PAGES.fullmatch(origin)", "False"),
    ),
    "graphflow/viewer/topics.py": (("if not is_hidden(entity.name):", "if True:"),),
    "graphflow/wire/described.py": (
        ("if digest and actual != digest:", "if False:"),
        ('len(type_.split("/")) != 3 or ', ""),
    ),
    "graphflow/wire/liveliness.py": ((" or not token.isprintable()", ""),),
    "graphflow/wire/net.py": (
        ("printable(unquote(parts[4]))", "unquote(parts[4])"),
        ("printable(unquote(parts[5]))", "unquote(parts[5])"),
    ),
    "graphflow/wire/process.py": ((" and text.isprintable()", ""),),
    "graphflow/wire/shared_memory.py": ((" and token.isprintable()", ""),),
    "graphflow/workspace/package_share.py": ((' and ".." not in parts', ""),),
}
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
    own = _test_of(mutant.file)
    found = {own.as_posix()} if (PROJECT / own).exists() else set()
    if BOUND.match(mutant.name):
        for path in (PROJECT / "tests").rglob("test_*.py"):
            text = path.read_text("utf-8")
            if mutant.name in text and mutant.file.stem in text:
                found.add(path.relative_to(PROJECT).as_posix())
    return sorted(found)


def _test_of(file: Path) -> Path:
    return Path("tests", *file.parts[1:-1], f"test_{file.name}")


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
        diff = ["git", "diff", "--name-only", "HEAD^", "--", "graphflow", "tests"]
        run = subprocess.run(diff, cwd=PROJECT, capture_output=True, text=True, check=False)
        if run.returncode:
            sys.exit(f"--changed compares with the commit before the last: {run.stderr.strip()}")
        changed = set(run.stdout.split())
        return [file for file in files if changed & {file.as_posix(), _test_of(file).as_posix()}]
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
            name = f"{mutant.file.relative_to('graphflow')} {' '.join(mutant.name.split())}"
            seen = is_seen(mutant, copy)
            why = "" if seen else SURVIVORS.get(name, "NO TEST SEES IT")
            survived += why == "NO TEST SEES IT"
            print(f"{'seen' if seen else 'survives'}  {name}{': ' * bool(why)}{why}", flush=True)
    print(f"{len(mutants) - survived} of {len(mutants)} mutants are seen, or need not be")
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
