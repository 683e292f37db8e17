"""A plan held against what its classes declare."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import Place, Problem
from graphflow.graph.checks.check import Interfaces, check, offered, remarks_on_programs, resolver, step_type
from graphflow.graph.plan import Plan
from graphflow.graph.resolve import resolve
from graphflow.interface import EndpointInfo, HandlerInfo, Interface, Parameter
from graphflow.markup import source

NOWHERE = Place("code.py", 1)


def endpoint(kind: Any, name: str, type_: str) -> EndpointInfo:
    return EndpointInfo(kind, name, type_, name, NOWHERE)


CHASER = Interface(
    "a.b:Chaser",
    "chaser",
    NOWHERE,
    endpoints=(
        endpoint("publisher", "cmd_vel", "geometry_msgs/msg/Twist"),
        endpoint("subscription", "goal", "turtlesim/msg/Pose"),
        endpoint("subscription", "/clock", "rosgraph_msgs/msg/Clock"),
        endpoint("service", "~/stop", "std_srvs/srv/Trigger"),
        endpoint("client", "spawn", "turtlesim/srv/Spawn"),
    ),
    params=(
        Parameter("gain", "float", 1.0, NOWHERE, gt=0.0, unit="1/s"),
        Parameter("count", "int", 1, NOWHERE, ge=0, le=255),
        Parameter("name", "str", "", NOWHERE),
        Parameter("turbo", "bool", False, NOWHERE),
        Parameter("limits.speed", "float", 1.0, NOWHERE),
        Parameter("points", "list[float]", [0.0], NOWHERE),
    ),
    handlers=(
        HandlerInfo("control", "timer", NOWHERE),
        HandlerInfo("load", "service", NOWHERE, is_async=False),
        HandlerInfo("watch", "task", NOWHERE),
    ),
)
SIM = Interface(
    "a.b:Sim",
    "sim",
    NOWHERE,
    endpoints=(endpoint("service", "spawn", "turtlesim/srv/Spawn"),),
    dynamic_names=("*/cmd_vel", "*/set_pen"),
)
ANY = Interface("a.b:Any", "any", NOWHERE, dynamic_names=True)
KNOWN: Interfaces = {i.class_path: i for i in (CHASER, SIM, ANY)}


def plan(text: str) -> Plan:
    return resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"), [], {})


def problems(text: str, interfaces: Interfaces = KNOWN) -> list[str]:
    found = plan(text)
    imported = {node.class_path: interfaces[node.class_path] for node in found.nodes}
    return [str(p).removeprefix("f.yaml:") for p in check(found, imported)]


def chaser(line: str) -> list[str]:
    """The problems of a chaser in namespace /t with one more line."""
    return problems(f"nodes:\n  /t/c:\n    class: a.b:Chaser\n    {line}\n")


@pytest.mark.parametrize(
    "line",
    [
        "params: {gain: 2.5, count: 0, name: x, turbo: true, points: [1, 2.5]}",
        "params: {gain: 2}",
        "params: {limits: {speed: 1.0}}",
        "remap: {goal: /turtle1/pose, cmd_vel: vel, /clock: /time, ~/stop: /halt, spawn: /sim/spawn}",
        "remap: {/t/goal: /turtle1/pose, /t/c/stop: /halt}",
        "concurrency: {motion: [control], none: [load]}",
        "concurrency: {motion: {handlers: [control, load], thread: true}}",
    ],
)
def test_what_fits_is_no_problem(line: str) -> None:
    """Declared names in every spelling, values of the declared type and range: nothing to say."""
    assert chaser(line) == []


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("params: {gian: 2.5}", "4:20: Chaser has no parameter 'gian'; did you mean 'gain'?"),
        ("params: {limits: {sped: 1.0}}", "4:29: Chaser has no parameter 'limits.sped'; did you mean 'limits.speed'?"),
        ("params: {gain: fast}", "4:20: parameter 'gain' is of type double, 'fast' is not"),
        ("params: {gain: 0}", "4:20: parameter 'gain' = 0.0 is out of range: more than 0 1/s"),
        ("params: {count: 256}", "4:21: parameter 'count' = 256 is out of range: 0 to 255"),
        (
            "params: {count: 1.5}",
            "4:21: parameter 'count' is of type integer, 1.5 is not; its default is 1, an integer: for a double, write "
            "1.0 in code.py:1",
        ),
        ("params: {count: true}", "4:21: parameter 'count' is of type integer, True is not"),
        (
            "params: {name: 3}",
            """4:20: parameter 'name' is of type string, 3 is not; write '3', with the quotes; in a shell "'3'\"""",
        ),
        (
            "params: {count: 0.5}",
            "4:21: parameter 'count' is of type integer, 0.5 is not; "
            "its default is 1, an integer: for a double, write 1.0 in code.py:1",
        ),
        (
            "params: {turbo: on}",
            "4:21: parameter 'turbo' is of type boolean, 'on' is not; write true: on is a text in YAML 1.2",
        ),
        ("remap: {gaol: /x}", "4:13: Chaser has no topic or service 'gaol'; did you mean 'goal'?"),
        ("remap: {from: goal, to: /x}", "4:13: a remap is written as a pair: remap: {goal: /x}"),
        ("remap: {/goal: /x}", "4:13: Chaser has no topic or service '/goal'; did you mean 'goal'?"),
        ("concurrency: {m: [contrl]}", "4:23: Chaser has no handler 'contrl'; did you mean 'control'?"),
        ("concurrency: {m: {limit: 2}}", "4:19: Chaser has no group 'm', and no handlers are listed"),
        ("concurrency: {m: [watch]}", "4:23: watch is a task, which runs alongside everything and is in no group"),
        (
            "concurrency: {m: {handlers: [control], thread: true}}",
            "4:19: thread: true is for `def` handlers, and control of 'm' run on the loop",
        ),
        (
            "concurrency: {m: {handlers: [control], limit: none, when_full: drop_old}}",
            "4:19: 'm' has no limit and is never full: when_full: drop_old would never act",
        ),
        ("remap: {~/goal: /x}", "4:13: Chaser has no topic or service '~/goal'; did you mean 'goal'?"),
    ],
)
def test_what_does_not_fit(line: str, problem: str) -> None:
    """Misspelt names and values that cannot be are told at their place, with the nearest name or what is allowed."""
    assert chaser(line) == [problem]


def test_topics_that_are_called_from_and_to() -> None:
    """A class may have them, and they are remapped like others."""
    ends = tuple(endpoint("subscription", name, "std_msgs/msg/String") for name in ("from", "to"))
    text = "nodes: {/c: {class: 'a.b:Chaser', remap: {from: goal, to: /x}}}\n"
    assert problems(text, {"a.b:Chaser": replace(CHASER, endpoints=ends)}) == []


def test_parameters_whose_names_are_made() -> None:
    """They are left to the node, as others are not, however they are set."""
    made = {"a.b:Chaser": replace(CHASER, made_params=("*.radius",))}
    text = "nodes:\n  /c: {class: 'a.b:Chaser', params: {left: {radius: 1.0, width: 1.0}}}\n"
    told = "2:65: Chaser has no parameter 'left.width'"
    assert [problem.split(";")[0] for problem in problems(text, made)] == [told]
    text = "group: {params: {left: {radius: 1.0, width: 1.0}}, nodes: {/c: {class: 'a.b:Chaser'}}}\n"
    told = "1:45: no node of this graph has a parameter 'left.width'"
    assert [problem.split(";")[0] for problem in problems(text, made)] == [told]


def test_what_a_method_makes_instead() -> None:
    """A node may replace what its class declares; others need one of the two types."""
    twist, stamped = (f"geometry_msgs/msg/{name}" for name in ("Twist", "TwistStamped"))
    made = replace(endpoint("publisher", "cmd_vel", stamped), is_made=True)
    teleop = Interface("a.b:Teleop", "teleop", NOWHERE, endpoints=(endpoint("publisher", "cmd_vel", twist), made))
    known: dict[str, Interface | Problem] = {"a.b:Teleop": teleop}
    for type_, clashes in ((twist, False), (stamped, False), ("std_msgs/msg/String", True)):
        known["a.b:Base"] = Interface("a.b:Base", "b", NOWHERE, "", (endpoint("subscription", "cmd_vel", type_),))
        found = problems("nodes: {/t: {class: 'a.b:Teleop'}, /b: {class: 'a.b:Base'}}\n", known)
        told = f"1:48: topic /cmd_vel is of type {twist} for /t, but {type_} for /b"
        assert found == ([told] if clashes else [])


def test_keys_of_a_node_below_params() -> None:
    """Each is reported once, however many entries it has."""
    hint = "remap is a key of the node: indent it as params: is"
    assert chaser("params: {gain: 1.0, remap: {goal: /a, cmd_vel: /b}}") == [
        f"4:39: Chaser has no parameter 'remap.goal'; {hint}"
    ]


@pytest.mark.parametrize(
    ("program", "reason"),
    [
        ("scripts/rec.py", "it is not executable; make it so with: chmod +x {}, or write command: [python3, {}]"),
        ("scripts/run", "it is not executable; make it so with: chmod +x {}"),
        ("scripts", "it is a folder"),
        ("scripts/none", "there is no such file"),
        ("~/none", "there is no such file; ~ is not expanded: write $(env HOME)/none"),
    ],
)
def test_a_file_that_cannot_be_run(program: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The reason is given, and the remedy."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scripts").mkdir()
    for name in ("rec.py", "run"):
        (tmp_path / "scripts" / name).write_text("print(1)\n")
    program = f"./{program}" if program == "scripts" else program
    [told] = check(plan(f"nodes: {{r: {{command: [{program}]}}}}"), {})
    assert str(told).endswith(f"the program {program!r} cannot be started: {reason.replace('{}', program)}")


def test_every_problem_is_told_in_order() -> None:
    """Nodes and steps are all looked at, whatever is wrong with the others."""
    text = """\
nodes:
  c: {class: a.b:Chaser, params: {gian: 1, gain: x}, remap: {gaol: /x}}
  d: {class: a.b:Chaser, params: {count: -1}}
steps:
  s: {call: /c/stopp}
"""
    assert [p.partition(": ")[0] for p in problems(text)] == ["2:41", "2:50", "2:62", "3:42", "5:13"]


def test_names_made_at_run_time_are_taken_on_trust() -> None:
    """A class that makes names while it runs says which, or that they may be any."""
    text = "nodes:\n  s: {{class: {}, remap: {{{}: /x}}}}\n"
    assert problems(text.format("a.b:Sim", "turtle9/cmd_vel")) == []
    assert problems(text.format("a.b:Sim", "turtle9/pose")) == [
        "2:31: Sim has no topic or service 'turtle9/pose'; there is spawn"
    ]
    assert problems(text.format("a.b:Any", "anything")) == []
    assert problems("nodes: {s: {class: a.b:Any, params: {anything: 1}}}") == []


@pytest.mark.parametrize(
    ("message", "shown"),
    [
        (
            "module a.b has no class 'Chasr'; did you mean 'Chaser'?",
            "module a.b has no class 'Chasr'; did you mean 'Chaser'?",
        ),
        (
            "the process that imported it was ended by exit code 3",
            "a.b:Chasr: the process that imported it was ended by exit code 3",
        ),
        ("cannot import a.b: b.py:3: ValueError: two\n  lines", "cannot import a.b: b.py:3: ValueError: two lines"),
    ],
)
def test_a_class_that_cannot_be_imported(message: str, shown: str) -> None:
    """The reason stands at the class's place, in one line, and says which class it is about."""
    faults = {**KNOWN, "a.b:Chasr": Problem(Place(""), message)}
    assert problems("nodes:\n  c: {class: a.b:Chasr, params: {x: 1}, remap: {y: z}}\n", faults) == [f"2:14: {shown}"]


def test_the_place_of_a_fault_is_shown() -> None:
    """A reason that has a place of its own tells it."""
    faults = {"a.b:C": Problem(Place("b.py", 7), "a.b is broken")}
    assert problems("nodes: {c: {class: a.b:C}}", faults) == ["1:20: a.b is broken (b.py:7)"]


STEP = """\
nodes:
  /sim: {{class: a.b:Sim, remap: {{spawn: /hatch}}}}
  /c: {{class: a.b:Chaser}}
steps:
  s: {}
"""


@pytest.mark.parametrize(
    "step",
    [
        "{call: /hatch, request: {x: 1.0, y: 2, name: a}}",
        "{call: hatch}",
        "{call: /c/stop}",
        "{call: /c/stop, type: std_srvs/Trigger}",
        "{call: /turtle1/set_pen, request: {anything: 1}}",
        "{call: /else/where, type: std_srvs/srv/Trigger}",
        "{call: /else/where, type: std_srvs/Trigger}",
        "{call: /c/list_parameters}",
        "{call: /c/get_type_description, request: {type_name: std_msgs/msg/String}}",
    ],
)
def test_steps_that_can_be(step: str) -> None:
    """A step may call what the classes declare, under its remapped name, what they may make, or a type it names."""
    assert problems(STEP.format(step)) == []


@pytest.mark.parametrize(
    ("step", "found"),
    [
        (
            "{call: /htch}",
            [
                "5:13: no node of this graph offers the service /htch; did you mean '/hatch'?"
                " (for one outside the graph add type: package/srv/Name)"
            ],
        ),
        (
            "{call: /spawn}",
            [
                "5:13: no node of this graph offers the service /spawn; there is /c/stop, /hatch"
                " (for one outside the graph add type: package/srv/Name)"
            ],
        ),
        (
            "{call: /c/list_parameter}",
            [
                "5:13: no node of this graph offers the service /c/list_parameter; did you mean '/c/list_parameters'?"
                " (for one outside the graph add type: package/srv/Name)"
            ],
        ),
        (
            "{call: /c/list_parameters, request: {dept: 1}}",
            ["5:43: rcl_interfaces/srv/ListParameters_Request has no field 'dept'; did you mean 'depth'?"],
        ),
        (
            "{goal: /hatch}",
            ["5:13: no node of this graph offers the action /hatch; it is a service: call: /hatch"],
        ),
        ("{call: /goal}", ["5:13: no node of this graph offers the service /goal; it is a topic"]),
        ("{call: /sim}", ["5:13: no node of this graph offers the service /sim; it is a node"]),
        (
            "{call: /hatch, type: turtlesim/Kill}",
            ["5:13: /hatch is of type turtlesim/srv/Spawn, not turtlesim/Kill; leave out type:"],
        ),
        (
            "{call: /x, type: turtlesim/srv/Spwan}",
            ["5:13: package 'turtlesim' has no interface 'Spwan'; did you mean 'Spawn'?"],
        ),
        (
            "{call: /hatch, request: {theeta: 1.0}}",
            ["5:31: turtlesim/srv/Spawn_Request has no field 'theeta'; did you mean 'theta'?"],
        ),
        (
            "\n    call: /hatch\n    request:\n      x: 1.0\n      y: far\n      z: 1\n      name: 7\n",
            [
                "9:7: Spawn_Request.y: expected float32, got 'far'",
                "10:7: turtlesim/srv/Spawn_Request has no field 'z'; there is name, theta, x, y",
                "11:7: Spawn_Request.name: expected string, got 7; write '7'",
            ],
        ),
    ],
)
def test_steps_that_cannot_be(step: str, found: list[str]) -> None:
    """An unknown service, an unknown type, and every wrong field of a request, each at its own place."""
    assert problems(STEP.format(step)) == found


def test_services_of_lifecycle_nodes() -> None:
    """Are offered by these only."""
    text = "nodes:\n  s: {class: a.b:Sim}\nsteps:\n  a: {call: /s/change_state, request: {transition: {id: 1}}}\n"
    assert problems(text, {"a.b:Sim": replace(SIM, is_managed=True)}) == []
    assert problems(text, {"a.b:Sim": SIM})[0].startswith("4:13: no node of this graph offers the service /s/change_st")


def test_a_service_may_be_of_a_class_that_is_not_known() -> None:
    """While a class cannot be imported, or makes names of any kind, no service is called unknown."""
    text = "nodes:\n  a: {class: a.b:Any}\nsteps:\n  s: {call: /somewhere}\n"
    assert problems(text) == []
    fault = Problem(Place(""), "cannot import a.b: there is no module 'a'")
    assert len(problems(text, {"a.b:Any": fault})) == 1


def test_a_module_that_cannot_be_imported_is_told_once() -> None:
    """However many nodes are of its classes; another fault is told beside it."""
    text = "nodes:\n  a: {class: a.b:Any}\n  b: {class: a.b:Any}\n  c: {class: c.d:Any}\n"
    one, other = (Problem(Place(""), f"cannot import {name}: there is no module") for name in ("a.b", "c.d"))
    assert [found[:4] for found in problems(text, {"a.b:Any": one, "c.d:Any": other})] == ["2:14", "4:14"]


def test_services_go_by_their_remapped_names() -> None:
    """A type is found under the name that the service will have."""
    found = plan(STEP.format("{call: /hatch}"))
    assert offered(found, KNOWN, "service") == {"/hatch": "turtlesim/srv/Spawn", "/c/stop": "std_srvs/srv/Trigger"}
    assert step_type(found.steps[0], found, KNOWN) == "turtlesim/srv/Spawn"
    assert resolver(found.nodes[0]).resolve("spawn", "service") == "/hatch"


def test_the_types_word_comes_first() -> None:
    """A type given in the file is taken, whatever the classes declare."""
    found = plan(STEP.format("{call: /hatch, type: std_srvs/srv/Empty}"))
    assert step_type(found.steps[0], found, KNOWN) == "std_srvs/srv/Empty"


@pytest.mark.parametrize(
    ("remap", "place", "problem"),
    [
        (
            "goal: cmd_vel",
            "4:13",
            "topic /cmd_vel is of type geometry_msgs/msg/Twist for /b, but turtlesim/msg/Pose for /b",
        ),
        ("goal: /c", "4:13", "topic /c is of type std_msgs/msg/String for /a, but turtlesim/msg/Pose for /b"),
        ("spawn: /s", "4:13", "service /s is of type std_srvs/srv/Empty for /a, but turtlesim/srv/Spawn for /b"),
    ],
)
def test_one_name_with_two_types(remap: str, place: str, problem: str) -> None:
    """The course's follower with a Point for a goal: the rule that joins the two is named."""
    other = Interface(
        "a.b:Other",
        "other",
        NOWHERE,
        endpoints=(endpoint("publisher", "c", "std_msgs/msg/String"), endpoint("service", "s", "std_srvs/srv/Empty")),
    )
    text = f"nodes:\n  a: {{class: a.b:Other}}\n  b: {{class: a.b:Chaser,\n    remap: {{{remap}}}}}\n"
    assert problems(text, {**KNOWN, "a.b:Other": other}) == [f"{place}: {problem}"]


def test_types_that_the_source_does_not_show() -> None:
    """Are neither right nor wrong, for topics as for the services that steps call."""
    vague = Interface(
        "a.b:Vague", "vague", NOWHERE, endpoints=(endpoint("publisher", "pose", ""), endpoint("service", "reset", ""))
    )
    clear = Interface(
        "a.b:Clear", "clear", NOWHERE, endpoints=(endpoint("subscription", "pose", "std_msgs/msg/String"),)
    )
    text = "nodes:\n  /v: {class: a.b:Vague}\n  /c: {class: a.b:Clear}\nsteps:\n  go: {call: /reset}\n"
    assert problems(text, {i.class_path: i for i in (vague, clear)}) == []


@pytest.mark.parametrize(
    ("program", "end"),
    [
        ("sh -c 'sleep 1'", "each word is an item of its own: command: [sh, -c, sleep 1]"),
        ("sh 'a: b", "each word is an item of its own: command: [sh, '''a:', b]"),
        ("no_such_program -a", "it is not on the PATH"),
    ],
)
def test_a_program_is_one_word(program: str, end: str) -> None:
    """A command line in one text is told with its words."""
    (found,) = check(plan(f'nodes:\n  /p: {{command: ["{program}"]}}\n'), {})
    assert found.message.endswith(f" cannot be started: {end}")


@pytest.mark.parametrize(
    ("words", "problem", "remark"),
    [
        ('[cd, /tmp, "&&", ls]', "a shell's own: write command: [sh, -c, cd /tmp && ls]", ""),
        ('[cat, a, "|", wc]', "", "write command: [sh, -c, cat a | wc]"),
        ('[sh, -c, "ls | wc"]', "", ""),
        ('[expr, 1, ">", 2]', "", ""),
    ],
)
def test_words_of_a_shell(words: str, problem: str, remark: str) -> None:
    """A program that only a shell has is a problem; other words of it may be meant so."""
    planned = plan(f"nodes:\n  /p: {{command: {words}}}\n")
    for found, said in ((check(planned, {}), problem), (list(remarks_on_programs(planned)), remark)):
        assert [said] * bool(said) == [text.message[-len(said) :] for text in found]
