"""What the tests with real processes share: a machine of their own."""

from __future__ import annotations

import gc
import io
import logging
import os
import random
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import chdir, redirect_stderr, redirect_stdout
from pathlib import Path
from unittest.mock import patch

import pytest

from graphflow.cli.main import main
from graphflow.msgs import registry
from graphflow.transport.rendezvous import free_endpoint
from tests.flat import flat
from tests.until import LIMIT as LIMIT
from tests.until import until

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    # A shell starts what it puts into the background so, and what is started from there would be deaf to Ctrl-C.
    signal.signal(signal.SIGINT, signal.default_int_handler)

pytest.register_assert_rewrite(
    *(f"tests.deadlock.{name}" for name in ("deadlocked", "diary", "lookalikes", "system_runs", "verdicts")),
    *(f"tests.runtime.{name}" for name in ("action_model", "action_programs")),
)  # their assertions are as those of tests: a failure shows the values

PROJECT = Path(__file__).parents[1]
PROGRAMS = PROJECT / "tests" / "programs"
"""Node programs that tests start, in folders by kind."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """`--cases`: see `tests.cases`."""
    parser.addoption(
        "--cases", metavar="few|turn|full|N", help="how many generated cases are tried; N: so many new ones"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Tell the modules of tests, which are imported next, and keep what Python has compiled."""
    if config.getoption("--cases"):
        os.environ["GRAPHFLOW_CASES"] = config.getoption("--cases")
    if sys.dont_write_bytecode:  # each of hundreds of interpreters would compile the whole package anew
        sys.dont_write_bytecode = False
        del os.environ["PYTHONDONTWRITEBYTECODE"]
    gc.disable()  # it finds nothing while tests are collected, and goes through them all


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """With `-n auto`, three workers for two cores: tests of real processes wait."""
    config.option.dist = "worksteal"  # a few tests take long, and thousands a moment
    return -(-3 * (os.cpu_count() or 1) // 2)


def pytest_collection_finish() -> None:
    """Keep the collector from going through all that was imported and collected, in each of its runs."""
    gc.freeze()
    gc.enable()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave slow tests, and most cases of tests with many, to CI, unless single tests are asked for by name."""
    from tests.cases import few_of_many, without_slow

    if any("::" in word for word in config.args) or config.option.keyword:
        return
    quick, slow = without_slow(items)
    items[:], rest = few_of_many(quick)
    if slow or rest:
        config.hook.pytest_deselected(items=[*slow, *rest])


class Program:
    """A command under way, with its output lines as they come."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        self.process = process
        self.text = ""

    @property
    def pid(self) -> int:
        return self.process.pid

    def wait_for(self, what: str, limit: float = LIMIT) -> str:
        """Read its output until `what` is in it, wherever its lines break; returns all that was read."""
        deadline = time.monotonic() + limit
        out = self.process.stdout
        assert out is not None
        while what not in self.text and flat(what) not in flat(self.text):
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([out], [], [], left)[0]:
                raise AssertionError(f"no {what!r} within {limit} s in:\n{self.text}")
            data = os.read(out.fileno(), 65536)
            if not data:
                raise AssertionError(f"it ended ({self.process.wait(LIMIT)}) without {what!r} in:\n{self.text}")
            self.text += data.decode(errors="replace")
        return self.text

    def end(self, number: int = signal.SIGINT) -> int:
        """Signal it, and wait for its end; returns the exit code."""
        self.process.send_signal(number)
        return self.wait()

    def wait(self, limit: float = LIMIT) -> int:
        """Wait for its end and read the rest of its output; returns the exit code."""
        out, _ = self.process.communicate(timeout=limit)
        self.text += out.decode(errors="replace")
        return self.process.returncode


class Machine:
    """Commands in an environment of their own: rendezvous port, domain, run and log directories.

    Args:
        folder: For its files.
        at: A command that runs commands elsewhere, such as on another host.
    """

    def __init__(self, folder: Path, at: Sequence[str] = ()) -> None:
        self._at = at
        self.domain = random.randrange(10_000, 1_000_000)
        self.endpoint = free_endpoint()
        self.run_directory = folder / "run"
        self.run_directory.mkdir(mode=0o700)
        self.env = {
            **os.environ,
            "GRAPHFLOW_RENDEZVOUS": self.endpoint,
            "GRAPHFLOW_DOMAIN": str(self.domain),
            "XDG_RUNTIME_DIR": str(self.run_directory),
            "XDG_STATE_HOME": str(folder / "state"),
            "PYTHONUNBUFFERED": "1",
        }
        self.env.pop("ROS_LOG_DIR", None)
        self._programs: list[Program] = []

    def start(self, *words: str, cwd: Path = PROJECT) -> Program:
        """Start `graphflow WORDS`; stdout and stderr come together."""
        return self.start_python("-m", "graphflow.cli.main", *words, cwd=cwd)

    def start_python(self, *words: str, cwd: Path = PROJECT) -> Program:
        process = subprocess.Popen(
            [*self._at, sys.executable, *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=self.env,
            cwd=cwd,
        )
        program = Program(process)
        self._programs.append(program)
        return program

    def run(self, *words: str, cwd: Path = PROJECT, code: int | None = 0) -> str:
        """Run `graphflow WORDS` to its end; returns its output, and checks the exit code unless `code` is None."""
        program = self.start(*words, cwd=cwd)
        got = program.wait()
        assert code is None or got == code, f"{words} ended with {got}, not {code}:\n{program.text}"
        return program.text

    def look(self, *words: str, cwd: Path = PROJECT, code: int | None = 0) -> str:
        """Run `graphflow WORDS` in this process, which is quick, for verbs of which only the words matter.

        Environment and working directory are the machine's for that time; they, the folders of interfaces and the
        handlers of signals are as they were afterwards. What it returns and checks is as of `run`.
        """
        got, text = self.look_and_end(*words, cwd=cwd)
        assert code is None or got == code, f"{words} ended with {got}, not {code}:\n{text}"
        return text

    def look_and_end(self, *words: str, cwd: Path = PROJECT) -> tuple[int, str]:
        """As `look`; returns the exit code and the words."""
        assert not self._at, "this process is not there"
        text = io.StringIO()
        handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
        with (
            patch.dict(os.environ, self.env, clear=True),
            patch.object(sys, "argv", ["graphflow", *words]),
            patch.object(registry, "_roots", list(registry._roots)),
            patch.object(registry, "_packages", dict(registry._packages)),
            patch.object(registry, "_later", list(registry._later)),
            chdir(cwd),
            redirect_stdout(text),
            redirect_stderr(text),
            pytest.raises(SystemExit) as end,
        ):
            try:
                main(words)
            finally:
                for number, handler in handlers.items():
                    signal.signal(number, handler)
        assert isinstance(end.value.code, int)
        return end.value.code, text.getvalue()

    def until(self, condition: Callable[[], bool], what: str, limit: float = LIMIT) -> None:
        """Wait until something outside holds."""
        until(condition, what, limit)

    def close(self) -> None:
        """End whatever is left, by its own process id."""
        for run in self.run_directory.glob("graphflow/*/*/run.json"):
            subprocess.run(
                [*self._at, sys.executable, "-m", "graphflow.cli.main", "down", "--all", "--now"],
                env=self.env,
                capture_output=True,
                timeout=LIMIT,
                check=False,
            )
            assert not run.exists(), "a graph outlived its test"
        for program in self._programs:
            if program.process.poll() is None:
                program.process.kill()
            program.process.wait(LIMIT)
            if program.process.stdout is not None:
                program.process.stdout.close()


@pytest.fixture(autouse=True)
def no_log_handler_stays() -> Iterator[None]:
    """What a test has made of graphflow's log is gone with it: its stream would be closed for the next one."""
    logger = logging.getLogger("graphflow")
    handlers, level = list(logger.handlers), logger.level
    yield
    logger.handlers[:] = handlers
    logger.setLevel(level)


@pytest.fixture
def machine(tmp_path: Path) -> Iterator[Machine]:
    """A machine of its own for real processes on loopback."""
    made = Machine(tmp_path)
    yield made
    made.close()


@pytest.fixture(scope="session")
def standing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    """A machine on which one graph stands all the while, with something for every verb that looks.

    For tests that leave it as it is: `standing.look(...)` asks it without starting a process.
    """
    made = Machine(tmp_path_factory.mktemp("standing"))
    made.run("up", "-d", str(PROGRAMS / "verbs" / "standing.yaml"))
    yield made
    made.close()


def alive(pid: int) -> bool:
    """Whether a process lives; a zombie does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):  # the second if it ends between opening and reading
        return False
