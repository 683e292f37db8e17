"""Every code block of the README and of docs/ is true: it is run, resolved and checked, or compared with real output.

The first word behind a block's fence is its kind, further words say more:

    python        run; all of a page in one module. `async def test_...(graph)` functions in it are run as tests
    yaml          a whole graph file: resolved, and checked against the classes it names
    msg, srv      an interface definition: written to its file, and parsed
    console       `$ ` and a command, then what it prints; `^C` ends a command that goes on
    sh            commands that are not run, because they install something or concern another machine
    text          anything else

    file=PATH     the block is that file of the reader's project; if the repository has it, an excerpt of it
    raises=NAME   running it raises that error
    wrong         a graph file with mistakes
    fragment      a part of a graph file
    net           a net profile
    cell          a cell of a notebook, run by test_notebooks.py
    ros2          code for ROS 2, to compare with: it must parse
    up=PATH       this graph file runs in another terminal

In console blocks `...` stands for any text in a line, and for any lines if it is alone. Spaces and numbers that differ
from run to run (times, process ids, measured values) are not compared, nor is the order of the lines of a command
that goes on, or of nodes that end.
"""

from __future__ import annotations

import ast
import asyncio
import importlib.util
import inspect
import os
import re
import select
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pytest
from pydantic import ValidationError

from graphflow.errors import GraphFileError
from graphflow.graph import params_file
from graphflow.graph.checks.check import check
from graphflow.graph.net import NetProfile
from graphflow.graph.resolve import load
from graphflow.markup.source import read
from graphflow.msgs import registry
from graphflow.supervisor.launching.classes import interfaces
from graphflow.supervisor.launching.probed import read_interfaces
from graphflow.testing import Graph
from tests.cases import slow
from tests.conftest import LIMIT, PROJECT, Machine, Program

PAGES = [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]
KINDS = {
    "python": {"file", "raises", "ros2", "cell"},
    "yaml": {"file", "wrong", "fragment", "net"},
    "xml": {"file"},
    "msg": {"file"},
    "srv": {"file"},
    "action": {"file"},
    "console": {"up"},
    "sh": set[str](),
    "text": {"file"},
}
FENCE = re.compile(r"^(?P<fence>```+|~~~+)(?P<info>[^\n]*)\n(?P<text>.*?)^(?P=fence)[ ]*$", re.MULTILINE | re.DOTALL)
LIVES_ON = re.compile(r"(graphflow|gf) (up|run) (?!.*(-d|-s|--show-args|--detach|--help)\b)")
ONLY_LOOKS = re.compile(
    r"(graphflow|gf) (node|topic (list|info)|service list|action (list|info)|param (list|get)|interface show"
    r"|ps|logs|groups|plan|check)( [^|<>$&;*]*)?"
)
"""Commands of which only the words matter: the README's are run as a reader runs them, others in this process."""

SETTLED = 10.0
"""Seconds that what was just started has to get to what a page shows."""

each_page = pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)


class Block(NamedTuple):
    """One fenced block of a page."""

    page: Path
    line: int
    """Of its first line of text."""
    kind: str
    options: dict[str, str]
    text: str

    def __str__(self) -> str:
        return f"{self.page.name}:{self.line}"


def blocks(page: Path, *kinds: str) -> list[Block]:
    """The blocks of a page; only those of some kinds if given."""
    source = page.read_text(encoding="utf-8")
    found = []
    for match in FENCE.finditer(source):
        kind, *words = match["info"].split() or [""]
        options = {word.partition("=")[0]: word.partition("=")[2] for word in words}
        line = source.count("\n", 0, match.start("text")) + 1
        if not kinds or kind in kinds:
            found.append(Block(page, line, kind, options, match["text"]))
    return found


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of what a reader's clone has, where pages put their files and modules come from."""
    root = tmp_path / "clone"
    for name in ("nodes", "graphs"):
        shutil.copytree(PROJECT / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(PROJECT / "pyproject.toml", root)
    monkeypatch.syspath_prepend(str(root))
    monkeypatch.chdir(root)
    yield root
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None)
        if file is not None and Path(file).is_relative_to(tmp_path):
            del sys.modules[name]


def write_files(page: Path, project: Path) -> None:
    """Put the page's files where it says."""
    for block in blocks(page):
        path = project / block.options.get("file", "")
        if "file" in block.options and not path.exists():
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")


def load_module(name: str, path: Path) -> ModuleType:
    """Import a file."""
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


# The pages as a whole


@each_page
def test_every_block_is_of_a_known_kind(page: Path) -> None:
    """Nothing escapes: a block without a kind, or with an option nobody reads, is a mistake."""
    assert page.read_text(encoding="utf-8").count("\n```") % 2 == 0, "a fence is not closed"
    for block in blocks(page):
        assert block.kind in KINDS, f"{block}: unknown kind {block.kind!r}"
        assert block.options.keys() <= KINDS[block.kind], f"{block}: unknown option in {block.options}"


@each_page
def test_links_lead_somewhere(page: Path) -> None:
    """Files and headings that a page links to exist."""
    for target in re.findall(r"\]\(([^)\s]+)\)", FENCE.sub("", page.read_text(encoding="utf-8"))):
        if "://" in target:
            continue
        name, _, heading = target.partition("#")
        file = page.parent / name if name else page
        assert file.exists(), f"{page.name} links to {target}"
        if heading:
            headings = re.findall(r"^#+ (.*)$", FENCE.sub("", file.read_text(encoding="utf-8")), re.MULTILINE)
            assert heading in [re.sub(r"[^\w -]", "", h.lower()).replace(" ", "-") for h in headings], target


def test_the_index_names_every_page() -> None:
    """Who begins at the index finds everything."""
    index = (PROJECT / "docs" / "index.md").read_text(encoding="utf-8")
    assert [p.name for p in PAGES[1:] if p.stem != "index" and f"({p.name})" not in index] == []


@each_page
def test_commands_in_the_text_exist(page: Path) -> None:
    """`graphflow VERB` in a sentence or table is a command that there is."""
    from graphflow.cli.main import cli

    for words in re.findall(r"`(?:graphflow|gf) ([a-z][^`]*)`", FENCE.sub("", page.read_text(encoding="utf-8"))):
        command: Any = cli
        for word in words.split():
            if not hasattr(command, "get_command"):
                break
            command = command.get_command(None, word)
            assert command is not None, f"{page.name}: graphflow {words}"


# Blocks by kind


@each_page
async def test_python(page: Path, project: Path, graphflow_runner: Any) -> None:
    """The Python of a page runs from top to bottom, and its tests pass."""
    write_files(page, project)
    source = page.read_text(encoding="utf-8").split("\n")
    lines = [""] * len(source)  # so that a traceback names the line of the page
    own: list[Block] = []
    for block in blocks(page, "python"):
        if "cell" in block.options:
            continue
        if "ros2" in block.options:
            ast.parse(block.text)
        elif "file" in block.options:
            _check_file(block, project)
        elif "raises" not in block.options:
            lines[block.line - 1 : block.line - 1 + block.text.count("\n")] = block.text.splitlines()
            own.append(block)
        else:
            path = project / f"raises_{block.line}.py"
            path.write_text("\n" * (block.line - 1) + block.text, encoding="utf-8")
            with pytest.raises(Exception) as caught:
                load_module(path.stem, path)
            assert type(caught.value).__name__ == block.options["raises"], block
    if own:
        path = project / f"page_{page.stem.replace('-', '_').lower()}.py"
        path.write_text("\n".join(lines), encoding="utf-8")
        await _run_tests(load_module(path.stem, path))


def _check_file(block: Block, project: Path) -> None:
    name = block.options["file"]
    if (PROJECT / name).exists():
        assert block.text.strip() in (PROJECT / name).read_text(encoding="utf-8"), f"{block} is no excerpt of {name}"
    elif name.startswith("tests/"):
        load_module(Path(name).stem, project / name)  # the package `tests` is taken, by this very test
    else:
        import_module(name.removesuffix(".py").replace("/", "."))


async def _run_tests(module: ModuleType) -> None:
    for name, function in vars(module).items():
        if name.startswith("test_") and inspect.iscoroutinefunction(function):
            await _run_test(function)
        elif name.startswith("test_") and hasattr(function, "hypothesis"):
            test = function.hypothesis.inner_test

            def example(graph: None, *, test: Any = test, **arguments: Any) -> None:
                asyncio.run(_run_test(test, **arguments))

            function.hypothesis.inner_test = example
            await asyncio.to_thread(function, graph=None)


async def _run_test(test: Any, **arguments: Any) -> None:
    graph = Graph()
    try:
        await test(graph=graph, **arguments)
    finally:
        await graph.close()


def _is_profile(text: str) -> bool:
    try:
        NetProfile.model_validate(read(text, "net.yaml").data)
    except ValidationError:
        return False
    return True


@each_page
def test_yaml(page: Path, project: Path) -> None:
    """Graph files resolve, and what they name is there and fits."""
    write_files(page, project)
    for block in blocks(page, "yaml"):
        if "fragment" in block.options:
            read(block.text, str(block))
            continue
        if "net" in block.options:
            assert _is_profile(block.text) != ("wrong" in block.options), block
            continue
        if block.options.get("file", "").startswith("params/"):
            assert params_file.read(project / block.options["file"], str(block))
            continue
        if "file" in block.options and (PROJECT / block.options["file"]).exists():
            text = (PROJECT / block.options["file"]).read_text(encoding="utf-8")
            assert block.text.strip() in text, f"{block} is no excerpt of {block.options['file']}"
        path = project / block.options.get("file", f"graphs/block_{block.line}.yaml")
        if not path.exists():
            path.write_text(block.text, encoding="utf-8")
        try:
            plan = load(path)
            problems = check(plan, read_interfaces(interfaces([n.class_path for n in plan.nodes])))
        except GraphFileError as error:
            problems = list(error.problems)
        assert bool(problems) == ("wrong" in block.options), f"{block}: {problems}"


@each_page
def test_definitions(page: Path, project: Path) -> None:
    """Interface definitions parse."""
    write_files(page, project)
    for block in blocks(page, "msg", "srv", "action"):
        assert registry.interface(block.options["file"].removeprefix("interfaces/").rpartition(".")[0])


LONG = {
    "README",
    "running",
    "lifecycle",
    "composition",
    "groups",
    "actions",
    "parameters",
    "graphs",
    "testing",
    "names",
    "interfaces",
    "console",
}
LONG |= {"topics", "services", "bags", "rclpy"}
"""Pages whose commands take seconds: they run with `--cases full`, as in CI."""


@pytest.mark.parametrize("page", [pytest.param(p, id=p.stem, marks=slow if p.stem in LONG else ()) for p in PAGES])
@pytest.mark.real
def test_console(page: Path, project: Path, machine: Machine, tmp_path: Path) -> None:
    """Commands print what the page shows, one after another, on a machine of the page's own."""
    write_files(page, project)
    shell = Shell(machine, project, tmp_path)
    for block in blocks(page, "console"):
        if "up" in block.options:
            shell.do(block, f"graphflow up {block.options['up']}", ["Stop with Ctrl-C."])
        for command, expected in commands(block):
            shell.do(block, command, expected)
    shell.end_living()


# A terminal that reads pages


def commands(block: Block) -> Iterator[tuple[str, list[str]]]:
    """The commands of a console block, each with the lines it prints."""
    parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)
    assert not parts[0].strip(), f"{block}: output without a command"
    for part in parts[1:]:
        command, *expected = part.rstrip().split("\n")
        while command.endswith("\\"):
            command = command[:-1] + expected.pop(0)
        yield command, expected


class Shell:
    """Runs commands where the page's files are, with `graphflow` and `python` on the path."""

    def __init__(self, machine: Machine, project: Path, tmp_path: Path) -> None:
        self.machine, self.project = machine, project
        self.living: list[Program] = []
        self.code = 0
        programs = tmp_path / "bin"
        programs.mkdir()
        texts = dict.fromkeys(("graphflow", "gf"), f"#!{sys.executable}\nfrom graphflow.cli.main import main\nmain()\n")
        texts |= dict.fromkeys(("python", "python3"), f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
        for name, text in texts.items():
            script = programs / name
            script.write_text(text)
            script.chmod(0o755)
        machine.env = self.env = {
            **machine.env,
            "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}",
            "PYTHONPATH": os.pathsep.join([str(project), str(PROJECT)]),
            "PYTHONDONTWRITEBYTECODE": "1",
        }

    def do(self, block: Block, command: str, expected: list[str]) -> None:
        """Run a command and compare; one that goes on is left running, if the page does not end it."""
        where = f"{block}: $ {command}"
        if command == "echo $?":
            assert expected == [str(self.code)], where
            return
        goes_on = LIVES_ON.match(command) is not None
        if goes_on:
            self.end_living()
        if block.page.stem != "README" and ONLY_LOOKS.fullmatch(command):
            words, until = shlex.split(command)[1:], time.monotonic() + SETTLED
            self.code, text = self.machine.look_and_end(*words, cwd=self.project)
            while time.monotonic() < until and not matches(expected, text.rstrip("\n").split("\n")):
                self.code, text = self.machine.look_and_end(*words, cwd=self.project)  # a reader types more slowly
            self._compare(command, expected, text, where)
            return
        program = self._start(command)
        if "^C" in expected:
            at = expected.index("^C")
            self._await(program, expected[:at], where)
            self.code = program.end(signal.SIGINT)
            self._await(program, expected[at + 1 :], where)
        elif goes_on:
            self._await(program, expected, where)
            if any(line.startswith("error:") for line in expected):
                self.code = program.wait()
                return
            self.living.append(program)
            if not expected:  # it is up without a word
                self.machine.until(lambda: self._start("graphflow node list").wait() == 0, where)
        else:
            self.code = program.wait()
            self._compare(command, expected, program.text, where)

    def _compare(self, command: str, expected: list[str], text: str, where: str) -> None:
        got = text.rstrip("\n").split("\n")
        if command.startswith("graphflow down") and "..." not in expected:
            expected, got = sorted(expected), sorted(got)  # nodes that do not depend on each other race
        if command.startswith("graphflow topic echo"):
            expected, got = ([re.sub(r"-?\d[-+.e\d]*", "1", line) for line in lines] for lines in (expected, got))
        assert matches(expected, got), f"{where}\nprinted\n{text}\nand not\n" + "\n".join(expected)

    def end_living(self) -> None:
        """Press Ctrl-C in every terminal where something runs."""
        while self.living:
            program = self.living.pop()
            if program.process.poll() is None:
                program.end()

    def _start(self, command: str) -> Program:
        process = subprocess.Popen(
            ["bash", "-c", command],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=self.env,
            cwd=self.project,
        )
        program = Program(process)
        self.machine._programs.append(program)
        return program

    def _await(self, program: Program, expected: list[str], where: str) -> None:
        """Read until every expected line has come, in whatever order."""
        deadline = time.monotonic() + LIMIT
        out = program.process.stdout
        assert out is not None
        while missing := [e for e in expected if e != "..." and not any(same(e, t) for t in program.text.split("\n"))]:
            ended = program.process.returncode is not None
            left = deadline - time.monotonic()
            data = b"" if ended or not select.select([out], [], [], max(0.0, left))[0] else os.read(out.fileno(), 65536)
            assert data, f"{where}\nprinted\n{program.text}\nand not\n" + "\n".join(missing)
            program.text += data.decode(errors="replace")


def matches(expected: list[str], got: list[str]) -> bool:
    """Whether lines are as expected, where the line `...` stands for any number of them."""
    if not expected:
        return not got or got == [""]
    if expected[0] == "...":
        return any(matches(expected[1:], got[i:]) for i in range(len(got) + 1))
    return bool(got) and same(expected[0], got[0]) and matches(expected[1:], got[1:])


def same(expected: str, got: str) -> bool:
    """Whether a line is as expected, where `...` stands for any text and volatile numbers for any other."""
    pattern = ".*".join(re.escape(_settled(part)) for part in expected.split("..."))
    return re.fullmatch(pattern, _settled(got)) is not None


def _settled(text: str) -> str:
    """The text without what changes from run to run."""
    text = re.sub(r"-?\d+\.\d{3,}(e[-+]\d+)?", "1.0", text)
    text = re.sub(r"domain \d+", "domain 0", re.sub(r"\d\d:\d\d:\d\d", "12:00:00", text))
    text = re.sub(r"\b\d+(\.\d\d)?( ?s)\b", r"1\2", text)
    text = re.sub(r"\b(pid|process|ready) +\d+\b", r"\1 1000", text)
    return " ".join(re.sub(r"\b\d{4,}\b", "1000", text).split())


def test_comparison_can_fail() -> None:
    """Wildcards match what they should, and words are compared."""
    assert matches(["a ... c", "...", "z 0.12 s"], ["a b c", "x", "y", "z 3.40 s"])
    assert not matches(["a", "..."], ["b", "a"])
    assert not matches(["Double value is: 5.0"], ["Double value is: 6.0"])
    assert matches(["pid 1234   ready"], ["pid 99999 ready"])
    assert matches(["/a ready 1234"], ["/a ready  913"])
