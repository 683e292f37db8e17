"""Programs as students write them that stand still: what the report says to write is tried, and they go on."""

from __future__ import annotations

import re
from typing import NamedTuple

import pytest

from tests.cases import slow, some
from tests.conftest import PROGRAMS, Program
from tests.graphs.lab import Lab, end_at_once, line_of, reports, wait_for_all

pytestmark = pytest.mark.real


class Written(NamedTuple):
    """A program that stands still, what its report says, and what is seen when it goes on."""

    program: str
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
        names = re.findall(r"(?m)^class (\w+)\(Node\):", (PROGRAMS / self.program).read_text())
        return {f"/{name.lower()}": f"class: nodes.student:{name}{process}" for name in names}


def itself(verdict: str = "LIKELY DEADLOCK") -> str:
    return f"{verdict}: "


def in_ring(count: int, verdict: str = "DEADLOCK") -> str:
    return f"{verdict}: {count} callbacks wait for each other in a ring"


WRITTEN = {
    "an event": Written(
        "advice/event.py",
        itself(),
        "timer explore of /explorer holds group 'default_group' and waits for self.seen",
        "explore",
        "/explorer: {concurrency: {on_sighting_group: [on_sighting]}}",
        "[explorer]: found it",
        is_moved=True,
    ),
    "a queue": Written(
        "advice/job_queue.py",
        itself(),
        "timer work of /worker holds group 'default_group' and waits for self.jobs",
        "work",
        "/worker: {concurrency: {add_job_group: [add_job]}}",
        "[worker]: did a job",
        is_moved=True,
    ),
    "a flag that is polled": Written(
        "advice/polled_flag.py",
        itself(),
        "timer go_through of /robot holds group 'default_group' and waits for self.door_is_open",
        "go_through",
        "/robot: {concurrency: {on_door_group: [on_door]}}",
        "[robot]: through",
        is_moved=True,
    ),
    "a sleep on the loop": Written(
        "advice/sleep_on_loop.py",
        itself(),
        "timer race of /sprinter blocks the event loop and waits for self.started",
        "race",
        "/sprinter: {concurrency: {blocking: {handlers: [race], thread: true}}}",
        "[sprinter]: racing",
        is_moved=False,
    ),
    "a call from a thread": Written(
        "advice/call_from_thread.py",
        in_ring(2),
        "timer move of /arm holds group 'serial_port' and waits for the response of service /safety/check",
        "move",
        "/arm: {concurrency: {position_group: [position]}}",
        "[arm]: moved to 0.5",
        is_moved=True,
    ),
    "a future": Written(
        "advice/future.py",
        itself(),
        "timer locate of /navigator holds group 'default_group' and waits for self.next_fix",
        "locate",
        "/navigator: {concurrency: {on_fix_group: [on_fix]}}",
        "[navigator]: at 4.5",
        is_moved=True,
    ),
    "helpers, in one process": Written(
        "advice/nested_calls.py",
        in_ring(2),
        "timer launch of /rocket holds group 'default_group' and waits for the response of service /tower/clear",
        "ask_tower",
        "/rocket: {concurrency: {status_group: [status]}}",
        "[rocket]: lift-off",
        is_moved=False,
        process="base",
    ),
    "an action and a pose": Written(
        "advice/action_and_pose.py",
        itself(),
        "action drive of /driver holds group 'default_group' and waits for self.pose",
        "drive",
        "/driver: {concurrency: {on_pose_group: [on_pose]}}",
        "[commander]: there",
        is_moved=True,
    ),
    "services of one name": Written(
        "advice/same_name.py",
        in_ring(2),
        "timer look_around of /arm holds group 'default_group' and waits for the response of service /camera/status",
        "look_around",
        "/arm: {concurrency: {status_group: [status]}}",
        "[arm]: all well",
        is_moved=True,
    ),
    "an event and two calls": Written(
        "advice/event_and_calls.py",
        in_ring(3, "LIKELY DEADLOCK"),
        "service on_watch of /guard waits for self.noticed",
        "on_watch",
        "/guard: {concurrency: {on_news_group: [on_news]}}",
        "[pilot]: is watched",
        is_moved=True,
    ),
}


@slow
@pytest.mark.parametrize("name", some(WRITTEN, "an event", "an action and a pose"))
def test_advice_that_is_followed(lab: Lab, name: str) -> None:
    """The report names the line, and with what it says to write the graph goes on."""
    case = WRITTEN[name]
    up = start(lab, case)
    up.wait_for(f"{case.stuck}   (student.py:{line_of('stuck', case.program)} in {case.function},")
    up.wait_for("ends it:")
    up.wait_for(f"      {case.fix}\n", limit=2.0)
    [headline] = reports(up.text)
    assert headline.startswith(case.verdict)

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
    lab.add(case.program, "student.py")
    return lab.up({name: about + more.get(name[1:], "") for name, about in case.nodes.items()})


def move(lab: Lab, case: Written) -> None:
    """Do on the running graph what the report says to write into its file."""
    found = re.fullmatch(r"(/\w+): \{concurrency: \{(\w+): \[(\w+)\]\}\}", case.fix)
    assert found is not None
    node, group, handler = found.groups()
    assert f"  {case.fix}\n" in lab.machine.look("groups", "move", node, handler, group)


@slow
def test_a_loop_that_goes_on_is_in_no_deadlock(lab: Lab) -> None:
    """When its pose comes again, the driver that was stuck is on its way: nothing is wrong any more."""
    case = WRITTEN["an action and a pose"]
    up = start(lab, case, commander=", params: {far: 1000}")
    up.wait_for(f"      {case.fix}\n")
    move(lab, case)
    up.wait_for("has cleared", limit=2.0)
    assert "nothing wrong" in lab.machine.look("doctor")


@slow
def test_the_line_of_a_lock(lab: Lab) -> None:
    """A lock that is held across a call to another process, which needs it: no group helps, and none is named."""
    lab.add("advice/lock.py", "student.py")
    up = lab.up({"/bank": "class: nodes.student:Bank", "/auditor": "class: nodes.student:Auditor"})
    up.wait_for(in_ring(3, "LIKELY DEADLOCK"))
    up.wait_for("service balance of /bank waits for self.vault   (student.py:")
    up.wait_for(
        f"move the await in student.py:{line_of('stuck', 'advice/lock.py')} to where it does not hold self.vault"
    )
    assert up.end() == 0
    assert "concurrency:" not in up.text
