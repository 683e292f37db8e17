"""What is wrong in a graph file by its model, in words."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError, Place
from graphflow.graph.checks.foreign_keys import _IN_A_NAMESPACE
from graphflow.graph.checks.validation import Problems, example, unknown_key, validated
from graphflow.graph.model import GraphFile, StepSpec, keys_of
from graphflow.graph.resolve import resolve
from graphflow.markup import source

HERE, THERE = Place("f.yaml", 1, 1), Place("f.yaml", 2, 1)


def faults(text: str) -> list[str]:
    """What the model has against a file, as `line:column: message`; nothing else is looked at."""
    problems = Problems()
    model = validated(GraphFile, source.read(text, "f.yaml"), problems)
    assert (model is None) is bool(problems)
    return [str(p).removeprefix("f.yaml:") for p in problems]


def test_a_right_file_is_its_model() -> None:
    """It has no problems, and its values are there."""
    problems = Problems()
    model = validated(GraphFile, source.read("nodes:\n  a: {class: x:Y}\ndomain: 3\n", "f.yaml"), problems)

    assert model is not None
    assert (list(model.nodes), model.domain, problems) == (["a"], 3, [])
    problems.raise_any()


NODE = "nodes:\n  a: {class: x:Y, concurrency: "


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (f"{NODE}[m]}}", "2:32: concurrency: expected a mapping, got ['m'], for example concurrency: {mot"),
        (f"{NODE}{{m: 3}}}}", "2:36: concurrency.m: expected a mapping; write m: {limit: 3}"),
        (f"{NODE}{{m: {{handler: [t]}}}}}}", "2:37: unknown key 'handler'; did you mean 'handlers'?"),
        (f"{NODE}{{m: {{handlers: [t], limit: 0}}}}}}", "2:59: limit: expected 1 or more, or none for no limit, got 0"),
        ("nodes:\n  a: {class: x:Y, env: {B: []}}", "2:28: env.B: expected text or a number, got []"),
        (
            "nodes:\n  a: {class: x:Y, after: [3]}",
            "2:26: after: expected a name, a list of names, or NAME: ready|",
        ),
        ("nodes:\n  a: {command: []}", "2:16: command: is empty; write the program and its words: command: [rviz2"),
        ("nodes:\n  a: {pkg: p, exec: ''}", "2:6: an executable has both: pkg: PACKAGE and exec: NAME"),
        ("nodes:\n  a: {class: x:Y}\ncall_timeout: -1", "3:15: call_timeout: expected seconds, or never, got -1"),
        (
            "nodes:\n  a: {class: x:Y}\ncall_timeout: 5s",
            "3:15: call_timeout: expected seconds, or never, got '5s'; write call_timeout: 5",
        ),
        ("steps: {s: {delay: 500ms}}", "1:20: delay: expected a number of seconds; write delay: 0.5"),
        ("steps: {s: {call: /x, timeout: 2min}}", "1:32: timeout: expected a number of seconds; write timeout: 120"),
        ("steps: {s: {delay: soon}}", "1:20: delay: expected a number, got 'soon'"),
    ],
)
def test_one_mistake_is_told_once(text: str, said: str) -> None:
    """Of the alternatives that a value may be, the one is meant that fits furthest."""
    (found,) = faults(text)
    assert found.startswith(said)


def test_a_key_with_a_typo_is_not_missing_too() -> None:
    """`clas` is unknown, and `class` was meant by it; a key that is nowhere is missing."""
    assert faults("nodes:\n  a: {clas: x:Y}\n  b: {}") == [
        "2:7: unknown key 'clas'; did you mean 'class'?",
        "3:3: the key 'class' is missing; a program has pkg: and exec:, or command:",
    ]


@pytest.mark.parametrize(
    ("node", "said"),
    [
        (
            "{package: p, executable: e}",
            ["unknown key 'package'; it is called 'pkg' here", "unknown key 'executable'; it is called 'exec' here"],
        ),
        (
            "{class: x:Y, executable: e, parameters: {}}",
            [
                "unknown key 'executable'; it is called 'exec' here",
                "unknown key 'parameters'; it is called 'params' here",
            ],
        ),
        ("{pkg: p, exec: e, output: screen}", ["unknown key 'output'; what any node prints is logged and shown"]),
        ("{pkg: p, exec: e, name: n}", ["unknown key 'name'; a node is called as its key"]),
        (
            "{class: x:Y, ns: /a}",
            [f"unknown key 'ns'; {_IN_A_NAMESPACE}"],
        ),
        ("{class: x:Y, respawn: true}", ["unknown key 'respawn'; write restart: always"]),
        ("{pkg: p}", ["an executable has both: pkg: PACKAGE and exec: NAME; or exec: is a file"]),
        ("{pkg: p, exec: e, class: x:Y}", ["write class:, or pkg: and exec:, not both"]),
        (
            "{pkg: p, exec: e, command: [ls]}",
            ["pkg: is for nodes, and this is a program; write pkg: and exec:, or command:, not both"],
        ),
        ("{pkg: p, exec: e, process: x}", ["process: is for nodes, and this is a program; remove it"]),
        (
            "{class: x:Y, args: [a]}",
            ["args: is for programs, and this is the class x:Y, which takes params: and remap:; remove it"],
        ),
        (
            "{class: x:Y, delay: 2.0}",
            ["unknown key 'delay'; a step waits: steps: {soon: {delay: 2.0}}, and after: soon at the node"],
        ),
        (
            "{class: x:Y, remap: {a, /b}}",
            [
                "remap.a: expected text, got nothing, for example remap: {goal: /turtle1/pose}",
                "remap./b: expected text, got nothing, for example remap: {goal: /turtle1/pose}",
            ],
        ),
        ("class:x:Y", ["a: write a space after 'class:'"]),
    ],
)
def test_words_of_ros_launch_files(node: str, said: list[str]) -> None:
    """What a node is given there is told by the word for it here, and what goes with what."""
    found = {fault.partition(": ")[2] for fault in faults(f"nodes:\n  a: {node}")}
    assert found >= set(said)
    assert not any("missing" in fault for fault in found)


@pytest.mark.parametrize("name", ["/talker", "talker"])
def test_nodes_that_are_not_below_nodes(name: str) -> None:
    """A key that is a node by its name or by what is written under it."""
    text = f"unknown key {name!r}; nodes are written under nodes:, indented"
    assert faults(f"{name}: {{class: a:B}}\n") == [f"1:1: {text}"]
    with pytest.raises(GraphFileError, match=text):
        resolve(source.read(f"{name}: {{class: a:B}}\n", "f.yaml"), Path("/nowhere/f.yaml"), [], {})


@pytest.mark.parametrize(
    ("message", "end"),
    [
        ("'“a:B”' is not a class", " (“ and ” are not quotes in YAML, which has ' and \")"),
        ("'/\u2018lab\u2019' is not a namespace", " (\u2018 and \u2019 are not quotes in YAML, which has ' and \")"),
        (
            f"{'/ class'!r} is not a node name".replace(" class", "\\xa0class"),
            " (\\xa0 is a no-break space, which YAML does not count as a space)",
        ),
        ("'say “hi” to all' is not a class", ""),
    ],
)
def test_characters_of_slides(message: str, end: str) -> None:
    """Quotes and spaces that YAML does not know are named where they are in the way."""
    problems = Problems()
    problems.add(HERE, message)
    assert [p.message for p in problems] == [f"{message}{end}"]


def test_a_place_that_is_known_to_be_wrong_is_complained_of_once() -> None:
    """More would only confuse; other places are not affected."""
    problems = Problems()
    problems.add(HERE, "odd")
    problems.add_unknown(HERE, "worse")
    problems.add(HERE, "and therefore")
    problems.add(THERE, "odd")

    assert [(p.place, p.message) for p in problems] == [(HERE, "odd"), (HERE, "worse"), (THERE, "odd")]
    with pytest.raises(GraphFileError) as caught:
        problems.raise_any()
    assert caught.value.problems == tuple(sorted(problems))


def test_examples_fit_where_they_are_given() -> None:
    """Whatever the node or group is called; where there is none, nothing is said."""
    assert example("nodes", "anything", "after") == ", for example after: /talker"
    assert example("nodes", "a", "concurrency", "motion").startswith(", for example motion: [control], or ")
    assert example("nodes", "a", "class") == ""


BELONGS = "{} belongs to a node; indent it below the node's name, beside class:{}"
SEVERAL = ", or for several nodes into a group: with its nodes:"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nodes:\n  /a: {class: x:Y}\n  /params: {rate: 2.0}\n", [f"3:3: {BELONGS.format('params:', SEVERAL)}"]),
        ("nodes:\n  /a: {class: x:Y}\n  /process: main\n", [f"3:3: {BELONGS.format('process:', '')}"]),
        ("nodes:\n  /a: {class: x:Y}\nparams: {rate: 2.0}\n", [f"3:1: {BELONGS.format('params:', SEVERAL)}"]),
        ("nodes:\n  /a: {class: x:Y}\nremap: {a: b}\n", [f"3:1: {BELONGS.format('remap:', SEVERAL)}"]),
        (
            "nodes:\n  /a: {class: x:Y, rate: 2.0}\n",
            ["2:20: unknown key 'rate'; a parameter is written under params:, as in params: {rate: 2.0}"],
        ),
        ("nodes:\n  /a: {class: x:Y, critcal: true}\n", ["2:20: unknown key 'critcal'; did you mean 'critical'?"]),
        (
            "nodes:\n  /a: {class: x:Y}\nparams_fil: p.yaml\n",
            [f"3:1: unknown key 'params_fil'; did you mean 'params_file'? {BELONGS.format('It', SEVERAL)}"],
        ),
        ("nodes:\n  /params: {class: x:Y}\n", []),
    ],
)
def test_keys_of_nodes_at_a_wrong_place(text: str, said: list[str]) -> None:
    """Are told where they belong, and nothing else is said of them."""
    assert faults(text) == said


@pytest.mark.parametrize("key", ["args", "data", "values"])
def test_values_of_a_step(key: str) -> None:
    """Are under `request:`, of a call and of a goal."""
    expected = f"unknown key {key!r}; the values of a call or a goal are written under request:"
    assert unknown_key(key, keys_of(StepSpec), {"x": 1}) == expected


def test_a_file_of_parameters() -> None:
    """It is told as one."""
    [fault] = faults("talker:\n  ros__parameters: {rate: 2.0}\n")
    assert fault.startswith("1:1: unknown key 'talker'; this is a file of parameters: ")


def test_another_word_for_a_needed_key() -> None:
    """It is told once."""
    [fault] = faults("nodes:\n  /a: {plugin: b}\n")
    assert fault == "2:8: unknown key 'plugin'; it is called 'class' here"


def test_all_keys_are_listed() -> None:
    """Where none is near, and none is known from elsewhere."""
    text = unknown_key("zzz", keys_of(StepSpec))
    assert text == f"unknown key 'zzz'; there is {', '.join(sorted(keys_of(StepSpec)))}"
