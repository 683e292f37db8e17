"""A plan: its text for people, its JSON for processes."""

from __future__ import annotations

import json
from dataclasses import FrozenInstanceError, asdict
from pathlib import Path

import pytest

from graphflow.errors import GraphFileError, Place
from graphflow.graph.plan import Plan, Rule, node_from_json
from graphflow.graph.resolve import resolve
from graphflow.markup import source
from graphflow.names import Remap

TEXT = """\
domain: 5
args: {gain: {default: 2}}
nodes:
  /sim: {class: a.b:Sim, process: one, env: {LANG: C}}
  /t/chaser:
    class: a.b:Chaser
    process: one
    params: {gain: $(var gain), deep: {list: [1, 2]}, name: é}
    remap: {goal: /t/pose}
    after: [/sim, spawn]
  /alone: {class: a.b:Sim}
steps:
  spawn: {call: /spawn, request: {x: 1.5}, after: /alone, type: turtlesim/srv/Spawn}
"""


@pytest.fixture
def plan() -> Plan:
    return resolve(source.read(TEXT, "f.yaml"), Path("/nowhere/f.yaml"), [], {})


def test_the_plan_as_text(plan: Plan) -> None:
    """`graphflow plan` shows everything that would run, with the place of each setting."""
    assert (
        str(plan)
        == """\
graph f  (f.yaml; classes from /nowhere)
domain 5
  gain:=2
/sim
  class    a.b:Sim
  process  one
  env      LANG=C
/t/chaser
  class    a.b:Chaser
  process  one
  after    /sim, spawn
  param    gain = 2  # f.yaml:8:20
  param    deep.list = [1, 2]  # f.yaml:8:46
  param    name = 'é'  # f.yaml:8:61
  remap    goal -> /t/pose  # f.yaml:9:13
/alone
  class    a.b:Sim
step spawn
  after    /alone
  call     /spawn {'x': 1.5}"""
    )


def test_json_gives_the_same_plan_back(plan: Plan) -> None:
    """A plan, and each of its nodes, survives the way to another process."""
    assert Plan.from_json(json.loads(json.dumps(plan.to_json()))) == plan
    assert [node_from_json(json.loads(json.dumps(asdict(n)))) for n in plan.nodes] == list(plan.nodes)


def test_processes(plan: Plan) -> None:
    """Nodes with the same word share a process, others have one that is called as they are."""
    names = {process: [n.name for n in nodes] for process, nodes in plan.processes().items()}
    assert names == {"one": ["/sim", "/t/chaser"], "/alone": ["/alone"]}


def test_a_rule_knows_where_it_was_written() -> None:
    """The names of a node can tell which line of which file changed them."""
    assert Rule("a", "/b", Place("f.yaml", 3, 4)).remap() == Remap("a", "/b", source="f.yaml:3:4")


def test_a_plan_does_not_change(plan: Plan) -> None:
    """What was checked is what runs."""
    with pytest.raises(FrozenInstanceError):
        plan.domain = 6  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        plan.nodes[0].process = "two"  # type: ignore[misc]


def test_a_part_of_a_plan() -> None:
    """Some nodes and what comes before them, steps and nodes; a name that is not there is told."""
    text = "nodes: {a: {class: x:Y}, b: {class: x:Y, after: s}, c: {class: x:Y}}\n"
    text += "steps: {s: {wait: /a, after: a}, t: {wait: /c}}"
    whole = resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"), [], {})
    part = whole.only(["b"])
    assert ([n.name for n in part.nodes], [s.name for s in part.steps]) == (["/a", "/b"], ["s"])
    assert [n.name for n in whole.only(["/c"]).nodes] == ["/c"]
    with pytest.raises(GraphFileError, match="the graph has no node /bb; did you mean '/b'"):
        whole.only(["bb"])


def test_policies_are_shown() -> None:
    """What follows an end, and what is logged, where it is not the usual; what comes after what, and how."""
    text = (
        "strategy: one_for_all\n"
        "nodes:\n  a: {class: x:Y, restart: {policy: always, delay: 2}, critical: true, log_level: warn}\n"
        "  b: {command: [ls, a b], on_exit: shutdown, after: {a: done, s: done}}\nsteps: {s: {delay: 1}}\n"
    )
    lines = list(resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"), [], {}).lines())[1:]
    assert lines == [
        "strategy one_for_all",
        "/a",
        "  class    x:Y",
        "  restart  always, after 2 to 10 s, up to 5 times in 30 s",
        "  critical",
        "  logs     from warn",
        "/b",
        "  command  ls 'a b'",
        "  after    /a (done), s",
        "  on_exit  shutdown",
        "step s",
        "  delay    1 s",
    ]
