"""The hot path in instructions: counted by callgrind, over the network in memory and under a manual clock.

Counts do not depend on how busy a machine is, so CI can hold them: `python -m benchmarks.guard` fails where one has
grown by more than 3 % since `guard.json` was written, and names the functions that grew. `--update` writes the file
anew: do so in the commit that makes something faster.

Instructions differ from one build of CPython to the next. For a build that the file does not know, the opcodes of each
unit are compared in their place, which depend on the version of Python only.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections import Counter
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from types import FrameType
from typing import Any

from graphflow import Node, action, service, subscription
from graphflow.executor import runner
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.geometry_msgs.msg import Twist, Vector3
from graphflow.testing import Graph

BASELINE = Path(__file__).with_suffix(".json")
GREW = 1.03
"""How much more than the baseline is a failure; repeats differ by less than 1 %."""
REPEATS = 2
"""How often something that grew is counted again."""
MARK = "getpgid"
"""A function of libc that nothing else calls: callgrind writes down what it has counted whenever it is called."""
UNITS = 320
WARM = 100
AT_ONCE = 32
SHOWN = 5
"""Functions that are named for each unit that grew."""

Counts = dict[str, float]
Mark = Callable[[str], None]


class Heard(Node):
    """Takes messages in a coroutine and in a function, serves calls and goals."""

    @subscription(Twist, "a", qos=1000)
    async def on_a(self, message: Twist) -> None:
        self.last = message.linear.x

    @subscription(Twist, "d", qos=1000)
    def on_d(self, message: Twist) -> None:
        self.last = message.linear.x

    @service(AddTwoInts, "add")
    async def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @action(Fibonacci, "fibonacci")
    async def fibonacci(self, goal: Any) -> Fibonacci.Result:
        return Fibonacci.Result(sequence=[0, 1])


class Outbox:
    """Keeps what is sent, so that the network in memory is not counted as part of publishing."""

    is_wanted = True

    def __init__(self) -> None:
        self.sent: list[tuple[Any, bytes]] = []

    def put(self, payload: Any, *, attachment: bytes) -> None:
        self.sent.append((payload, attachment))


async def units(mark: Mark, count: int) -> None:
    """Do everything that is counted, each `count` times between two marks."""
    runner.SLICE = 1e9  # a slice is of time, of which there is much more under callgrind
    graph = Graph()
    try:
        await graph.start(Heard())
        to_async, to_def = (graph.publisher(Twist, topic, 1000) for topic in ("/a", "/d"))
        tester = graph._test_node()
        client = tester.create_client(AddTwoInts, "/add")
        goals = graph.action_client(Fibonacci, "/fibonacci")
        await graph.settle()
        message = Twist(linear=Vector3(x=1.0))
        request = AddTwoInts.Request(a=1, b=2)

        async def publish(publisher: Any, name: str, n: int) -> None:
            real, outbox = publisher._sender, Outbox()
            publisher._lengthen()
            publisher._sender, publisher._put = outbox, outbox.put
            publisher._shorten()
            mark("")
            for _ in range(n):
                publisher.publish(message)
            mark("publish")
            publisher._lengthen()
            publisher._sender, publisher._put = real, real.put
            publisher._shorten()
            for payload, attachment in outbox.sent:
                real.put(payload, attachment=attachment)
            mark("")
            await graph.settle()
            mark(f"receive, {name or 'async def'}")

        async def call(n: int) -> None:
            for _ in range(n):
                await client.call(request)

        async def goal(n: int) -> None:
            for _ in range(n):
                await (await goals.send_goal(Fibonacci.Goal(order=1))).result()

        async def run(n: int) -> None:
            await graph.clock.advance(20.0)  # goals that have ended are forgotten
            mark("")
            for _ in range(n):
                Twist(linear=Vector3(x=1.0), angular=Vector3(z=1.0))
            mark("construct a Twist")
            await publish(to_async, "", n)
            await publish(to_def, "def", n)
            mark("")
            await call(n)
            mark("call")
            await asyncio.gather(*(call(n // AT_ONCE) for _ in range(AT_ONCE)))
            mark("call, 32 at once")
            await goal(n // 10)
            mark("goal")

        await run(WARM)
        gc.collect()
        gc.freeze()
        gc.disable()
        await run(count)
    finally:
        gc.enable()
        await graph.close()


DIVISORS = {"goal": UNITS // 10}
"""How often units were done that are not done `UNITS` times."""


def per_unit(totals: dict[str, float]) -> Counts:
    """The costs of one unit each."""
    return {unit: total / DIVISORS.get(unit, UNITS) for unit, total in totals.items()}


# in the process that is measured


def child_instructions() -> None:
    """Do the units, with a mark after each; their names go to standard output, in order."""
    names: list[str] = []

    def mark(unit: str) -> None:
        os.getpgid(0)
        names.append(unit)

    asyncio.run(units(mark, UNITS))
    print(json.dumps(names))


def child_opcodes() -> None:
    """Do the units, and count the opcodes that each function carries out in them."""
    counts: Counter[str] = Counter()
    found: dict[str, Counter[str]] = {}

    def step(frame: FrameType, event: str, _: object) -> Any:
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        if event == "opcode":
            code = frame.f_code
            counts[f"{Path(code.co_filename).stem}.{code.co_qualname}"] += 1
        return step

    def mark(unit: str) -> None:
        found[unit] = counts.copy()  # of the last time: after the warming up
        counts.clear()
        sys.settrace(step)

    asyncio.run(units(mark, UNITS))
    sys.settrace(None)
    found.pop("")
    print(json.dumps(found))


# in the process that compares


def run_child(what: str, *before: str) -> str:
    """Run a process that is measured, and return the last line that it prints."""
    env = {**os.environ, "PYTHONHASHSEED": "0", "GRAPHFLOW_LOOP": "asyncio"}
    command = [*before, sys.executable, "-m", "benchmarks.guard", "--child", what]
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=600)
    if done.returncode:
        raise SystemExit(f"{' '.join(command)} failed:\n{done.stderr[-4000:]}")
    return done.stdout.splitlines()[-1]


def instructions() -> Counts:
    """Instructions of each unit."""
    with tempfile.TemporaryDirectory() as folder:
        out = f"{folder}/out"
        valgrind = ["valgrind", "--tool=callgrind", f"--dump-before={MARK}", f"--callgrind-out-file={out}", "--quiet"]
        names = json.loads(run_child("instructions", *valgrind))
        totals: dict[str, float] = {}
        for i, unit in enumerate(names, start=1):
            text = Path(f"{out}.{i}").read_text()
            counted = re.search(r"^(?:totals|summary): (\d+)", text, re.MULTILINE)
            assert counted is not None, text[-500:]
            totals[unit] = float(counted[1])  # of the last time
    totals.pop("")
    return per_unit(totals)


def opcodes() -> dict[str, Counts]:
    """Opcodes of each unit, by function."""
    found = json.loads(run_child("opcodes"))
    return {
        unit: {name: n / DIVISORS.get(unit, UNITS) for name, n in sorted(counts.items())}
        for unit, counts in found.items()
    }


def build() -> str:
    """A name for this build of CPython and this machine."""
    flags = sysconfig.get_config_var("CONFIG_ARGS") or ""
    made = f"{sys.version} {flags} {platform.libc_ver()}"
    return f"{platform.python_version()} {platform.machine()} {sha256(made.encode()).hexdigest()[:8]}"


def compare(name: str, now: Counts, before: Counts) -> list[str]:
    """Print a table; the units that grew by more than `GREW`."""
    print(f"{name:28}{'baseline':>12}{'now':>12}{'ratio':>8}")
    grew = []
    for unit, value in now.items():
        base = before.get(unit)
        if base is None:
            print(f"{unit:28}{'-':>12}{value:12.0f}")
            continue
        print(f"{unit:28}{base:12.0f}{value:12.0f}{value / base:8.3f}")
        if value > base * GREW:
            grew.append(unit)
    return grew


def blame(unit: str, now: Counts, before: Counts) -> None:
    """Name the functions that a unit's opcodes have grown in."""
    larger = sorted(((n - before.get(f, 0.0), f) for f, n in now.items()), reverse=True)[:SHOWN]
    print(f"{unit} has grown: opcodes {sum(before.values()):.0f} -> {sum(now.values()):.0f}")
    for more, function in larger:
        if more >= 0.5:
            print(f"  {more:+8.1f} {function} ({before.get(function, 0.0):.1f} -> {now[function]:.1f})")
    if not any(more >= 0.5 for more, _ in larger):
        print("  in no function of Python: in C, or by what attributes are looked up in")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--update", action="store_true", help="write the baseline anew")
    parser.add_argument("--child", choices=["instructions", "opcodes"], help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.child:
        {"instructions": child_instructions, "opcodes": child_opcodes}[given.child]()
        return 0
    baseline = json.loads(BASELINE.read_text()) if BASELINE.exists() else {"instructions": {}, "opcodes": {}}
    version = ".".join(platform.python_version_tuple()[:2])
    by_function = opcodes()
    totals = {unit: sum(counts.values()) for unit, counts in by_function.items()}
    before = baseline["opcodes"].get(version, {})
    counted = None
    if shutil.which("valgrind"):
        counted = instructions()
    else:
        print("THERE IS NO VALGRIND: opcodes are compared only (on Debian: apt install valgrind)")
    known = baseline["instructions"].get(build())
    if counted is not None and known is not None:
        for _ in range(REPEATS):  # objects lie elsewhere in memory each time: rarely a count is some per cent higher
            if all(value <= known.get(unit, value) * GREW for unit, value in counted.items()):
                break
            counted = {unit: min(value, counted[unit]) for unit, value in instructions().items()}
        grew = compare("instructions", counted, known)
    else:
        if counted is not None:
            compare("instructions", counted, {})
            print(f"this build of CPython ({build()}) is not in {BASELINE.name}: opcodes are compared")
        if not before:
            print(f"Python {version} is not in {BASELINE.name}: nothing is compared")
        grew = compare("opcodes", totals, {unit: sum(counts.values()) for unit, counts in before.items()})
    if given.update:
        if counted is not None:
            baseline["instructions"][build()] = {unit: round(n) for unit, n in counted.items()}
        baseline["opcodes"][version] = {
            unit: {name: round(n, 1) for name, n in counts.items()} for unit, counts in by_function.items()
        }
        BASELINE.write_text(json.dumps(baseline, indent=1) + "\n")
        return 0
    for unit in grew:
        blame(unit, by_function[unit], before.get(unit, {}))
    return 1 if grew else 0


if __name__ == "__main__":
    sys.exit(main())
