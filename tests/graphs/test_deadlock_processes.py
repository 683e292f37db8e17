"""Deadlocks between real processes: rings over Zenoh, members that die or stand still, and advice that is followed.

The tests go through those rows of the matrix of the concurrency design that are about processes; "row 5" in a
docstring is its number there. A node waits at its gate until the test opens it, so that rings close when they should.
"""

from __future__ import annotations

import json
import logging
import os
import re
import signal
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.conftest import Machine, Program

pytestmark = pytest.mark.real

logger = logging.getLogger(__name__)

RING = '''
import asyncio
import ctypes
import os
from pathlib import Path
from typing import Any

from graphflow import ActionClient, CallError, Client, GoalCanceled, Group, Node, Param, action, service, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_srvs.srv import Trigger

HERE = Path(__file__).parent


class Gated(Node):
    async def pass_gate(self) -> None:
        while not (HERE / f"open{self.full_name.replace('/', '.')}").exists():
            await self.clock.sleep(0.01)


class Member(Gated):
    """Asks the next one, from the group in which it answers."""

    work = Group(1)
    following = Client(Trigger, "following")
    limit = Param(0.0)
    has_asked = False

    @timer(0.1, group=work)
    async def ask(self) -> None:
        if self.has_asked:
            return
        self.has_asked = True
        self.log.info("is at it (%s)", self.context.session.zid)
        await self.pass_gate()
        self.log.info("asks")
        try:
            await self.toil()
            self.log.info("was answered")
        except CallError as error:
            self.log.warning("%s: %s", type(error).__name__, error)

    async def toil(self) -> None:
        await self.following.call(Trigger.Request(), timeout=self.limit or None)  # stuck: Member

    @service(Trigger, "~/answer", group=work)
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Canceller(Member):
    """Can be told to wait no more."""

    async def toil(self) -> None:
        self.asking = asyncio.ensure_future(self.following.call(Trigger.Request(), timeout=None))
        await asyncio.wait([self.asking])  # stuck: Canceller

    @service(Trigger, "~/give_up")
    async def give_up(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=self.asking.cancel())


class Boss(Member):
    """Asks two at once, or is one of those whom the boss asks, and then asks it back."""

    def __init__(self, name: str | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        others = [other for other in "abc" if f"/{other}" != self.full_name]
        self.orders = [self.create_client(Trigger, f"/{other}/obey") for other in others]
        self.answers = {other: self.create_client(Trigger, f"/{other}/answer") for other in others}

    async def toil(self) -> None:
        await asyncio.gather(*(order.call(Trigger.Request(), timeout=None) for order in self.orders))

    @service(Trigger, "~/obey")
    async def obey(self, request: Trigger.Request) -> Trigger.Response:
        [boss] = HERE.glob("open.*")
        return await self.answers[boss.suffix[1:]].call(Trigger.Request(), timeout=None)


class Echo(Node):
    """Asks back whoever asks it."""

    back = Client(Trigger, "back")

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return await self.back.call(Trigger.Request(), timeout=None)  # stuck: Echo


class Blocker(Node):
    """Waits for an answer on the event loop."""

    following = Client(Trigger, "following")

    @timer(0.3)
    def ask(self) -> None:
        self.following.call_sync(Trigger.Request(), timeout=None)  # stuck: Blocker
        self.log.info("was answered")

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=True)


class Slow(Gated):
    """Serves one after the other."""

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        self.log.info("serves")
        await self.pass_gate()
        return Trigger.Response(success=True)


class Sleepy(Node):
    """Holds its event loop while it serves, until the test writes to a pipe."""

    @service(Trigger, "~/answer")
    async def answer(self, request: Trigger.Request) -> Trigger.Response:
        self.log.info("serves")
        self.hold()
        return Trigger.Response(success=True)

    def hold(self) -> None:
        os.open(HERE / "pipe", os.O_RDONLY)  # held: Sleepy


class Greedy(Sleepy):
    """Holds the interpreter, too, so that no thread of the process runs."""

    def hold(self) -> None:
        ctypes.PyDLL(None).open(bytes(HERE / "pipe"), os.O_RDONLY)  # held: Greedy


class Customer(Member):
    """Waits for a goal in the group in which it tells where it is."""

    order = ActionClient(Fibonacci, "order")

    async def toil(self) -> None:
        self.sent = await self.order.send_goal(Fibonacci.Goal(order=1))
        try:
            await self.sent.result()  # stuck: Customer
        except GoalCanceled:
            self.log.info("cancelled")

    @service(Trigger, "~/give_up")
    async def give_up(self, request: Trigger.Request) -> Trigger.Response:
        return Trigger.Response(success=await self.sent.cancel())


class Courier(Node):
    """Asks its customer for the way."""

    position = Client(Trigger, "position")

    @action(Fibonacci, "order")
    async def deliver(self, goal: Fibonacci.Handle) -> Fibonacci.Result:
        await self.position.call(Trigger.Request(), timeout=None)  # stuck: Courier
        return Fibonacci.Result()
'''


class Lab:
    """A user's own project, on a machine of its own."""

    def __init__(self, machine: Machine, root: Path) -> None:
        self.machine, self.root = machine, root
        (root / "nodes").mkdir(parents=True)
        (root / "pyproject.toml").touch()
        (root / "nodes" / "ring.py").write_text(RING)

    def write(self, nodes: dict[str, str], *, policy: str = "report", name: str = "lab") -> str:
        """Write a graph of these nodes; calls that say nothing else wait for ever."""
        lines = "".join(f"  {node}: {{{about}}}\n" for node, about in nodes.items())
        (self.root / f"{name}.yaml").write_text(f"deadlock: {policy}\ncall_timeout: never\nnodes:\n{lines}")
        return f"{name}.yaml"

    def up(self, nodes: dict[str, str], *, policy: str = "report") -> Program:
        return self.machine.start("up", self.write(nodes, policy=policy), cwd=self.root)

    def up_fixed(self, lines: str) -> Program:
        """Start the graph with some lines changed."""
        (self.root / "fixed.yaml").write_text(f"include: lab.yaml\noverride:\n{lines}\n")
        return self.machine.start("up", "fixed.yaml", cwd=self.root)

    def open_gates(self, *names: str) -> None:
        for name in names:
            (self.root / "nodes" / f"open.{name}").touch()

    def ring(self, names: str, *, policy: str = "report") -> Program:
        """Close a ring of processes."""
        up = self.up(ring_of(names), policy=policy)
        wait_for_all(up, at_it(names))
        self.open_gates(*names)
        return up

    def pids(self) -> dict[str, int]:
        return {row["node"]: row["pid"] for row in json.loads(self.machine.run("ps", "--json"))}

    def call(self, service: str) -> None:
        assert "success=True" in self.machine.run("service", "call", service, "std_srvs/srv/Trigger")


@pytest.fixture
def lab(machine: Machine, tmp_path: Path) -> Lab:
    return Lab(machine, tmp_path / "lab")


def ring_of(names: str, cls: str = "Member") -> dict[str, str]:
    """Members of which each asks the next, and the last the first."""
    pairs = zip(names, names[1:] + names[0], strict=True)
    return {f"/{name}": member(next_one, cls) for name, next_one in pairs}


def member(following: str, cls: str = "Member", more: str = "") -> str:
    return f"class: nodes.ring:{cls}, remap: {{following: /{following}/answer}}{more}"


def echo_of(name: str) -> str:
    return f"class: nodes.ring:Echo, remap: {{back: /{name}/answer}}"


def at_it(names: str) -> list[str]:
    return [f"[{name}]: is at it" for name in names]


def answered(names: str) -> list[str]:
    return [f"[{name}]: was answered" for name in names]


def wait_for_all(up: Program, texts: list[str]) -> None:
    for text in texts:
        up.wait_for(text)


def line_of(marker: str, code: str = RING) -> int:
    [line] = [number for number, text in enumerate(code.splitlines(), 1) if text.endswith(f"# {marker}")]
    return line


def at(marker: str) -> str:
    """How a report tells the line that ends with the marker."""
    return f"(ring.py:{line_of(marker)} in "


def wait_for_ring(up: Program, names: str) -> None:
    """Wait until the ring has been reported, every member with its line."""
    up.wait_for(f"DEADLOCK: {len(names)} callbacks wait for each other in a ring")
    line = f"{at('stuck: Member')}toil, since "
    for name, other in zip(names, names[1:] + names[0], strict=True):
        up.wait_for(
            f"timer ask of /{name} holds group 'work' and waits for the answer of service /{other}/answer   {line}"
        )
        up.wait_for(f"service answer of /{other} waits for group 'work' of /{other}, which timer ask of /{other} holds")
    up.wait_for("release the slot while waiting, in ring.py:")


def zids(up: Program) -> dict[str, str]:
    """The ids of the members' processes; of those who find a ring, the first reports it."""
    return dict(re.findall(r"\[(\w)\]: is at it \((\w+)\)", up.text))


def reporter(up: Program) -> str:
    """The node in whose log the report stands."""
    found = re.search(r"(?m)^(\w+) +\| \[ERROR\] \[\S+\] \[graphflow\]: DEADLOCK", up.text)
    assert found is not None
    return found[1]


def reports(*texts: str) -> list[str]:
    """The headlines of the deadlocks that were told."""
    return [headline for text in texts for headline in re.findall(r"\[graphflow\]: ((?:LIKELY )?DEADLOCK: .*)", text)]


def seconds_to_report(text: str) -> float:
    """From the call that closed the ring to the report, by the times in the log."""

    def times(what: str) -> list[float]:
        return [float(when) for when in re.findall(rf"\[(\d+\.\d+)\] \[\w+\]: {what}", text)]

    return min(times("DEADLOCK")) - max(times("asks"))


# Rings


@pytest.mark.parametrize(("names", "policy"), [("ab", "raise"), ("abc", "report")])
def test_a_ring_of_processes(lab: Lab, names: str, policy: str) -> None:
    """One of them reports it, no call is failed for it, and moving a handler lets all go on (rows 3, 4, 6, 29)."""
    up = lab.ring(names, policy=policy)
    wait_for_ring(up, names)
    logger.info("%s: told after %.3f s", names, seconds_to_report(up.text))

    told = lab.machine.run("groups", "move", "/a", "answer", "answer_group")
    assert "  /a: {concurrency: {answer_group: [answer]}}" in told
    wait_for_all(up, [*answered(names), "has cleared"])
    assert up.end() == 0
    assert len(reports(up.text)) == 1
    assert up.text.count("has cleared") == 1
    assert "DeadlockError" not in up.text


def test_members_that_answer_in_a_group_of_its_own(lab: Lab) -> None:
    """The same calls are answered, and nothing is reported (row 4)."""
    nodes = {name: f"{about}, concurrency: {{answers: [answer]}}" for name, about in ring_of("ab").items()}
    up = lab.up(nodes)
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    wait_for_all(up, answered("ab"))
    assert up.end() == 0
    assert reports(up.text) == []


def test_a_ring_that_is_closed_late(lab: Lab) -> None:
    """However long its members have waited, it is told soon after the last one has begun to."""
    up = lab.up(ring_of("abc"))
    wait_for_all(up, at_it("abc"))
    first = min("abc", key=zids(up).__getitem__)
    closing = "abca"["abc".index(first) + 1]
    lab.open_gates(*{"a", "b", "c"} - {closing})
    up.wait_for(f"[{first}]: asks")
    # Meanwhile it looks at its wait after 0.25, 0.5, 1 and 2 s; the next look would be after 4 s.
    with pytest.raises(AssertionError, match=r"within 2\.2 s"):
        up.wait_for("DEADLOCK", limit=2.2)

    lab.open_gates(closing)
    up.wait_for("DEADLOCK: 3 callbacks wait for each other in a ring")
    up.wait_for(f"[{closing}]: asks")
    assert seconds_to_report(up.text) < 1.0


def test_a_chain_that_comes_back_to_its_caller(lab: Lab) -> None:
    """The innermost call fails at once, and its error travels back through the other process (row 5)."""
    up = lab.up({"/a": member("b"), "/b": echo_of("a")}, policy="raise")
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("[a]: DeadlockError: /a/answer can never answer: service answer of /a waits for group 'work' of /a")
    up.wait_for(f"held by timer ask of /a   {at('stuck: Member')}toil")
    assert up.end() == 0
    assert reports(up.text) == []


def test_a_chain_that_comes_back_to_its_caller_is_reported(lab: Lab) -> None:
    """Where nothing is raised, the lines of both processes are told (row 5)."""
    up = lab.up({"/a": member("b"), "/b": echo_of("a")})
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    up.wait_for(f"service answer of /b waits for the answer of service /a/answer   {at('stuck: Echo')}answer")
    up.wait_for(f"holds group 'work' and waits for the answer of service /b/answer   {at('stuck: Member')}toil")
    assert up.end() == 0
    assert len(reports(up.text)) == 1


def test_what_takes_long_lives(lab: Lab) -> None:
    """Two who queue for a server that is busy are looked at, and not reported (row 9)."""
    up = lab.up({"/a": member("slow"), "/b": member("slow"), "/slow": "class: nodes.ring:Slow"})
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    wait_for_all(up, ["[slow]: serves", "[a]: asks", "[b]: asks"])
    shown = lab.machine.run("waits")
    assert "  timer ask of /a, holds 'work': waits for the answer of /slow/answer" in shown
    assert "!" not in shown
    assert lab.machine.run("doctor") == "3 nodes, nothing wrong\n"

    lab.open_gates("slow")
    wait_for_all(up, answered("ab"))
    assert up.end() == 0
    assert reports(up.text) == []


def test_a_call_that_blocks_the_loop_it_needs(lab: Lab) -> None:
    """It is told, shown and found by the blocked process itself; a thread of its own ends it (row 17)."""
    up = lab.up({"/a": member("b", "Blocker"), "/b": echo_of("a")})
    up.wait_for("DEADLOCK: one callback waits for itself")
    up.wait_for("timer ask of /a blocks the event loop and waits for the answer of service /b/answer   (ring.py:")
    up.wait_for(f"{at('stuck: Blocker')}ask, since ")
    up.wait_for(line := "/a: {concurrency: {blocking: {handlers: [ask], thread: true}}}")
    assert "! timer ask of /a: waits for the answer of /b/answer" in lab.machine.run("waits")
    told = lab.machine.run("groups", "move", "/a", "answer", "answers", "--timeout", "0.2", code=4)
    assert "its event loop may be blocked" in told
    end_at_once(up)

    fixed = lab.up_fixed(f"  {line}")
    fixed.wait_for("[a]: was answered")
    assert fixed.end() == 0
    assert reports(fixed.text) == []


def test_a_call_that_blocks_the_loop_it_needs_is_one_report(lab: Lab) -> None:
    """It is told once, though the other process finds it, too (rows 17, 29)."""
    up = lab.up({"/a": member("b", "Blocker"), "/b": echo_of("a")})
    up.wait_for("DEADLOCK: ")
    up.wait_for("[graphflow]: the event loop is blocked since 1.")
    assert "DEADLOCK: " in lab.machine.run("doctor", code=1)
    end_at_once(up)
    assert len(reports(up.text)) == 1


def end_at_once(up: Program) -> None:
    """End a graph of which a process is blocked and would be waited for."""
    up.process.send_signal(signal.SIGINT)
    up.wait_for("stopping (Ctrl-C)")
    assert up.end() == 0


# Members that leave, or stand still


def test_a_member_that_is_cancelled(lab: Lab) -> None:
    """The others go on, the report clears, and nothing waits any more (row 18)."""
    up = lab.up(ring_of("ab", "Canceller"))
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    up.wait_for(at("stuck: Canceller"))

    lab.call("/a/give_up")
    wait_for_all(up, [*answered("ab"), "has cleared"])
    assert lab.machine.run("waits") == "nobody waits\n"
    assert up.end() == 0
    assert len(reports(up.text)) == 1


def test_a_member_whose_call_times_out(lab: Lab) -> None:
    """The report says when that will be; then the other is answered, and the report clears (row 19)."""
    up = lab.up({**ring_of("ab"), "/a": member("b", more=", params: {limit: 1.5}")})
    wait_for_all(up, at_it("ab"))
    lab.open_gates("a", "b")
    up.wait_for("times out in 1.")
    wait_for_all(up, ["[a]: CallTimeout: /b/answer did not answer within 1.5 s", *answered("b"), "has cleared"])
    assert up.end() == 0
    assert len(reports(up.text)) == 1
    assert up.text.count("times out in") == 1


@pytest.mark.parametrize("is_reporter", [True, False])
def test_kill_minus_9_of_a_member(lab: Lab, is_reporter: bool) -> None:
    """Whoever waits for it is told so at once, the others are answered, and no deadlock is left (row 20)."""
    names = "abc"
    up = lab.ring(names)
    wait_for_ring(up, names)
    teller = reporter(up)
    dead = teller if is_reporter else next(name for name in names if name != teller)
    before = "cab"[names.index(dead)]
    [last] = set(names) - {dead, before}

    os.kill(lab.pids()[f"/{dead}"], signal.SIGKILL)
    wait_for_all(up, [f"[{before}]: ServerLost: the server of /{dead}/answer went away", *answered(last)])
    up.wait_for("has cleared")
    assert lab.machine.run("waits") == "nobody waits\n"
    assert "nothing wrong" in lab.machine.run("doctor")
    assert up.end() == 1
    assert len(reports(up.text)) == 1
    assert up.text.count("has cleared") == 1


def test_a_stopped_process_is_no_member(lab: Lab) -> None:
    """Of one that stands still nothing is claimed; the ring is told when it goes on and closes it (row 21)."""
    up = lab.up(ring_of("ab"))
    wait_for_all(up, at_it("ab"))
    pid = lab.pids()["/b"]
    os.kill(pid, signal.SIGSTOP)
    lab.open_gates("a", "b")
    up.wait_for("[a]: asks")
    told = lab.machine.run("doctor", code=1)
    assert told == f"NODE UNRESPONSIVE: /b (process {pid}) did not answer: it is stopped: kill -CONT {pid}\n"
    up.wait_for(f"NODE UNRESPONSIVE: /b (process {pid}) has not answered for 1.")
    assert "  timer ask of /a, holds 'work': waits for the answer of /b/answer" in lab.machine.run("waits")
    assert reports(up.text) == []

    os.kill(pid, signal.SIGCONT)
    wait_for_all(up, ["[b]: asks", f"/b (process {pid}) answers again"])
    wait_for_ring(up, "ab")
    assert up.end() == 0
    assert len(reports(up.text)) == 1


def test_a_server_that_is_stopped_while_it_serves(lab: Lab) -> None:
    """Its caller's deadline ends the wait, and nothing is reported, also when it goes on (row 21)."""
    up = lab.up({"/a": member("slow", more=", params: {limit: 1.5}"), "/slow": "class: nodes.ring:Slow"})
    wait_for_all(up, at_it("a"))
    pid = lab.pids()["/slow"]
    lab.open_gates("a")
    up.wait_for("[slow]: serves")
    os.kill(pid, signal.SIGSTOP)
    lab.open_gates("slow")
    up.wait_for("[a]: CallTimeout: /slow/answer did not answer within 1.5 s")

    os.kill(pid, signal.SIGCONT)
    assert lab.machine.run("doctor") == "2 nodes, nothing wrong\n"
    assert up.end() == 0
    assert reports(up.text) == []


def hold(lab: Lab, cls: str) -> Program:
    """Start a graph of which /b holds its event loop while /a waits for its answer."""
    os.mkfifo(lab.root / "nodes" / "pipe")
    up = lab.up({"/a": member("b"), "/b": f"class: nodes.ring:{cls}"})
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("[b]: serves")
    return up


def let_go(lab: Lab) -> None:
    os.close(os.open(lab.root / "nodes" / "pipe", os.O_WRONLY | os.O_NONBLOCK))


def test_a_loop_that_is_held(lab: Lab) -> None:
    """The watchdog tells it, with the line; who waits for that process is in no deadlock (row 22)."""
    up = hold(lab, "Sleepy")
    up.wait_for("[graphflow]: the event loop is blocked since 1.")
    up.wait_for(f'ring.py", line {line_of("held: Sleepy")}, in hold')

    let_go(lab)
    wait_for_all(up, [*answered("a"), "the event loop goes on after"])
    assert "/b: the event loop was late 1 times, by " in lab.machine.run("doctor")
    assert up.end() == 0
    assert reports(up.text) == []


def test_the_doctor_sees_a_loop_that_is_held(lab: Lab) -> None:
    """What the log tells, `doctor` tells too."""
    up = hold(lab, "Sleepy")
    up.wait_for("[graphflow]: the event loop is blocked since 1.")
    assert "/b: the event loop is blocked since " in lab.machine.run("doctor", code=1)
    let_go(lab)


def test_an_interpreter_that_is_held(lab: Lab) -> None:
    """A process of which no thread runs is in no deadlock; it is said to be silent, and shows where it is (row 22)."""
    up = hold(lab, "Greedy")
    pid = lab.pids()["/b"]
    told = lab.machine.run("doctor", code=1)
    assert f"NODE UNRESPONSIVE: /b (process {pid}) did not answer: " in told
    assert "DEADLOCK" not in told
    up.wait_for(f"NODE UNRESPONSIVE: /b (process {pid}) has not answered for 1.")
    os.kill(pid, signal.SIGUSR2)
    up.wait_for(f'ring.py", line {line_of("held: Greedy")} in hold')

    let_go(lab)
    wait_for_all(up, [*answered("a"), "nothing of this process could run for "])
    assert lab.machine.run("waits") == "nobody waits\n"
    assert up.end() == 0
    assert reports(up.text) == []


def test_a_ring_through_the_result_of_an_action(lab: Lab) -> None:
    """It is told, and to cancel the goal still ends it (row 26)."""
    nodes = {"/a": "class: nodes.ring:Customer", "/b": "class: nodes.ring:Courier, remap: {position: /a/answer}"}
    up = lab.up(nodes)
    wait_for_all(up, at_it("a"))
    lab.open_gates("a")
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    up.wait_for(f"group 'work' and waits for the result of action /order   {at('stuck: Customer')}toil")
    up.wait_for(f"action deliver of /b waits for the answer of service /a/answer   {at('stuck: Courier')}deliver")

    lab.call("/a/give_up")
    wait_for_all(up, ["[a]: cancelled", "has cleared"])
    assert lab.machine.run("waits") == "nobody waits\n"
    assert up.end() == 0
    assert len(reports(up.text)) == 1


# Who reports


def close_and_open(lab: Lab, programs: list[Program]) -> None:
    """Close a ring of /a and /b, each of a program of its own; it is reported once, and a moved handler ends it."""
    for program, name in zip(programs, "ab", strict=True):
        wait_for_all(program, at_it(name))
    lab.open_gates("a", "b")
    lab.machine.until(lambda: "DEADLOCK" in lab.machine.run("doctor", code=None), "it is found")
    lab.machine.run("groups", "move", "/b", "answer", "answers")
    for program, name in zip(programs, "ab", strict=True):
        wait_for_all(program, answered(name))
        assert program.end() == 0
    assert len(reports(*(program.text for program in programs))) == 1


def test_two_supervisors_are_one_report(lab: Lab) -> None:
    """A ring through two graphs, each of a terminal of its own, is told once (row 29)."""
    files = [lab.write({node: about}, name=f"lab_{node[1:]}") for node, about in ring_of("ab").items()]
    close_and_open(lab, [lab.machine.start("up", file, cwd=lab.root) for file in files])


def test_no_supervisor_is_needed(lab: Lab) -> None:
    """So is one of nodes that were started by hand (row 29)."""
    words = ["run", "nodes.ring:Member", "--ros-args"]
    names = [("a", "b"), ("b", "a")]
    remaps = [["-r", f"__node:={name}", "-r", f"following:=/{other}/answer"] for name, other in names]
    close_and_open(lab, [lab.machine.start(*words, *remap, cwd=lab.root) for remap in remaps])


def test_one_who_asks_two_is_one_report(lab: Lab) -> None:
    """One asks two others at once, who both ask back: that is told once, also if the pictures differ in age (row 29).

    They do by half a second: so long everybody waits for a process that stands still.
    """
    up = lab.up(ring_of("abc", "Boss") | {"/idle": "class: nodes.ring:Slow"})
    wait_for_all(up, at_it("abc"))
    os.kill(lab.pids()["/idle"], signal.SIGSTOP)
    boss = max("abc", key=zids(up).__getitem__)
    lab.open_gates(boss)
    up.wait_for("DEADLOCK: 2 callbacks wait for each other in a ring")
    assert "DEADLOCK: " in lab.machine.run("doctor", code=1)
    end_at_once(up)
    assert len(reports(up.text)) == 1


# The commands


def test_exit_codes_and_what_is_shown(lab: Lab) -> None:
    """Before, during and after a deadlock, and when nothing runs."""
    run = lab.machine.run
    up = lab.up(ring_of("ab"))
    wait_for_all(up, at_it("ab"))
    assert run("doctor") == "2 nodes, nothing wrong\n"
    assert "timer ask of /a, holds 'work': runs" in run("waits")

    lab.open_gates("a", "b")
    wait_for_ring(up, "ab")
    shown = run("waits")
    for name, other in ("ab", "ba"):
        assert f"! timer ask of /{name}, holds 'work': waits for the answer of /{other}/answer since " in shown
        assert f"service answer of /{name} is queued for group 'work', held by timer ask of /{name}: 1 wait" in shown
    assert shown.count(f"ring.py:{line_of('stuck: Member')} in toil") == 4  # two waits, and two in the report
    assert "DEADLOCK: 2 callbacks wait for each other in a ring" in shown
    assert "nothing wrong" not in run("doctor", code=1)
    found = json.loads(run("doctor", "--json", code=1))
    assert [text.splitlines()[0] for text in found["deadlocks"]] == reports(up.text)
    stuck = [row["activity"] for row in json.loads(run("waits", "--json"))["activities"] if row["stuck"]]
    assert sorted(stuck) == ["timer ask of /a", "timer ask of /b"]

    run("groups", "move", "/b", "answer", "answers")
    up.wait_for("has cleared")
    assert run("waits") == "nobody waits\n"
    assert run("doctor") == "2 nodes, nothing wrong\n"
    assert up.end() == 0


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("waits", 3, "error: nothing is running"),
        ("doctor --json", 3, "error: nothing is running"),
        ("groups move /a answer answers", 3, "error: nothing is running"),
        ("doctor now", 2, "unexpected extra argument"),
    ],
)
def test_nothing_runs(lab: Lab, words: str, code: int, told: str) -> None:
    """Exit code 3, or 2 when the words are wrong anyway."""
    assert told in lab.machine.run(*words.split(), code=code)


# Programs as students write them

HEAD = """
import asyncio
import math
import time

from graphflow import ActionClient, Client, Group, Node, Param, Publisher, action, service, subscription, task, timer
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_msgs.msg import Bool, Float64, String
from graphflow.msgs.std_srvs.srv import SetBool, Trigger
from graphflow.msgs.turtlesim.msg import Pose
"""

EVENT = """
class Explorer(Node):
    default_group = Group(1)

    def __init__(self, name=None, **options):
        super().__init__(name, **options)
        self.seen = asyncio.Event()

    @timer(0.2)
    async def explore(self):
        self.seen.clear()
        await self.seen.wait()  # stuck
        self.log.info("found it")

    @subscription(String, "sightings")
    async def on_sighting(self, message):
        self.seen.set()


class Camera(Node):
    sightings = Publisher(String, "sightings")

    @timer(0.1)
    async def look(self):
        self.sightings.publish(String(data="ball"))
"""

QUEUE = """
class Worker(Node):
    default_group = Group(1)

    def __init__(self, name=None, **options):
        super().__init__(name, **options)
        self.jobs = asyncio.Queue()

    @timer(0.1)
    async def work(self):
        job = await self.jobs.get()  # stuck
        self.log.info("did %s", job)

    @service(Trigger, "~/add_job")
    async def add_job(self, request):
        await self.jobs.put("a job")
        return Trigger.Response(success=True)


class Boss(Node):
    add_job = Client(Trigger, "/worker/add_job")

    @timer(0.3)
    async def order(self):
        await self.add_job.call(Trigger.Request())
"""

FLAG = """
class Robot(Node):
    default_group = Group(1)
    door_is_open = False

    @timer(0.2)
    async def go_through(self):
        self.door_is_open = False
        while not self.door_is_open:
            await self.clock.sleep(0.05)  # stuck
        self.log.info("through")

    @service(SetBool, "~/door")
    async def on_door(self, request):
        self.door_is_open = request.data
        return SetBool.Response(success=True)


class Janitor(Node):
    robot = Client(SetBool, "/robot/door")

    @timer(0.3)
    async def open_up(self):
        await self.robot.call(SetBool.Request(data=True))
"""

SLEEP = """
class Sprinter(Node):
    started = False

    @timer(0.2)
    def race(self):
        self.started = False
        while not self.started:
            time.sleep(0.05)  # stuck
        self.log.info("racing")

    @subscription(Bool, "shot")
    def on_shot(self, message):
        self.started = message.data


class Starter(Node):
    shot = Publisher(Bool, "shot")

    @timer(0.1)
    def shoot(self):
        self.shot.publish(Bool(data=True))
"""

THREAD = """
class Arm(Node):
    serial_port = Group(1, thread=True)
    check = Client(Trigger, "/safety/check")

    @timer(0.2, group=serial_port)
    def move(self):
        answer = self.check.call_sync(Trigger.Request())  # stuck
        self.log.info("moved to %s", answer.message)

    @service(Trigger, "~/position", group=serial_port)
    def position(self, request):
        return Trigger.Response(success=True, message="0.5")


class Safety(Node):
    position = Client(Trigger, "/arm/position")

    @service(Trigger, "~/check")
    async def check(self, request):
        return await self.position.call(Trigger.Request())
"""

FUTURE = """
class Navigator(Node):
    default_group = Group(1)
    next_fix = None

    @timer(0.2)
    async def locate(self):
        self.next_fix = asyncio.get_running_loop().create_future()
        fix = await self.next_fix  # stuck
        self.log.info("at %.1f", fix)

    @subscription(Float64, "fixes")
    async def on_fix(self, message):
        if self.next_fix is not None and not self.next_fix.done():
            self.next_fix.set_result(message.data)


class Gps(Node):
    fixes = Publisher(Float64, "fixes")

    @timer(0.1)
    async def fix(self):
        self.fixes.publish(Float64(data=4.5))
"""

HELPERS = """
class Rocket(Node):
    default_group = Group(1)
    clearance = Client(Trigger, "/tower/clear")

    @timer(0.2)
    async def launch(self):
        await self.prepare()
        self.log.info("lift-off")

    async def prepare(self):
        await self.check_everything()

    async def check_everything(self):
        await self.ask_tower()

    async def ask_tower(self):
        await self.clearance.call(Trigger.Request())  # stuck

    @service(Trigger, "~/status")
    async def status(self, request):
        return Trigger.Response(success=True)


class Tower(Node):
    default_group = Group(1)
    status = Client(Trigger, "/rocket/status")

    @service(Trigger, "~/clear")
    async def clear(self, request):
        return await self.status.call(Trigger.Request())
"""

POSE = """
class Driver(Node):
    default_group = Group(1)
    speed = Publisher(Float64, "speed")

    def __init__(self, name=None, **options):
        super().__init__(name, **options)
        self.pose = Pose()

    @subscription(Pose, "pose")
    async def on_pose(self, message):
        self.pose = message

    def distance(self, x):
        return math.hypot(x - self.pose.x, self.pose.y)

    @action(Fibonacci, "drive")
    async def drive(self, goal):
        while self.distance(goal.request.order) > 0.1:
            self.speed.publish(Float64(data=1.0))
            await self.clock.sleep(0.05)  # stuck
        return Fibonacci.Result()


class World(Node):
    poses = Publisher(Pose, "pose")
    wall = 3.0
    x = 0.0

    @subscription(Float64, "speed")
    async def on_speed(self, message):
        self.x = min(self.wall, self.x + message.data)

    @timer(0.05)
    async def tell(self):
        self.poses.publish(Pose(x=self.x))


class Commander(Node):
    far = Param(3)
    drive = ActionClient(Fibonacci, "drive")

    @task
    async def command(self):
        async with self.drive.send(Fibonacci.Goal(order=self.far)) as goal:
            await goal.result()
            self.log.info("there")
"""

SAME_NAME = """
class Arm(Node):
    default_group = Group(1)
    camera = Client(Trigger, "/camera/status")

    @timer(0.2)
    async def look_around(self):
        await self.camera.call(Trigger.Request())  # stuck
        self.log.info("all well")

    @service(Trigger, "~/status")
    async def status(self, request):
        return Trigger.Response(success=True)


class Camera(Node):
    arm = Client(Trigger, "/arm/status")

    @service(Trigger, "~/status")
    async def status(self, request):
        return await self.arm.call(Trigger.Request())
"""

MIXED = """
class Pilot(Node):
    default_group = Group(1)
    watch = Client(Trigger, "/guard/watch")

    @timer(0.5)
    async def fly(self):
        await self.watch.call(Trigger.Request())
        self.log.info("is watched")

    @service(Trigger, "~/answer")
    async def answer(self, request):
        return Trigger.Response(success=True)


class Guard(Node):
    radio = Group(1)
    pilot = Client(Trigger, "/pilot/answer")

    def __init__(self, name=None, **options):
        super().__init__(name, **options)
        self.noticed = asyncio.Event()

    @service(Trigger, "~/watch")
    async def on_watch(self, request):
        self.noticed.clear()
        await self.noticed.wait()  # stuck
        return Trigger.Response(success=True)

    @timer(0.1, group=radio)
    async def talk(self):
        await self.clock.sleep(0.7)
        await self.pilot.call(Trigger.Request())

    @subscription(String, "news", group=radio)
    async def on_news(self, message):
        self.noticed.set()


class Reporter(Node):
    news = Publisher(String, "news")

    @timer(0.1)
    async def tell(self):
        self.news.publish(String(data="all quiet"))
"""


class Written(NamedTuple):
    """A program that stands still, what its report says, and what is seen when it goes on."""

    code: str
    verdict: str
    stuck: str
    """Of the line with the marker: what waits there, for what."""
    function: str
    fix: str
    goes_on: str
    is_moved: bool
    """Whether the fix is tried on the running graph; else it is written into the file."""
    process: str = ""
    """Of all nodes; each has its own if empty."""

    @property
    def nodes(self) -> dict[str, str]:
        process = f", process: {self.process}" if self.process else ""
        names = re.findall(r"(?m)^class (\w+)\(Node\):", self.code)
        return {f"/{name.lower()}": f"class: nodes.student:{name}{process}" for name in names}


def itself(verdict: str = "LIKELY DEADLOCK") -> str:
    return f"{verdict}: one callback waits for itself"


def in_ring(count: int, verdict: str = "DEADLOCK") -> str:
    return f"{verdict}: {count} callbacks wait for each other in a ring"


WRITTEN = {
    "an event": Written(
        EVENT,
        itself(),
        "timer explore of /explorer holds group 'default_group' and waits for self.seen",
        "explore",
        "/explorer: {concurrency: {on_sighting_group: [on_sighting]}}",
        "[explorer]: found it",
        is_moved=True,
    ),
    "a queue": Written(
        QUEUE,
        itself(),
        "timer work of /worker holds group 'default_group' and waits for self.jobs",
        "work",
        "/worker: {concurrency: {add_job_group: [add_job]}}",
        "[worker]: did a job",
        is_moved=True,
    ),
    "a flag that is polled": Written(
        FLAG,
        itself(),
        "timer go_through of /robot holds group 'default_group' and waits for self.door_is_open",
        "go_through",
        "/robot: {concurrency: {on_door_group: [on_door]}}",
        "[robot]: through",
        is_moved=True,
    ),
    "a sleep on the loop": Written(
        SLEEP,
        itself(),
        "timer race of /sprinter blocks the event loop and waits for self.started",
        "race",
        "/sprinter: {concurrency: {blocking: {handlers: [race], thread: true}}}",
        "[sprinter]: racing",
        is_moved=False,
    ),
    "a call from a thread": Written(
        THREAD,
        in_ring(2),
        "timer move of /arm holds group 'serial_port' and waits for the answer of service /safety/check",
        "move",
        "/arm: {concurrency: {position_group: [position]}}",
        "[arm]: moved to 0.5",
        is_moved=True,
    ),
    "a future": Written(
        FUTURE,
        itself(),
        "timer locate of /navigator holds group 'default_group' and waits for self.next_fix",
        "locate",
        "/navigator: {concurrency: {on_fix_group: [on_fix]}}",
        "[navigator]: at 4.5",
        is_moved=True,
    ),
    "helpers, in one process": Written(
        HELPERS,
        in_ring(2),
        "timer launch of /rocket holds group 'default_group' and waits for the answer of service /tower/clear",
        "ask_tower",
        "/rocket: {concurrency: {status_group: [status]}}",
        "[rocket]: lift-off",
        is_moved=False,
        process="base",
    ),
    "an action and a pose": Written(
        POSE,
        itself(),
        "action drive of /driver holds group 'default_group' and waits for self.pose",
        "drive",
        "/driver: {concurrency: {on_pose_group: [on_pose]}}",
        "[commander]: there",
        is_moved=True,
    ),
    "services of one name": Written(
        SAME_NAME,
        in_ring(2),
        "timer look_around of /arm holds group 'default_group' and waits for the answer of service /camera/status",
        "look_around",
        "/arm: {concurrency: {status_group: [status]}}",
        "[arm]: all well",
        is_moved=True,
    ),
    "an event and two calls": Written(
        MIXED,
        in_ring(3, "LIKELY DEADLOCK"),
        "service on_watch of /guard waits for self.noticed",
        "on_watch",
        "/guard: {concurrency: {on_news_group: [on_news]}}",
        "[pilot]: is watched",
        is_moved=True,
    ),
}


@pytest.mark.parametrize("name", WRITTEN)
def test_advice_that_is_followed(lab: Lab, name: str) -> None:
    """The report names the line, and with what it says to write the graph goes on."""
    case = WRITTEN[name]
    up = start(lab, case)
    up.wait_for(f"{case.stuck}   (student.py:{line_of('stuck', HEAD + case.code)} in {case.function}, since ")
    up.wait_for("Any one of these ends it:")
    up.wait_for(f"      {case.fix}\n", limit=2.0)
    [headline] = reports(up.text)
    assert headline.partition(";")[0] == case.verdict

    if case.is_moved:
        up.text = ""
        move(lab, case)
        wait_for_all(up, [case.goes_on, "has cleared"])
        assert up.end() == 0
        return
    end_at_once(up)
    fixed = lab.up_fixed(f"  {case.fix}")
    fixed.wait_for(case.goes_on)
    assert fixed.end() == 0
    assert reports(fixed.text) == []


def start(lab: Lab, case: Written, **more: str) -> Program:
    (lab.root / "nodes" / "student.py").write_text(HEAD + case.code)
    return lab.up({name: about + more.get(name[1:], "") for name, about in case.nodes.items()})


def move(lab: Lab, case: Written) -> None:
    """Do on the running graph what the report says to write into its file."""
    found = re.fullmatch(r"(/\w+): \{concurrency: \{(\w+): \[(\w+)\]\}\}", case.fix)
    assert found is not None
    node, group, handler = found.groups()
    assert f"  {case.fix}\n" in lab.machine.run("groups", "move", node, handler, group)


def test_a_loop_that_goes_on_is_in_no_deadlock(lab: Lab) -> None:
    """When its pose comes again, the driver that was stuck is on its way: nothing is wrong any more."""
    case = WRITTEN["an action and a pose"]
    up = start(lab, case, commander=", params: {far: 1000}")
    up.wait_for(f"      {case.fix}\n")
    move(lab, case)
    up.wait_for("has cleared", limit=2.0)
    assert "nothing wrong" in lab.machine.run("doctor")


def test_the_line_of_a_lock(lab: Lab) -> None:
    """A lock that is held across a call to another process, which needs it: no group helps, and none is named."""
    code = """
class Bank(Node):
    audit = Client(Trigger, "/auditor/audit")

    def __init__(self, name=None, **options):
        super().__init__(name, **options)
        self.vault = asyncio.Lock()

    @timer(0.2)
    async def close_day(self):
        async with self.vault:
            await self.audit.call(Trigger.Request())  # stuck

    @service(Trigger, "~/balance")
    async def balance(self, request):
        async with self.vault:
            return Trigger.Response(success=True)


class Auditor(Node):
    balance = Client(Trigger, "/bank/balance")

    @service(Trigger, "~/audit")
    async def on_audit(self, request):
        return await self.balance.call(Trigger.Request())
"""
    (lab.root / "nodes" / "student.py").write_text(HEAD + code)
    up = lab.up({"/bank": "class: nodes.student:Bank", "/auditor": "class: nodes.student:Auditor"})
    up.wait_for(in_ring(3, "LIKELY DEADLOCK"))
    up.wait_for("service balance of /bank waits for self.vault   (student.py:")
    up.wait_for(f"leave self.vault before what is awaited in student.py:{line_of('stuck', HEAD + code)}")
    assert up.end() == 0
    assert "concurrency:" not in up.text
