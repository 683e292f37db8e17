"""Snapshots as JSON, the form in which processes exchange them.

The data comes from other processes of the network and is not trusted: every value's type is tested while it is read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import astuple
from typing import TypeAlias, get_args

from graphflow.errors import Place
from graphflow.interface import GroupChange, WhenFull
from graphflow.machines.regrouping import Regrouping
from graphflow.machines.waits.wait_graph import (
    FREE,
    ActivityView,
    All,
    AnyOf,
    Call,
    Condition,
    GroupView,
    Join,
    Opening,
    QueueView,
    SetBy,
    Slot,
    Sort,
    TransformWait,
    WaitGraph,
)

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"

VERSION = 8
DEEPEST = 50
"""Greatest nesting of conditions, so that data from the network cannot exhaust the stack."""


def to_json(graph: WaitGraph) -> dict[str, Json]:
    """Convert a snapshot to plain data that `from_json` reads back."""
    return {
        "v": VERSION,
        "activities": [_activity(a) for a in graph.activities.values()],
        "groups": [list(astuple(g)) for g in graph.groups.values()],
        "queues": [_queue(q) for q in graph.queues.values()],
        "blocked": dict(graph.blocked),
        "regroupings": {node: _regrouping(r) for node, r in graph.regroupings.items()},
    }


def _queue(q: QueueView) -> Json:
    head: list[Json] = [q.id, q.label, q.node, list(q.needs), list(q.calls), q.waiting, q.dropped]
    return [*head, q.process, q.is_declared, list(q.opens), _sent(q.sends)]


def _activity(a: ActivityView) -> Json:
    head: list[Json] = [a.id, a.label, a.node, list(a.holds), _condition(a.wait), a.serves, list(a.place), a.function]
    return [*head, a.age, a.left, a.process, a.is_inner, a.is_async, a.called, _sent(a.sends)]


def _sent(frames: tuple[str, ...] | None) -> Json:
    return None if frames is None else list(frames)


def _regrouping(regrouping: Regrouping) -> Json:
    groups: dict[str, Json] = {
        name: [list(c.handlers), c.limit, c.sets_limit, c.when_full, c.thread] for name, c in regrouping.groups.items()
    }
    return [regrouping.file, regrouping.section, regrouping.line, groups]


def _condition(condition: Condition, depth: int = 0) -> Json:
    match condition:
        case All() | AnyOf() if depth >= DEEPEST:
            return None  # reads back as FREE, which can only hide a deadlock
        case Call(id=call, name=name, servers=servers):
            return ["call", call, name, servers]
        case Slot(group=group, ticket=ticket):
            return ["slot", group, ticket]
        case Opening(service=service):
            return ["open", service]
        case Join(activity=activity):
            return ["join", activity]
        case SetBy(what=what, queues=queues, activities=activities, is_held=is_held, verb=verb, gives_up=ends):
            return ["set", what, list(queues), list(activities), is_held, verb, ends]
        case TransformWait(what=what, processes=processes, frames=frames, node=node):
            return ["transform", what, list(processes), list(frames), node]
        case All(of=conditions):
            return ["all", [_condition(c, depth + 1) for c in conditions]]
        case AnyOf(of=conditions):
            return ["any", [_condition(c, depth + 1) for c in conditions]]
        case _:
            return None


def from_json(data: Mapping[str, object]) -> WaitGraph:
    """Read a snapshot from plain data.

    Raises:
        ValueError, KeyError, TypeError: The data is not a snapshot.
    """
    if data["v"] != VERSION:
        raise ValueError(f"a snapshot of version {data['v']!r}")
    activities = [_read_activity(row) for row in _rows(data["activities"])]
    groups = [_read_group(row) for row in _rows(data["groups"])]
    queues = [_read_queue(row) for row in _rows(data["queues"])]
    return WaitGraph(
        {a.id: a for a in activities},
        {g.id: g for g in groups},
        {q.id: q for q in queues},
        {_text(k): _text(v) for k, v in _mapping(data["blocked"]).items()},
        {_text(k): _read_regrouping(_list(v)) for k, v in _mapping(data["regroupings"]).items()},
    )


def _read_group(row: list[object]) -> GroupView:
    id_, name, node, limit, is_declared, is_threaded, is_start, sort = row
    head = _text(id_), _text(name), _text(node), _limit(limit)
    return GroupView(*head, _bool(is_declared), _bool(is_threaded), _bool(is_start), _sort(sort))


def _read_queue(row: list[object]) -> QueueView:
    id_, label, node, needs, calls, waiting, dropped, process, is_declared, opens, sends = row
    head = _text(id_), _text(label), _text(node), _texts(needs), _texts(calls)
    counts, sent = (_int(waiting), _int(dropped)), None if sends is None else _texts(sends)
    return QueueView(*head, *counts, _text(process), _bool(is_declared), _texts(opens), sent)


def _read_activity(row: list[object]) -> ActivityView:
    id_, label, node, holds, wait, serves, place, function, age, left, process, is_inner, is_async, called, sends = row
    file, line, column = _list(place)
    return ActivityView(
        _text(id_),
        _text(label),
        _text(node),
        _texts(holds),
        _read_condition(wait, 0),
        _text(serves),
        Place(_text(file), _int(line), _int(column)),
        _text(function),
        _number(age),
        None if left is None else _number(left),
        _text(process),
        _bool(is_inner),
        _bool(is_async),
        _text(called),
        None if sends is None else _texts(sends),
    )


def _read_regrouping(row: list[object]) -> Regrouping:
    file, section, line, groups = row
    changes = {_text(name): _read_change(_list(change)) for name, change in _mapping(groups).items()}
    return Regrouping(changes, _text(file), _text(section), _int(line))


def _read_change(row: list[object]) -> GroupChange:
    handlers, limit, sets_limit, when_full, thread = row
    full: WhenFull | None = None if when_full is None else _when_full(when_full)
    return GroupChange(
        _texts(handlers), _limit(limit), _bool(sets_limit), full, None if thread is None else _bool(thread)
    )


def _sort(data: object) -> Sort:
    for known in get_args(Sort):
        if data == known:
            found: Sort = known
            return found
    raise ValueError(f"{data!r} is not a kind of group")


def _when_full(data: object) -> WhenFull:
    for known in get_args(WhenFull):
        if data == known:
            found: WhenFull = known
            return found
    raise ValueError(f"{data!r} is not a policy for full groups")


def _read_condition(data: object, depth: int) -> Condition:
    if depth > DEEPEST:
        raise ValueError("conditions are nested too deeply")
    match data:
        case None:
            return FREE
        case ["all", parts]:
            return All(tuple(_read_condition(part, depth + 1) for part in _list(parts)))
        case ["any", parts]:
            return AnyOf(tuple(_read_condition(part, depth + 1) for part in _list(parts)))
    return _read_leaf(data)


def _read_leaf(data: object) -> Condition:
    match data:
        case ["call", call, name, servers]:
            return Call(_text(call), _text(name), _int(servers))
        case ["slot", group, ticket]:
            return Slot(_text(group), _int(ticket))
        case ["open", service]:
            return Opening(_text(service))
        case ["join", activity]:
            return Join(_text(activity))
        case ["set", what, queues, activities, is_held, verb, ends]:
            return SetBy(_text(what), _texts(queues), _texts(activities), _bool(is_held), _text(verb), _bool(ends))
        case ["transform", what, processes, frames, node]:
            return TransformWait(_text(what), _texts(processes), _texts(frames), _text(node))
    raise ValueError(f"{data!r} is not a condition")


def _mapping(data: object) -> dict[object, object]:
    if not isinstance(data, dict):
        raise TypeError(f"{data!r} is not a mapping")
    return data


def _rows(data: object) -> list[list[object]]:
    return [_list(row) for row in _list(data)]


def _list(data: object) -> list[object]:
    if not isinstance(data, list):
        raise TypeError(f"{data!r} is not a list")
    return data


def _text(data: object) -> str:
    if not isinstance(data, str):
        raise TypeError(f"{data!r} is not a string")
    return data


def _texts(data: object) -> tuple[str, ...]:
    return tuple(map(_text, _list(data)))


def _int(data: object) -> int:
    if not isinstance(data, int) or isinstance(data, bool):
        raise TypeError(f"{data!r} is not a whole number")
    return data


def _bool(data: object) -> bool:
    if not isinstance(data, bool):
        raise TypeError(f"{data!r} is neither true nor false")
    return data


def _number(data: object) -> float:
    if not isinstance(data, (int, float)) or isinstance(data, bool):
        raise TypeError(f"{data!r} is not a number")
    try:
        return float(data)
    except OverflowError:
        raise ValueError(f"{data!r} is too large") from None


def _limit(data: object) -> int | None:
    if data is not None and _int(data) < 1:
        raise ValueError(f"{data!r} is not a limit")
    return None if data is None else _int(data)
