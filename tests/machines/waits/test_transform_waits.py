"""Waits for transforms, and who may end them."""

from __future__ import annotations

import pytest

from graphflow.machines.waits.transform_waits import resolved
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Condition,
    Join,
    QueueView,
    SetBy,
    TransformWait,
    WaitGraph,
)

WHAT = "the transform map -> base"
LACKS = TransformWait(WHAT, ("p",), ("map", "base"))


def graph(wait: Condition, *queues: QueueView) -> WaitGraph:
    waiting = ActivityView("a", "timer look", "/robot", wait=wait, process="p")
    return WaitGraph({"a": waiting}, queues={queue.id: queue for queue in queues})


def sender(id_: str, *texts: str, node: str = "/robot", process: str = "p") -> QueueView:
    return QueueView(id_, f"timer {id_}", node, (), process=process, sends=texts)


SILENT = QueueView("silent", "timer silent", "/robot", (), process="p")


@pytest.mark.parametrize(
    ("wait", "queues", "expected"),
    [
        (LACKS, [sender("q", "map", "base", "more")], ("q",)),
        (LACKS, [sender("q", "map", "base"), sender("other")], ("other", "q")),
        (LACKS, [sender("q", "map", "odom")], None),
        (LACKS, [sender("q")], None),
        (LACKS, [SILENT], None),
        (TransformWait(WHAT, ("p", "p2"), ("map",)), [sender("q", "map")], None),
        (TransformWait(WHAT, ("p", "p2"), ("map",)), [sender("q", "map", process="p2")], ("q",)),
        (TransformWait(WHAT, ("p",), node="/odometry"), [sender("q", node="/odometry"), sender("r")], ("q",)),
        (TransformWait(WHAT, ("p",), node="/odometry"), [sender("r")], None),
    ],
)
def test_senders(wait: TransformWait, queues: list[QueueView], expected: tuple[str, ...] | None) -> None:
    """Some code must name the frames, or have sent them, and every process must be there; else the wait is free."""
    found = resolved(graph(wait, *queues)).activities["a"].wait
    assert found == (FREE if expected is None else SetBy(WHAT, expected, verb="sends"))


def test_waits_for_several_things() -> None:
    """Only the parts that are transforms change; an activity that sends counts, too."""
    seen = graph(All((Join("b"), AnyOf((LACKS, FREE)))), sender("q", "map", "base"))
    running = ActivityView("s", "task run", "/robot", process="p", sends=("base",))
    seen = WaitGraph({**seen.activities, "s": running}, queues=seen.queues)
    set_by = SetBy(WHAT, ("q",), ("s",), verb="sends")
    assert resolved(seen).activities["a"].wait == All((Join("b"), AnyOf((set_by, FREE))))
    without = graph(Join("b"))
    assert resolved(without) is without
