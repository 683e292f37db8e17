"""How long whole commands take with a graph of 20 nodes, beside a bare interpreter in the same rounds.

Goals, in milliseconds: `--version` 50, verbs that list and TAB 80, `param get` 100, the first line of `echo` 150.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.rounds import compare, goal
from benchmarks.startup import own_machine, whole

GRAPHFLOW = [sys.executable, "-m", "graphflow"]
GRAPH = """
nodes:
  /talker: {class: nodes.talker:Talker, params: {rate: 1000.0}}
"""
NODE = "  /n{n}/listener: {{class: nodes.listener:Listener, remap: {{chatter: /n{n}/chatter}}}}\n"
LISTS = ("topic list", "node list", "service list", "action list", "param list /talker", "topic info /chatter")


def first_line() -> float:
    """Milliseconds until `topic echo` has printed something."""
    began = time.perf_counter()
    words = [*GRAPHFLOW, "topic", "echo", "/chatter"]
    echo = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    assert echo.stdout is not None
    echo.stdout.readline()
    took = (time.perf_counter() - began) * 1000
    echo.terminate()
    echo.communicate(timeout=20)
    return took


def tab() -> float:
    """Milliseconds of what TAB runs behind `graphflow topic echo /ch`."""
    began = time.perf_counter()
    words = [*GRAPHFLOW, "completion", "words", "--", "graphflow topic echo /ch"]
    done = subprocess.run(words, stdout=subprocess.PIPE, check=True)
    assert b"/chatter" in done.stdout, done.stdout
    return (time.perf_counter() - began) * 1000


def quietly(*words: str) -> None:
    """Run a command without its talk."""
    subprocess.run([*GRAPHFLOW, *words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def main() -> None:
    own_machine()
    file = Path(tempfile.mkdtemp()) / "twenty.yaml"
    file.write_text(GRAPH + "".join(NODE.format(n=n) for n in range(19)))
    quietly("up", "-d", str(file))
    try:
        measured = {f"graphflow {verb}": lambda verb=verb: whole(*GRAPHFLOW, *verb.split()) for verb in LISTS}
        found = compare(
            {
                "python -c pass": lambda: whole(sys.executable, "-c", "pass"),
                "python -c 'import click, zenoh'": lambda: whole(sys.executable, "-c", "import click, zenoh"),
                "graphflow --version": lambda: whole(*GRAPHFLOW, "--version"),
                **measured,
                "TAB": tab,
                "graphflow param get": lambda: whole(*GRAPHFLOW, "param", "get", "/talker", "rate"),
                "graphflow topic echo, first line": first_line,
            },
            rounds=15,
            unit="ms",
            baseline="python -c pass",
        )
        limits = {"graphflow --version": 50, **dict.fromkeys([*measured, "TAB"], 80)}
        limits |= {"graphflow param get": 100, "graphflow topic echo, first line": 150}
        for name, limit in limits.items():
            goal(f"{name}, ms", found[name][0], limit)
    finally:
        quietly("down")


if __name__ == "__main__":
    main()
