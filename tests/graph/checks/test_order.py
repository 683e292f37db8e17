"""What starts after what."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.graph.plan import Plan
from graphflow.graph.resolve import resolve
from graphflow.markup import source


def plan(text: str) -> Plan:
    return resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"), [], {})


def test_what_is_waited_for() -> None:
    """A node until it is ready, unless its end is asked for; a step until it is done."""
    found = plan(
        """\
nodes:
  a: {class: x:Y}
  b: {command: [ls], after: {a: exited, s: ready}}
  c: {class: x:Y, after: {/b: done, a: ready}}
steps: {s: {wait: /a}}
"""
    )
    assert [n.after for n in found.nodes] == [
        {},
        {"/a": "exited", "s": "ready"},
        {"/b": "done", "/a": "ready"},
    ]


def test_names_in_a_namespace() -> None:
    """A name is looked for beside the one that has it first, and then by its key anywhere, if only one is called so."""
    found = plan(
        """\
group:
  - {namespace: one, nodes: {sim: {class: x:Y}, view: {class: x:Y, after: sim}}}
  - {namespace: two, nodes: {sim: {class: x:Y}, view: {class: x:Y, after: [sim, base]}}}
nodes: {base: {class: x:Y}, /n/other: {class: x:Y, after: /one/sim}}
"""
    )
    after = {n.name: list(n.after) for n in found.nodes}
    assert after["/one/view"] == ["/one/sim"]
    assert after["/two/view"] == ["/two/sim", "/base"]
    assert after["/n/other"] == ["/one/sim"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("{a: {class: x:Y, after: b}, b: {class: x:Y, after: {a: done}}}", "waits for itself: /a after /b after /a"),
        ("{a: {class: x:Y, after: c}}", "1:32: after: there is no node or step 'c'; there is /a"),
        ("{a: {class: x:Y, after: {c: done}}}", "1:36: after: there is no node or step 'c'"),
    ],
)
def test_what_cannot_be(text: str, said: str) -> None:
    """A ring, whatever is waited for in it, and a name that nobody has."""
    with pytest.raises(GraphFileError) as caught:
        plan(f"nodes: {text}")
    assert said in str(caught.value)
