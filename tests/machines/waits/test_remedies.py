"""What ends a deadlock; `test_explain` has the words of each remedy."""

from __future__ import annotations

from graphflow.errors import Place
from graphflow.machines.waits.reduction import deadlocked
from graphflow.machines.waits.remedies import own_group, remedies
from graphflow.machines.waits.rings import explained
from graphflow.machines.waits.wait_graph import ActivityView, Call, GroupView, QueueView, WaitGraph
from tests.machines.pictures import picture

MOTION = GroupView("g", "motion", "/arm")
ADD = QueueView("q", "service add", "/arm", ("g",), ("c",), 1)


def waits(name: str, call: str, *holds: str) -> ActivityView:
    return ActivityView(name, f"timer {name}", "/arm", holds, Call(call, "/add"), place=Place("arm.py", 3))


def told(seen: WaitGraph) -> list[str]:
    (found,) = explained(seen, deadlocked(seen))
    return [remedy.split()[0] for remedy in remedies(found, seen)]


def test_one_remedy_of_each_kind() -> None:
    """The move first: it changes no code."""
    assert told(picture(waits("tick", "c", "g"), MOTION, ADD)) == ["give", "allow", "release"]


def test_a_move_that_ends_nothing_is_not_advised() -> None:
    """The handler needs two groups, and would wait for the other."""
    two = QueueView("q", "service add", "/arm", ("g", "h"), ("c",), 1)
    other = GroupView("h", "", "/arm")
    assert told(picture(waits("tick", "c", "g", "h"), MOTION, other, two))[0] == "give"
    itself = QueueView("q", "timer tick", "/arm", ("g",), ("c",), 1)
    assert told(picture(waits("tick", "c", "g"), MOTION, itself)) == ["allow", "release"]


def test_handlers_that_move_together() -> None:
    """Each is named once; what is made while the node runs is not in any file."""
    queues = [ADD, QueueView("r", "service reset", "/arm", ("g",)), ADD]
    [text] = own_group(queues, picture(MOTION))
    assert "give add and reset a group of their own," in text
    assert "{add_group: [add, reset]}" in text
    made = [QueueView("r", "service reset", "/arm", ("g",), is_declared=False)]
    assert list(own_group(made, picture(MOTION))) == [
        "  give reset of /arm a group of its own: group=Group(1) where it is made"
    ]
