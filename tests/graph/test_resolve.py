"""A graph file resolved: names, parameters, remaps, order; and every mistake with its exact place."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.errors import GraphFileError, Place
from graphflow.graph.checks.check import check
from graphflow.graph.checks.order import find_cycle
from graphflow.graph.plan import Plan, Rule, Setting
from graphflow.graph.resolve import load, resolve
from graphflow.markup import source
from nodes.turtlesim import TurtleSim
from tests.cases import count, slow

ENV = {"USER": "ada"}


def plan(text: str, *given: str) -> Plan:
    return resolve(source.read(text, "f.yaml"), Path("/nowhere/to/be/f.yaml"), given, ENV)


def problems(text: str, *given: str) -> list[str]:
    """Every mistake of a file, as `line:column: message`."""
    with pytest.raises(GraphFileError) as caught:
        plan(text, *given)
    assert list(caught.value.problems) == sorted(caught.value.problems)
    return [str(p).removeprefix("f.yaml:") for p in caught.value.problems]


def test_a_whole_file() -> None:
    """Everything a file says is in the plan, resolved, with the place it was said."""
    found = plan(
        """\
name: chase
domain: 7
args:
  follower: {default: turtle2, doc: Who follows.}
  gain: {default: 5.0, unit: 1/s}
nodes:
  /turtlesim: {class: nodes.turtlesim:TurtleSim, process: sim, env: {LANG: C, LEVEL: 3}}
  chaser:
    class: nodes.turtle_follower:TurtleFollower
    namespace: /$(var follower)
    params:
      gain: $(var gain)
      limits: {speed: {most: 0.8}}
    remap: {goal: /turtle1/pose, ~/x: y}
    after: spawn
steps:
  spawn:
    call: spawn
    type: turtlesim/srv/Spawn
    after: [/turtlesim]
    request: {x: 2.0, name: $(var follower)}
    timeout: 3
""",
        "follower:=donatello",
    )
    assert (found.name, found.domain, found.file, found.root) == ("chase", 7, "f.yaml", "/nowhere/to/be")
    assert found.args == {"follower": "donatello", "gain": 5.0}
    simulator, chaser = found.nodes
    assert (simulator.name, simulator.class_path) == ("/turtlesim", "nodes.turtlesim:TurtleSim")
    assert (simulator.place, simulator.class_place) == (Place("f.yaml", 7, 3), Place("f.yaml", 7, 23))
    assert (simulator.process, simulator.env) == ("sim", {"LANG": "C", "LEVEL": "3"})
    assert (chaser.name, chaser.place) == ("/donatello/chaser", Place("f.yaml", 8, 3))
    assert chaser.params == {
        "gain": Setting(5.0, Place("f.yaml", 12, 13)),
        "limits.speed.most": Setting(0.8, Place("f.yaml", 13, 30)),
    }
    assert chaser.remaps == (
        Rule("goal", "/turtle1/pose", Place("f.yaml", 14, 13)),
        Rule("~/x", "y", Place("f.yaml", 14, 34)),
    )
    assert chaser.after == {"spawn": "done"}
    (spawn,) = found.steps
    assert (spawn.name, spawn.do, spawn.target, spawn.type) == ("spawn", "call", "/spawn", "turtlesim/srv/Spawn")
    assert (spawn.after, spawn.timeout) == ({"/turtlesim": "ready"}, 3.0)
    assert spawn.request == {"x": 2.0, "name": "donatello"}
    places = (spawn.place, spawn.target_place, spawn.request_place)
    assert places == (Place("f.yaml", 17, 3), Place("f.yaml", 18, 11), Place("f.yaml", 21, 14))
    assert spawn.field_places == {"x": Place("f.yaml", 21, 15), "name": Place("f.yaml", 21, 23)}


def test_a_file_is_called_as_its_stem() -> None:
    """Without `name` the graph has the name of its file."""
    assert plan("nodes: {a: {class: x:Y}}").name == "f"


@pytest.mark.parametrize(
    ("node", "name"),
    [
        ("a: {class: x:Y}", "/a"),
        ("/a/b: {class: x:Y}", "/a/b"),
        ("a: {class: x:Y, namespace: n}", "/n/a"),
        ("a: {class: x:Y, namespace: /n/m}", "/n/m/a"),
        ("a: {class: x:Y, namespace: /}", "/a"),
        ("b/a: {class: x:Y, namespace: n}", "/n/b/a"),
        ("$(env USER)_1: {class: x:Y}", "/ada_1"),
    ],
)
def test_names_of_nodes(node: str, name: str) -> None:
    """A key is a name, absolute or relative to the namespace."""
    assert plan(f"nodes: {{{node}}}").nodes[0].name == name


def test_after_takes_keys_and_full_names() -> None:
    """A node is named in `after` as its key or by its full name, a step by its name."""
    found = plan(
        """\
nodes:
  a: {class: x:Y, namespace: n}
  b: {class: x:Y, after: a}
  c: {class: x:Y, after: [/n/a, s]}
steps:
  s: {call: /x, after: [b, /b]}
"""
    )
    assert [n.after for n in found.nodes] == [{}, {"/n/a": "ready"}, {"/n/a": "ready", "s": "done"}]
    assert found.steps[0].after == {"/b": "ready"}


def test_empty_sections_are_no_mistake() -> None:
    """Sections whose lines are commented out are as good as absent."""
    found = plan("args:\nsteps:\nnodes:\n  a:\n    class: x:Y\n    params:\n    remap:\n    after:\n")
    assert (found.nodes[0].params, found.nodes[0].remaps, found.nodes[0].after) == ({}, (), {})


ARGS = """\
args:
  gain: {default: 5.0}
  name: {default: '7', choices: ['7', turtle2]}
  mode: {choices: [fast, 2]}
nodes:
  a: {class: x:Y, params: {gain: $(var gain), name: $(var name), mode: $(var mode), text: g=$(var gain)}}
"""


@pytest.mark.parametrize(
    ("given", "values"),
    [
        (["mode:=2"], {"gain": 5.0, "name": "7", "mode": 2}),
        (["mode:=fast", "gain:=2"], {"gain": 2, "name": "7", "mode": "fast"}),
        (["mode:=2", "gain:=1", "gain:=1.5"], {"gain": 1.5, "name": "7", "mode": 2}),
        (["mode:=2", "name:=7"], {"gain": 5.0, "name": "7", "mode": 2}),
        (["mode:=2", "name:='7'"], {"gain": 5.0, "name": "7", "mode": 2}),
        (["mode:=2", "name:=turtle2"], {"gain": 5.0, "name": "turtle2", "mode": 2}),
    ],
)
def test_arguments(given: Sequence[str], values: dict[str, Any]) -> None:
    """The command line comes before the default, the last word counts, and text stays text where the default is."""
    found = plan(ARGS, *given)
    assert found.args == values
    params = {name: setting.value for name, setting in found.nodes[0].params.items()}
    assert {name: params[name] for name in values} == values
    assert params["text"] == f"g={values['gain']}"


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        (["mode:=2", "gian:=1"], "command line: there is no argument 'gian'; did you mean 'gain'?"),
        (["mode:=2", "gain"], "command line: 'gain': an argument is written name:=value"),
        (["mode:=2", "gain=1"], "command line: 'gain=1': an argument is written name:=value; write gain:=1"),
        (
            ["mode:=2", "b.yaml"],
            "command line: 'b.yaml': an argument is written name:=value; give one graph file at a time, or a third "
            "one with include: [FILE, FILE]",
        ),
        (["mode:=2", ":=1"], "command line: ':=1': an argument is written name:=value"),
        (["mode:=slow"], "4:3: argument 'mode' is 'slow', but must be one of fast, 2"),
        (["mode:=2", "name:=8"], "3:3: argument 'name' is '8', but must be one of 7, turtle2"),
        (
            ["mode:=2", "gain:=[1, 2]"],
            "command line: argument 'gain': expected a number, as its default 5.0 is, got [1, 2]",
        ),
        (
            ["mode:=2", "gain:={no yaml"],
            "command line: argument 'gain': expected a number, as its default 5.0 is, got '{no yaml'",
        ),
        ([], "4:3: argument 'mode' has no default: give it as mode:=VALUE"),
    ],
)
def test_wrong_arguments(given: Sequence[str], problem: str) -> None:
    """A misspelt or malformed argument, or one that is missing, is told with the way to give it."""
    assert problem in problems(ARGS, *given)


def test_an_argument_where_none_is_declared() -> None:
    """In a file without arguments every one is a mistake."""
    assert problems("nodes: {a: {class: x:Y}}", "gain:=1") == [
        "command line: there is no argument 'gain'; the file declares none; a parameter of a node goes "
        "below its params:, or is set by graphflow param set NODE gain VALUE"
    ]


HEAD = "nodes:\n  a: {class: x:Y}\n"


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "1:1: the file is empty; a graph file is a mapping with the key 'nodes', for example nodes: {/talker: "),
        ("- a", "1:1: a graph file is a mapping with the key 'nodes', for example nodes: {/talker: {class: "),
        ("args: {}", "1:1: the key 'nodes' is missing"),
        ("nodes:", "1:7: there is no node, for example nodes: {/talker: "),
        ("nodes: {}", "1:8: there is no node"),
        ("nodes: [a]", "1:8: nodes: expected a mapping, got ['a'], for example nodes: {/talker: "),
        ("node:\n  a: {class: x:Y}", "1:1: unknown key 'node'; did you mean 'nodes'?"),
        ("nodes:\n  a:\n", "2:3: the key 'class' is missing"),
        ("nodes:\n  a: x:Y\n", "2:6: /a: expected a mapping, got 'x:Y', for example {class: nodes.talker:Talker}"),
        ("nodes:\n  a: {clas: x:Y}\n", "2:7: unknown key 'clas'; did you mean 'class'?"),
        ("nodes:\n  a: {class:x:Y}\n", "2:7: unknown key 'class:x:Y'; write a space after 'class:'"),
        ("nodes:\n  /a {class: x:Y}\n", "2:14: a colon is missing after '/a'"),
        ("nodes:\n  a:{class: x:Y}\n", "2:13: the name 'a:{class' has a colon in it; write a space after the colon"),
        ("nodes:\n  a: {class: x.Y}\n", "2:14: 'x.Y' is not a class; write x:Y"),
        ("nodes:\n  a: {class: 3}\n", "2:14: class: expected text, got 3"),
        ("nodes:\n  a: {class: x:Y, parms: {}}\n", "2:19: unknown key 'parms'; did you mean 'params'?"),
        (
            "nodes:\n  a: {class: x:Y, params: [b]}\n",
            "2:27: params: expected a mapping, got ['b'], for example",
        ),
        ("nodes:\n  a: {class: x:Y, params: {b: }}\n", "2:28: parameter 'b' has no value; an empty string is ''"),
        (
            "nodes:\n  a:\n    class: x:Y\n    params:\n      b: {c: 1}\n      b.c: 2\n",
            "6:12: parameter 'b.c' is given twice, first on line 5; remove one",
        ),
        (
            "nodes:\n  a: {class: x:Y, remap: ['b:=c']}\n",
            "2:26: remap: expected a mapping; write remap: {b: c}",
        ),
        (
            "nodes:\n  a: {class: x:Y, remap: {b c: d}}\n",
            "2:27: 'b c' is not a topic or service name: 'b c' may have only",
        ),
        ("nodes:\n  a: {class: x:Y, remap: {b: /c/}}\n", "2:27: '/c/' is not a topic or service name: it ends with /"),
        ("nodes:\n  a: {class: x:Y, remap: {b: 3}}\n", "2:30: remap.b: expected text, got 3"),
        (
            "nodes:\n  a: {class: x:Y, remap: {__ns: /n}}\n",
            "2:27: '__ns' cannot be remapped; a node's name is its key, its namespace goes under namespace:",
        ),
        (
            "nodes:\n  a: {class: x:Y, remap: {'*chatter': /b}}\n",
            "2:27: '*chatter': a wildcard stands for whole parts of a name",
        ),
        (
            "nodes:\n  a: {class: x:Y, remap: {'/*': '/b/\\2'}}\n",
            "2:27: /b/\\2 has \\2, for which the rule has no wildcard",
        ),
        ("nodes:\n  a: {class: x:Y, process: 3}\n", "2:28: process: expected text, got 3"),
        ("nodes:\n  a: {class: x:Y, env: {B: true}}\n", "2:28: env.B: expected text or a number, got true"),
        ("nodes:\n  a: {class: x:Y, after: b}\n", "2:26: after: there is no node or step 'b'; there is /a"),
        (
            "nodes:\n  a: {class: x:Y, after: [a2]}\n",
            "2:27: after: there is no node or step 'a2'; there is /a",
        ),
        (
            "nodes:\n  a: {class: x:Y, after: 3}\n",
            "2:26: after: expected a name, a list of names, or NAME: ready|exited|done, got 3",
        ),
        (
            "nodes:\n  a: {class: x:Y, after: [3]}\n",
            "2:26: after: expected a name, a list of names, or NAME: ready|exited|done, got [3]",
        ),
        ("nodes:\n  a: {class: x:Y, after: a}\n", "2:3: waits for itself: /a after /a; remove one of these after:"),
        ("nodes:\n  1a: {class: x:Y}\n", "2:3: '/1a' is not a node name: '1a' may have only letters, digits and _"),
        ("nodes:\n  a-b: {class: x:Y}\n", "2:3: '/a-b' is not a node name: 'a-b' may have only letters"),
        ("nodes:\n  /: {class: x:Y}\n", "2:3: '/' is not a node name: it ends with /"),
        ("nodes:\n  a: {class: x:Y, namespace: 1n}\n", "2:30: '/1n' is not a namespace: '1n' may have only letters"),
        (
            "nodes:\n  /a: {class: x:Y, namespace: n}\n",
            "2:31: /a is a full name, so a namespace would have no effect; name the node a, or remove this",
        ),
        (
            "nodes:\n  /n/a: {class: x:Y}\n  a: {class: x:Y, namespace: n}\n",
            "3:3: there are two nodes /n/a; the other is on line 2",
        ),
        (
            "nodes:\n  a: {class: x:Y}\n  /a: {class: x:Y}\n",
            "3:3: there are two nodes /a; the other is on line 2",
        ),
        (
            "nodes:\n  ada: {class: x:Y}\n  $(env USER): {class: x:Y}\n",
            "3:3: there are two nodes /ada; the other is on line 2",
        ),
        ("nodes:\n  $(env NOBODY): {class: x:Y}\n", "2:3: the environment variable NOBODY is not set; give a default"),
        (
            "nodes:\n  a:\n    class: x:Y\n    params: {b: [1, $(var c)]}\n",
            "4:21: there is no argument 'c'; declare it",
        ),
        (HEAD + "name: a/b\n", "3:7: 'a/b' is not a name for a graph; use letters, digits, _, - and ."),
        (HEAD + "domain: -1\n", "3:9: domain: expected 0 or more, got -1"),
        (HEAD + "domain: $(env USER)\n", "3:9: domain: expected a whole number, got 'ada'"),
        (HEAD + "args: [b]\n", "3:7: args: expected a mapping, got ['b'], for example args: {rate: {default: 1.0}}"),
        (HEAD + "args: {b: 3}\n", "3:11: args.b: expected a mapping; write b: {default: 3}"),
        (HEAD + "args: {b: {defualt: 3}}\n", "3:12: unknown key 'defualt'; did you mean 'default'?"),
        (HEAD + "args: {b: }\n", "3:8: argument 'b' has no default: give it as b:=VALUE"),
        (HEAD + "args: {b: {default: 3, choices: 3}}\n", "3:33: args.b.choices: expected a list, got 3"),
        (
            HEAD + "steps: {s: {}}\n",
            "3:9: a step has one of call, set, goal, wait, delay, log, shutdown; 's' has none of them",
        ),
        (HEAD + "steps: {s: /spawn}\n", "3:12: steps.s: expected a mapping, got '/spawn', for example {call: /spawn}"),
        (HEAD + "steps: [{call: /x}]\n", "3:8: steps: expected a mapping, got [{'call': '/x'}], for example steps: "),
        (HEAD + "steps: {s: {call: b c}}\n", "3:19: 'b c' is not a topic or service name: 'b c' may have only letters"),
        (HEAD + "steps: {s: {call: /b, type: Spawn}}\n", "3:29: 'Spawn' is not a service type; write package/srv/Name"),
        (HEAD + "steps: {s: {call: /b, request: [1]}}\n", "3:32: request: expected a mapping, got [1], for"),
        (HEAD + "steps: {s: {call: /b, timeout: 0}}\n", "3:32: timeout: expected more than 0, got 0"),
        (HEAD + "steps: {s: {call: /b, timeout: soon}}\n", "3:32: timeout: expected a number, got 'soon'"),
        (HEAD + "steps: {s: {call: /b, after: b}}\n", "3:30: after: there is no node or step 'b'; there is /a, s"),
        (HEAD + "steps: {a: {call: /b}}\n", "3:9: a node is already called 'a'; give the step another name"),
        (HEAD + "steps: {/a: {call: /b}}\n", "3:9: a node is already called '/a'; give the step another name"),
    ],
)
def test_one_mistake_is_one_problem(text: str, problem: str) -> None:
    """A mistake gives one line, at its exact place, with what was meant or how to write it."""
    (found,) = problems(text)
    assert found.startswith(problem)


def test_a_long_value_is_cut_in_messages() -> None:
    """A message stays one line that can be read."""
    (found,) = problems(f"nodes: {['word'] * 1000}")
    assert len(found) < 200


def test_a_ring_of_waiting() -> None:
    """Nodes and steps that wait for one another are told in their order."""
    assert problems(
        """\
nodes:
  a: {class: x:Y, after: s}
  b: {class: x:Y, after: [c, a]}
  c: {class: x:Y}
steps:
  s: {call: /x, after: /b}
"""
    ) == ["2:3: waits for itself: /a after s after /b after /a; remove one of these after:"]


def test_all_mistakes_of_the_grammar_come_together() -> None:
    """Nobody has to mend a file one mistake at a time; the problems are in the order of the file."""
    assert problems(
        """\
domian: 3
args:
  b: {default: 1, choices: [2]}
nodes:
  a: {clas: x:Y, params: {p: $(var c)}}
  b:
    class: x.Y
    remap: 3
steps:
  s: {call: 3, timeout: -1}
""",
        "c:=1",
    ) == [
        "command line: there is no argument 'c'; there is b; a parameter of a node goes below its params:, or is set "
        "by graphflow param set NODE c VALUE",
        "1:1: unknown key 'domian'; did you mean 'domain'?",
        "3:3: argument 'b' is 1, but must be one of 2",
        "5:7: unknown key 'clas'; did you mean 'class'?",
        "5:30: there is no argument 'c'; there is b",
        "7:12: 'x.Y' is not a class; write x:Y",
        "8:12: remap: expected a mapping, got 3, for example remap: {goal: /turtle1/pose}",
        "10:13: call: expected text, got 3",
        "10:25: timeout: expected more than 0, got -1",
    ]


def test_all_mistakes_of_meaning_come_together() -> None:
    """Names, places in the order and parameters are all looked at, also when one of them is wrong."""
    assert problems(
        """\
nodes:
  a-b: {class: x:Y}
  c: {class: x:Y, params: {p: , q: {r: }}, after: a-b}
  d: {class: x:Y, namespace: 5, remap: {'~x': y, e: 'f g'}, after: [nobody]}
  /c: {class: x:Y}
steps:
  s: {call: x y, after: c}
  t: {call: /x, after: [s, ss]}
""".replace("5,", "'5',")
    ) == [
        "2:3: '/a-b' is not a node name: 'a-b' may have only letters, digits and _, and may not begin with a digit; "
        "did you mean 'a_b'?",
        "3:28: parameter 'p' has no value; an empty string is ''",
        "3:37: parameter 'q.r' has no value; an empty string is ''",
        "4:30: '/5' is not a namespace: '5' may have only letters, digits and _, and may not begin with a digit",
        "5:3: there are two nodes /c; the other is on line 3",
        "7:13: 'x y' is not a topic or service name: 'x y' may have only letters, digits and _, and may not begin with "
        "a digit; did you mean 'x_y'?",
        "8:28: after: there is no node or step 'ss'; did you mean 's'?",
    ]


def test_load_reads_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Messages show the path from the working directory; the plan knows the folder."""
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "graphs.yaml"
    file.write_bytes(b"\xef\xbb\xbfnodes: {a: {class: x:Y, params: {here: $(dirname)}}}")
    found = load(file)
    assert (found.file, found.name, found.root) == ("graphs.yaml", "graphs", str(tmp_path))
    assert found.nodes[0].params["here"] == Setting(str(tmp_path), Place("graphs.yaml", 1, 40))
    file.write_text("nodes: {")
    with pytest.raises(GraphFileError, match=r"^graphs\.yaml:1:9: not valid YAML"):
        load(file)
    with pytest.raises(GraphFileError, match=r"^none\.yaml: cannot be read: No such file or directory$"):
        load(tmp_path / "none.yaml")


@pytest.mark.parametrize(
    ("edges", "ring"),
    [
        ({}, []),
        ({"a": []}, []),
        ({"a": ["b"], "b": ["c"], "c": []}, []),
        ({"a": ["b", "c"], "b": ["d"], "c": ["d"]}, []),
        ({"a": ["a"]}, ["a"]),
        ({"a": ["b"], "b": ["a"]}, ["a", "b"]),
        ({"a": ["b"], "b": ["c"], "c": ["b"]}, ["b", "c"]),
        ({"a": ["nobody"]}, []),
    ],
)
def test_rings(edges: dict[str, list[str]], ring: list[str]) -> None:
    """A ring is found wherever it begins, and a diamond is none."""
    assert find_cycle(edges) == ring


@settings(derandomize=True, max_examples=count(few=50, full=200), deadline=None)
@given(st.dictionaries(st.sampled_from("abcdef"), st.lists(st.sampled_from("abcdef"), max_size=4)))
def test_a_ring_is_one(edges: dict[str, list[str]]) -> None:
    """What is found is a ring of the edges, and nothing is found only where repeated removal of leaves ends."""
    ring = find_cycle(edges)
    assert all(follower in edges[name] for name, follower in zip(ring, [*ring[1:], *ring[:1]], strict=True))
    left = {name: set(edges.get(name, ())) for name in "abcdef"}
    while leaves := [name for name, after in left.items() if not after & left.keys()]:
        for name in leaves:
            del left[name]
    assert bool(ring) == bool(left)


WORDS = st.sampled_from(
    [
        "a",
        "/b",
        "a/b",
        "x:Y",
        "1",
        "$(var a)",
        "$(var b)",
        "$(env USER)",
        "$(",
        "~",
        "/",
        "__ns",
        "turtlesim/srv/Spawn",
        "",
    ]
)
SCALARS = WORDS | st.integers(-2, 3) | st.floats(allow_nan=False) | st.booleans() | st.none()
KEYS = WORDS | st.sampled_from(
    [
        "class",
        "namespace",
        "params",
        "remap",
        "process",
        "env",
        "after",
        "call",
        "type",
        "request",
        "timeout",
        "default",
    ]
)
TREES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=4), max_leaves=12
)
NODES = st.dictionaries(
    WORDS,
    TREES
    | st.fixed_dictionaries({"class": st.just("x:Y")}, optional={"after": TREES, "params": TREES, "remap": TREES}),
    min_size=1,
    max_size=3,
)
FILES = st.fixed_dictionaries(
    {"nodes": NODES | TREES},
    optional={
        "args": st.dictionaries(WORDS, TREES, max_size=2) | TREES,
        "steps": TREES,
        "domain": TREES,
        "name": TREES,
    },
)


def written(value: Any, path: source.Path = ()) -> source.Source:
    """A tree as if it had been read, all of it in one place."""
    found = source.Source(value, {path: Place("f.yaml", 1, 1)}, {})
    items = value.items() if isinstance(value, dict) else enumerate(value if isinstance(value, list) else ())
    for key, item in items:
        inner = written(item, (*path, key))
        found.places.update(inner.places)
        found.keys.update(inner.keys)
        if isinstance(key, str):
            found.keys[(*path, key)] = Place("f.yaml", 1, 1)
    return found


@slow
@settings(derandomize=True, max_examples=count(few=150, full=600), deadline=None)
@given(FILES | TREES, st.lists(WORDS, max_size=2))
def test_any_tree_is_a_plan_or_a_list_of_problems(tree: Any, given: list[str]) -> None:
    """No content of a file leads to another error than GraphFileError, and a plan survives JSON."""
    try:
        found = resolve(written(tree), Path("/nowhere/f.yaml"), given, ENV)
    except GraphFileError as error:
        places = {problem.place.file for problem in error.problems}
        assert places <= {"f.yaml", "command line"}, places
    else:
        assert Plan.from_json(found.to_json()) == found


def test_processes_wait_as_a_whole() -> None:
    """What one node of a process waits for, its mates wait for: a ring that goes through two of them is one."""
    text = (
        "nodes:\n  /a: {class: m:A, process: p, after: /b}\n"
        "  /b: {class: m:A, after: /c}\n  /c: {class: m:A, process: p}\n"
    )
    with pytest.raises(GraphFileError) as caught:
        resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"))
    assert "waits for itself: process p after /b after process p" in str(caught.value)


def test_a_process_has_one_environment() -> None:
    """Two nodes of one process cannot want two values of one variable."""
    text = (
        "nodes:\n  /a: {class: m:A, process: p, env: {X: 1, Y: 1}}\n"
        "  /b: {class: m:A, process: p, env: {X: 2, Y: 1}}\n  /c: {class: m:A, env: {X: 3}}\n"
    )
    with pytest.raises(GraphFileError) as caught:
        resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"))
    assert str(caught.value) == "f.yaml:3:3: X=2 contradicts X=1 of /a, which shares process 'p'"


def planned(root: Path, text: str) -> Plan:
    return resolve(source.read(text, "f.yaml"), root / "f.yaml", [], ENV)


def test_executables_of_packages(lamps: Path) -> None:
    """Of the workspace, as the folder it lies in; of graphflow or the project, as the class; of ROS, by `ros2 run`."""
    found = planned(
        lamps,
        """\
nodes:
  big: {pkg: lamp, exec: shine, args: [-x, 1], params: {level: 3}, remap: {a: b}, log_level: debug}
  own: {pkg: lamp, exec: blink, keep_names: true, params_file: p.yaml}
  sim: {pkg: turtlesim, exec: turtlesim_node}
  nav: {pkg: nav2, exec: planner}
""",
    )
    big, own, sim, nav = found.nodes
    folder = str(lamps / "src" / "lamp")
    assert big.command == ("graphflow", "run", folder, "shine", "-x", "1")
    assert (big.executable, big.what, big.keeps_names, big.log_level) == ("lamp shine", "lamp shine", False, "debug")
    assert big.params == {"level": Setting(3, Place("f.yaml", 2, 64))}
    assert big.remaps == (Rule("a", "b", Place("f.yaml", 2, 76)),)
    assert own.command == ("graphflow", "run", folder, "blink.py")
    assert (own.keeps_names, own.params_files, own.params) == (True, (str(lamps / "p.yaml"),), {})
    assert (sim.class_path, sim.command, sim.executable) == ("nodes.turtlesim:TurtleSim", (), "")
    assert nav.command == ("ros2", "run", "nav2", "planner")
    assert Plan.from_json(json.loads(json.dumps(found.to_json()))) == found
    assert {"  names    as its code has them", f"  params   of {lamps / 'p.yaml'}"} <= set(found.lines())


def test_what_groups_give_to_executables(lamps: Path) -> None:
    """Namespace, parameters, remaps and policies, as to any node; nothing to a foreign program."""
    found = planned(
        lamps,
        "group: {namespace: n, params: {p: 1}, remap: {x: y}, restart: always, nodes: {a: {pkg: lamp, exec: shine, "
        "params: {q: 2}}, b: {command: [ls]}}}\n",
    )
    a, b = found.nodes
    assert (a.name, {name: s.value for name, s in a.params.items()}) == ("/n/a", {"p": 1, "q": 2})
    assert ([r.match for r in a.remaps], a.restart.policy) == (["x"], "always")
    assert (b.name, b.params, b.remaps) == ("/n/b", {}, ())


def test_programs_that_keep_their_names(lamps: Path) -> None:
    """The file's name is only that of the process, so that there may be several of one."""
    text = "for: {var: i, in: 1..3, nodes: {a: {pkg: lamp, exec: shine, keep_names: true, args: [$(var i)]}}}"
    assert [node.name for node in planned(lamps, text).nodes] == ["/a", "/a_2", "/a_3"]
    text = "for: {var: i, in: 1..2, nodes: {a: {pkg: lamp, exec: shine}}}"
    with pytest.raises(GraphFileError, match="this makes the node /a more than once: put the loop's variable"):
        planned(lamps, text)


def test_parameters_that_only_a_program_may_have(lamps: Path) -> None:
    """What groups give to programs of packages cannot be checked, and is not complained of."""
    text = "group: {params: {p: 1}, remap: {x: y}, nodes: {a: {pkg: lamp, exec: shine}}}\nsteps: {s: {call: /z}}\n"
    assert check(planned(lamps, text), {}) == []


def test_packages_that_only_ros_may_have(lamps: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where there is no ROS 2, the plan can be looked at, but not started."""
    monkeypatch.setenv("PATH", "/nowhere")
    [problem] = check(planned(lamps, "nodes: {a: {pkg: nav2, exec: planner}}"), {})
    said = "there is no package 'nav2' in the workspace, and no ROS 2 is sourced"
    assert (problem.message, str(problem.place)) == (said, "f.yaml:1:18")


def test_ros2_as_a_program(lamps: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is there whether or not a ROS 2 is sourced, since graphflow takes its place."""
    monkeypatch.setenv("PATH", "/nowhere")
    assert check(planned(lamps, "nodes: {a: {command: [ros2, bag, record, -a]}}"), {}) == []


def test_a_class_and_an_executable(lamps: Path) -> None:
    """One of the two was meant, also where the executable is a class that is here."""
    for text in ("pkg: demo_nodes_py, exec: talker", "pkg: lamp, exec: shine"):
        with pytest.raises(GraphFileError, match="write class:, or pkg: and exec:, not both"):
            planned(lamps, f"nodes: {{a: {{class: 'x:Y', {text}}}}}")


def test_a_group_of_lifecycle_nodes(lamps: Path) -> None:
    """What it says of them is not for executables, of which only some have a life cycle."""
    nodes = "{p: {pkg: lamp, exec: shine}, q: {pkg: lamp, exec: shine, lifecycle: inactive}}"
    found = planned(lamps, f"group: {{lifecycle: active, nodes: {nodes}}}")
    assert {node.name: node.lifecycle for node in found.nodes} == {"/p": "", "/q": "inactive"}


def test_arguments_that_no_launch_file_declares_are_let_pass(lamps: Path) -> None:
    """As ROS lets them, with a remark; they have their values for what asks for them."""
    (lamps / "f.launch.yaml").write_text("launch: [{executable: {cmd: ls, if: $(var N true)}}]\n")
    found = load(lamps / "f.launch.yaml", ["N:=false"])
    [remark] = found.remarks
    assert remark.endswith("no argument 'N' is declared; only $(var N) has its value")
    assert found.nodes == ()


def test_what_a_node_does_not_have_is_let_pass_in_launch_files(lamps: Path) -> None:
    """As ROS does; the node itself tells it."""
    params = "param: [{name: no_such, value: 1}], remap: [{from: nothing, to: /x}]"
    (lamps / "f.launch.yaml").write_text(f"launch: [{{node: {{pkg: turtlesim, exec: turtlesim_node, {params}}}}}]\n")
    [node] = load(lamps / "f.launch.yaml").nodes
    assert (node.params["no_such"].is_optional, node.params["no_such"].is_unchecked) == (True, True)
    assert [(rule.is_optional, rule.is_unchecked) for rule in node.remaps] == [(True, True)]
    plan = load(lamps / "f.launch.yaml")
    assert check(plan, {node.class_path: TurtleSim.interface()}) == []


def test_executables_that_are_only_known_when_a_launch_file_starts(lamps: Path) -> None:
    """Are called as they are then."""
    args = "{arg: {name: which, default: turtlesim_node}}"
    text = f"launch: [{args}, {{node: {{pkg: $(var p turtlesim), exec: $(var which)}}}}]\n"
    (lamps / "f.launch.yaml").write_text(text)
    [node] = load(lamps / "f.launch.yaml").nodes
    assert (node.name, node.class_path) == ("/turtlesim", "nodes.turtlesim:TurtleSim")
    [node] = load(lamps / "f.launch.yaml", ["which:=turtle_teleop_key"]).nodes
    assert node.name == "/teleop_turtle"
    (lamps / "f.launch.yaml").write_text(text.replace("turtlesim_node", "shine").replace("$(var p turtlesim)", "lamp"))
    assert [(node.name, node.executable) for node in load(lamps / "f.launch.yaml").nodes] == [("/shine", "lamp shine")]


def test_a_launch_file_may_have_nothing_to_start(lamps: Path) -> None:
    """Also because of its conditions."""
    for actions in ("", "{executable: {cmd: ls, if: 'false'}}"):
        (lamps / "f.launch.yaml").write_text(f"launch: [{actions}]\n")
        assert load(lamps / "f.launch.yaml").nodes == ()


TYPES = """<launch>
  <arg name="n" default="foo"/>
  <let name="ten" value="10"/>
  <let name="zip" value="0042"/>
  <let name="list" value="[2, 5]"/>
  <let name="text" value="\\'[2, 5]\\'"/>
  <node pkg="demo_nodes_py" exec="talker">
    <param name="a" value="$(var ten)" type="float"/>
    <param name="b" value="$(var 'zip')" type="str"/>
    <param name="c" value="$(var list)"/>
    <param name="d" value="$(var text)"/>
    <param name="e" value="['$(var n)1', '$(var n)2']"/>
    <param name="f" value="\\'2\\', \\'5\\'" value-sep=", "/>
    <param name="g" value="$(var ten), 2" value-sep=", "/>
    <param name="h" value="\\$(var ten)"/>
  </node>
</launch>
"""


def test_parameters_of_launch_files_have_their_types(tmp_path: Path) -> None:
    """As launch gives them: those that are asked for, else what the text reads as, substitutions made."""
    (tmp_path / "f.launch.xml").write_text(TYPES)
    found = load(tmp_path / "f.launch.xml", [], {}).nodes[0].params
    assert {name: setting.value for name, setting in found.items()} == {
        "a": 10.0,
        "b": "0042",
        "c": [2, 5],
        "d": "[2, 5]",
        "e": ["foo1", "foo2"],
        "f": ["'2'", "'5'"],
        "g": [10, 2],
        "h": "$(var ten)",
    }


def test_a_namespace_without_effect_is_let_pass_in_launch_files(lamps: Path) -> None:
    """As ROS does."""
    (lamps / "f.launch.yaml").write_text("launch: [{push_ros_namespace: {namespace: a}}]\n")
    [remark] = load(lamps / "f.launch.yaml").remarks
    assert "a namespace holds for the actions that follow it; put it before them" in remark


def test_components_that_nobody_here_has_are_left_out_of_launch_files(lamps: Path) -> None:
    """The others start; where there is nothing else, that is why nothing starts."""
    absent = "{pkg: image_proc, plugin: 'image_proc::RectifyNode'}"
    text = f"launch: [{{node_container: {{name: c, composable_node: [{absent}]}}}}%s]\n"
    file = lamps / "f.launch.yaml"
    file.write_text(text % ", {node: {pkg: turtlesim, exec: turtlesim_node}}")
    found = load(file)
    assert [node.name for node in found.nodes] == ["/turtlesim"]
    assert "image_proc::RectifyNode is left out: no node here is the component" in found.remarks[0]
    file.write_text(text % "")
    with pytest.raises(GraphFileError, match="image_proc::RectifyNode is left out"):
        load(file)


def test_others_that_may_load_code() -> None:
    """Are let in by one line, which is remarked with its place."""
    text = "net: {allow_control: true}\nnodes:\n  /a: {class: nodes.talker:Talker}\n"
    (remark,) = plan(text).remarks
    assert remark.startswith("f.yaml:1:7: allow_control: whoever reaches this graph over the network can load code")
    assert plan(text.replace("true", "false")).remarks == ()
