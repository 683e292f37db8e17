"""The real console in a real terminal: detaching, attaching, dying, hanging; the graph runs on throughout."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

from graphflow.tui.feeds.log_feed import Logs
from tests.cases import slow
from tests.conftest import Machine, alive
from tests.supervisor.running import nothing_is_left, rows, supervisor_of
from tests.tui.terminal import Terminal

pytestmark = [
    pytest.mark.real,
    pytest.mark.skipif(shutil.which("tmux") is None, reason="needs tmux; on Debian: apt install tmux"),
]

Open = Callable[..., Terminal]
COUNTING = "nodes:\n  /counting: {class: tests.programs.tui.counting:Counting}\n"


@pytest.fixture
def terminal(machine: Machine, tmp_path: Path) -> Iterator[Open]:
    opened: list[Terminal] = []

    def open_(words: str, size: tuple[int, int] = (100, 30)) -> Terminal:
        command = f"{sys.executable} -m graphflow {words}"
        opened.append(Terminal(machine, tmp_path / f"t{len(opened)}", command, size))
        return opened[-1]

    yield open_
    for one in opened:
        one.hang_up()


@pytest.fixture
def counting(machine: Machine) -> str:
    """A graph whose node writes a thousand lines a second."""
    file = machine.run_directory / "counting.yaml"
    file.write_text(COUNTING)
    (machine.run_directory / "pyproject.toml").touch()
    return str(file)


def consoles(machine: Machine) -> list[str]:
    found: list[str] = json.loads(machine.look("ls", "--json"))[0]["consoles"]
    return found


@slow
def test_leaving_and_coming_back(machine: Machine, terminal: Open, counting: str) -> None:
    """After split, verb and detach, the nodes run on; attaching restores the panes, with each line of the log once."""
    t = terminal(f"up {counting}")
    t.until("● running")
    t.until(lambda text: bool(re.search(r"number \d+", text)))
    t.press("C-b", "%")
    t.until("▌prompt")
    t.type("node list")
    t.press("Enter")
    t.until("$ graphflow node list\n")
    pid = rows(machine)["/counting"]["pid"]
    t.press("C-b", "d")
    t.until("[detached from counting: 1 node keeps running]   graphflow attach   |   graphflow down")
    t.until("ended with 0")
    assert alive(pid)
    assert consoles(machine) == []

    back = terminal("attach")
    text = back.until("enter runs this again")
    assert "▌$ node list" in text
    back.until("● running")
    assert rows(machine)["/counting"]["pid"] == pid
    other = terminal("attach")
    other.until("enter runs this again")
    machine.until(lambda: len(consoles(machine)) == 2, "both are attached")
    back.press("C-b", "S")
    back.until("Leave or stop counting, 1 node?")
    back.press("C-c", "C-c")
    back.until("Stopping ends it for the other console, too: pts/")
    back.press("s")
    back.until("graph counting is down")
    other.until("the graph has ended (down, by pts/")
    back.until("ended with 0")
    nothing_is_left(machine, [pid])

    log = next(Path(machine.env["XDG_STATE_HOME"]).glob("graphflow/counting/*/counting.log"))
    read = Logs()
    read.follow([(str(log), ("/counting",))])
    while read.read():
        pass
    numbers = [int(r.text.split()[1]) for r in read.records if r.text.startswith("number")]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    assert len(numbers) > 500


@slow
def test_a_console_that_is_killed_or_hangs_or_loses_its_terminal(
    machine: Machine, terminal: Open, counting: str
) -> None:
    """The graph is unaffected, and the commands in the console's panes end with it."""
    machine.run("up", "-d", counting)
    pid = rows(machine)["/counting"]["pid"]

    killed = terminal("attach")
    killed.until("● running")
    killed.press("C-b", '"')
    killed.until("▌prompt")
    killed.type("topic echo /number")
    killed.press("Enter")
    killed.until("data: ")
    [verb] = [p for p in psutil.Process(killed.pid).children(recursive=True) if "echo" in p.cmdline()]
    os.kill(killed.pid, signal.SIGKILL)
    machine.until(lambda: not verb.is_running() or verb.status() == psutil.STATUS_ZOMBIE, "its verb has ended")
    machine.until(lambda: consoles(machine) == [], "the supervisor has seen it go")

    hung_up = terminal("attach")
    hung_up.until("● running")
    child = hung_up.pid
    hung_up.hang_up()
    machine.until(lambda: not alive(child), "the console has ended")

    stopped = terminal("attach")
    stopped.until("● running")
    stopped.press("C-b", ":")
    stopped.until("Any verb of graphflow; or a view")  # a prompt begins with the same words
    stopped.type("echo /number")
    stopped.press("Enter")
    stopped.until(lambda text: "data: " in text)
    os.kill(stopped.pid, signal.SIGSTOP)
    try:
        log = next(Path(machine.env["XDG_STATE_HOME"]).glob("graphflow/counting/*/counting.log"))
        before = log.stat().st_size
        machine.until(lambda: log.stat().st_size > before + 100_000, "the node writes on")  # two seconds' worth
        supervisor = psutil.Process(supervisor_of(machine)["pid"])
        assert supervisor.memory_info().rss < 300e6
    finally:
        os.kill(stopped.pid, signal.SIGCONT)
    stopped.until(lambda text: "data: " in text)
    assert rows(machine)["/counting"]["pid"] == pid
    machine.look("down")
    stopped.until("the graph has ended")
    stopped.press("q")
    stopped.until("ended with 0")
    nothing_is_left(machine, [pid])


@slow
def test_several_consoles_and_sizes(machine: Machine, terminal: Open, counting: str) -> None:
    """Each console has its own windows; actions of one are reported in the other; small terminals show one pane."""
    machine.run("up", "-d", counting)
    one, two = terminal("attach"), terminal("attach", (80, 24))
    for t in (one, two):
        t.until("● running")
    machine.until(lambda: len(consoles(machine)) == 2, "both are known")
    one.press("C-b", "c")
    one.until("New window with")
    one.type("topics")
    one.press("Enter")
    one.until("std_msgs/msg/Int64")
    assert "/number" not in two.text
    one.press("C-b", "0")
    one.until("● running")
    one.press("r")
    one.until("Restart /counting?")
    one.press("r")
    two.until(lambda text: "restart /counting by pts/" in text)
    one.until(lambda text: bool(re.search(r"● running.* 1$", text, re.MULTILINE)))
    two.resize(40, 8)
    two.until(lambda text: "nodes" in text and "[all]" not in text)
    two.resize(100, 30)
    two.until(lambda text: "nodes" in text and "[all]" in text)
    machine.look("down")
    for t in (one, two):
        t.until("the graph has ended (down, by ")


def test_a_graph_that_cannot_start_says_why(machine: Machine, terminal: Open) -> None:
    """The reason is printed if no console opens, and shown in the console if nodes fail."""
    bad = machine.run_directory / "bad.yaml"
    bad.write_text("nodes:\n  /a: {clas: nodes.talker:Talker}\n")
    t = terminal(f"up {bad}")
    t.until("did you mean 'class'?")
    t.until("ended with 2")


@slow
def test_nodes_of_others(machine: Machine, terminal: Open) -> None:
    """Without a supervisor of ours, the console shows what it can, and says what it cannot do."""
    node = machine.start("run", "nodes.talker:Talker")
    node.wait_for("Publishing")
    t = terminal("attach")
    t.until("◆ not ours")
    t.until("no supervisor here")
    t.press("q")
    t.until("its nodes keep running]")
    node.end()


@slow
def test_back_to_the_shell_and_on(machine: Machine, terminal: Open, counting: str) -> None:
    """Ctrl-Z gives the terminal to the shell; `fg` restores the screen and all keys, twice; q still leaves."""
    machine.run("up", "-d", counting)
    t = terminal("--version; PS1='READY> ' bash --norc --noprofile -i")
    t.until("READY>")
    t.type(f"{sys.executable} -m graphflow attach")
    t.press("Enter")
    for _ in range(2):
        t.until("● running")
        t.press("C-z")
        t.until(lambda text: "Stopped" in text and "● running" not in text)
        t.type("fg")
        t.press("Enter")
    t.until("● running")
    t.press("C-b", "w")
    t.until("Windows and panes")
    t.press("Escape")
    t.until(lambda text: "Windows and panes" not in text)
    t.press("q")
    t.until("[detached from counting: 1 node keeps running]")
    machine.look("down")


def test_waiting_never_ends_in_silence(machine: Machine, terminal: Open) -> None:
    """If nothing runs, the exit code is 3, and the text says what to type."""
    t = terminal("attach")
    t.until("no graph is running; start one with: graphflow up GRAPH.yaml")
    t.until("ended with 3")


@slow
def test_the_tour_of_the_deadlocks(machine: Machine, terminal: Open) -> None:
    """The tour says what to press: f ends the deadlock, n goes to the next; nothing is left running."""
    t = terminal("demo deadlock self_call")
    t.until("tour 1/1 self_call")
    t.until("f  end it")
    t.press("f")
    t.until("It moves again")
    t.until("1 + 2 = 3")
    t.press("n")
    t.until("the tour is over, and its graph is down")
    t.until("ended with 0")
    assert not list(machine.run_directory.glob("graphflow/*/*/run.json"))
