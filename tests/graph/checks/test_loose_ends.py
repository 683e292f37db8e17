"""Names of a plan that nothing in the graph answers to."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import Place, Problem
from graphflow.graph.checks.check import Interfaces
from graphflow.graph.checks.loose_ends import loose_ends
from graphflow.graph.resolve import resolve
from graphflow.interface import EndpointInfo, Interface
from graphflow.markup import source

CODE = Place("code.py", 1)
STRING, TRIGGER = "std_msgs/msg/String", "std_srvs/srv/Trigger"


def endpoint(kind: Any, name: str, type_: str) -> EndpointInfo:
    return EndpointInfo(kind, name, type_, name, CODE)


TALKER = Interface(
    "a:Talker",
    "talker",
    CODE,
    endpoints=(endpoint("publisher", "chatter", STRING), endpoint("service", "spawn", TRIGGER)),
)
LISTENER = Interface(
    "a:Listener",
    "listener",
    CODE,
    endpoints=(endpoint("subscription", "chatter", STRING), endpoint("client", "spawn", TRIGGER)),
)
SLIPPED = Interface("a:Slipped", "slipped", CODE, endpoints=(endpoint("subscription", "chater", STRING),))
ADDER = Interface(
    "a:Adder",
    "adder",
    CODE,
    endpoints=(endpoint("publisher", "output", STRING), endpoint("subscription", "input", STRING)),
)
NUMBERED = Interface("a:Numbered", "numbered", CODE, endpoints=(endpoint("subscription", "chatter2", STRING),))
COUNTED = Interface(
    "a:Counted", "counted", CODE, endpoints=(endpoint("subscription", "chatter", "std_msgs/msg/Int32"),)
)
ANY = Interface("a:Any", "any", CODE, dynamic_names=("/chater",))
KNOWN: Interfaces = {i.class_path: i for i in (TALKER, LISTENER, SLIPPED, NUMBERED, ANY, ADDER, COUNTED)}
GRAPH = "nodes:\n  /t: {class: a:Talker}\n  /l: {class: a:Listener}\n"


def told(text: str, known: Interfaces = KNOWN) -> list[str]:
    plan = resolve(source.read(text, "g.yaml"), Path("/nowhere/g.yaml"), [], {})
    here = {path: known[path] for path in plan.classes()}
    return [str(problem) for problem in sorted(loose_ends(plan, here))]


def test_a_graph_without_loose_ends() -> None:
    """Every name has both ends, or an end that needs no other."""
    assert told(GRAPH) == []
    assert told("nodes: {/t: {class: a:Talker}}") == []
    assert told("nodes: {/l: {class: a:Listener}}") == [], "its publisher may be outside the graph"


@pytest.mark.parametrize(
    ("rule", "expected"),
    [
        ("chatter: /chater", "no node of this graph publishes /chater; did you mean '/chatter'?"),
        ("chatter: /elsewhere", "no node of this graph publishes /elsewhere"),
        ("spawn: /spwan", "no node of this graph offers the service /spwan; did you mean '/spawn'?"),
        ("chatter: /chatter2", "no node of this graph publishes /chatter2"),
    ],
)
def test_a_remap_to_a_name_that_nobody_has(rule: str, expected: str) -> None:
    """At the rule; the nearest name is offered unless only a number tells the two apart."""
    text = GRAPH.replace("a:Listener", f"a:Listener, remap: {{{rule}}}")
    assert told(text) == [f"g.yaml:3:{text.splitlines()[2].index(rule) + 1}: {expected}"]


@pytest.mark.parametrize(
    ("talker", "listener", "expected"),
    [
        ("/left/t: {class: a:Talker}", "/right/l: {class: a:Listener}", "3:3"),
        ("/t: {class: a:Talker, remap: {chatter: /talk}}", "/l: {class: a:Listener}", "2:33"),
    ],
)
def test_two_that_do_not_meet(talker: str, listener: str, expected: str) -> None:
    """They would, but for their namespaces or a remap."""
    [text] = [text for text in told(f"nodes:\n  {talker}\n  {listener}\n") if "chatter" in text]
    assert text.startswith(f"g.yaml:{expected}: /")
    sent, heard = ("/left/chatter", "/right/chatter") if "left" in talker else ("/talk", "/chatter")
    who = " and ".join(text.split("; ")[0].split(": ")[1].split(", and "))
    names = talker.split(":")[0], listener.split(":")[0]
    assert who == f"{names[0]} publishes {sent} and {names[1]} subscribes to {heard}"
    way = "put both in one namespace, or remap one" if "left" in talker else "remap both, or neither"
    assert text.endswith(f"; for them to meet, {way}")


@pytest.mark.parametrize(
    "nodes",
    [
        ("/left/t: {class: a:Talker}", "/right/t: {class: a:Talker}", "/right/l: {class: a:Listener}"),
        ("/left/t: {class: a:Talker}", "/left/l: {class: a:Listener}", "/right/l: {class: a:Listener}"),
        ("/left/t: {class: a:Talker}", "/right/a: {class: a:Adder}"),
        ("/left/t: {class: a:Talker}", "/right/c: {class: a:Counted}"),
    ],
)
def test_others_that_meet(nodes: tuple[str, ...]) -> None:
    """One of the two has its other end, or they have nothing in common."""
    assert not any("for them to meet" in text for text in told("nodes:\n" + "".join(f"  {n}\n" for n in nodes)))


def test_names_that_a_node_creates_for_sure() -> None:
    """A pattern with no other `*` than the namespace's is such a name, and one like it is a slip."""
    patterns = ("*/turtle1/cmd_vel", "*/?*/cmd_vel")
    sim = Interface("a:Sim", "sim", CODE, dynamic_names=patterns)
    text = "nodes:\n  /s: {class: a:Sim}\n  /t: {class: a:Talker, remap: {chatter: NAME}}\n"
    assert told(text.replace("NAME", "/turtel1/cmd_vel"), {**KNOWN, "a:Sim": sim}) == [
        "g.yaml:3:33: no node of this graph subscribes to /turtel1/cmd_vel; did you mean '/turtle1/cmd_vel'?"
    ]
    for name in ("/turtle1/cmd_vel", "/turtle2/cmd_vel", "/leo/cmd_vel", "/elsewhere"):
        assert told(text.replace("NAME", name), {**KNOWN, "a:Sim": sim}) == []


@pytest.mark.parametrize(
    ("name", "near"), [("/left/turtle1/cmd_vel", ""), ("/turtle1/cmd_vel", "/left/turtle1/cmd_vel"), ("/moved", "")]
)
def test_names_that_a_node_creates_in_its_namespace(name: str, near: str) -> None:
    """The `*` stands for the namespace of each node; remaps count, and services are none of these topics."""
    sim = Interface("a:Sim", "sim", CODE, dynamic_names=("*/turtle1/cmd_vel", "*/turtle1/moved", "*/?*/cmd_vel"))
    text = "nodes:\n  /left/s: {class: a:Sim, remap: {turtle1/moved: /moved}}\n"
    text += f"  /t: {{class: a:Talker, remap: {{chatter: {name}}}}}\n  /left/turtle1/a: {{class: a:Adder}}\n"
    found = [line for line in told(text, {**KNOWN, "a:Sim": sim}) if "3:33" in line or "calls" in line]
    told_of = f"g.yaml:3:33: no node of this graph subscribes to {name}; did you mean {near!r}?"
    assert found == ([told_of] if near else [])


def test_a_remap_that_joins_a_node_with_itself() -> None:
    """It is told with the two sides exchanged; other names are left alone."""
    text = "nodes:\n  /a: {class: a:Adder, remap: {/output: input}}\n"
    way = "a remap has the node's name first: did you mean input: /output?"
    assert told(text) == [f"g.yaml:2:32: by this remap /a hears its own messages on /input; {way}"]
    for rule in ("input: /output2, output: /output3", "output: /elsewhere", "output: /input2"):
        assert "hears its own" not in "".join(told(text.replace("/output: input", rule)))


def test_a_publisher_may_have_no_listener_but_not_a_misspelt_one() -> None:
    """It is told where a subscription is spelt almost so; what nobody is near to may be meant for others."""
    text = GRAPH.replace("a:Talker", "a:Talker, remap: {chatter: /NAME}")
    assert told(text.replace("NAME", "elsewhere").replace("a:Listener", "a:Numbered")) == []
    assert told(text.replace("NAME", "chater")) == [
        "g.yaml:2:33: no node of this graph subscribes to /chater; did you mean '/chatter'?"
    ]


@pytest.mark.parametrize(
    ("nodes", "type_", "who"),
    [
        (["/a/d", "/b/d"], "Twist", "/a/d and /b/d"),
        (["/a/d", "/b/d", "/c/d", "/d/d", "/e/d"], "TwistStamped", "/a/d, /b/d, /c/d, /d/d and others"),
        (["/a/d", "/a/e"], "Twist", ""),
        (["/a/d", "/b/d"], "Point", ""),
        (["/a/d", "/b/d: {remap: {/cmd_vel: cmd_vel}}"], "Twist", ""),
    ],
)
def test_commands_of_several_robots(nodes: list[str], type_: str, who: str) -> None:
    """An absolute name gives all of them one topic; other topics may well be shared."""
    commands = endpoint("publisher", "/cmd_vel", f"geometry_msgs/msg/{type_}")
    driver = Interface("a:Driver", "driver", CODE, endpoints=(commands, endpoint("publisher", "/map", STRING)))
    text = "nodes:\n"
    for node in nodes:
        name, _, more = node.partition(": ")
        text += f"  {name}: {{class: a:Driver{', ' + more[1:-1] if more else ''}}}\n"
    way = "write 'cmd_vel' without /, so that each namespace has its own"
    expected = f"code.py:1: {who} publish /cmd_vel, and the robot obeys the latest: {way}"
    assert told(text, {"a:Driver": driver}) == ([expected] if who else [])
    heard = endpoint("subscription", "/cmd_vel", f"geometry_msgs/msg/{type_}")
    base = Interface("a:Driver", "driver", CODE, endpoints=(heard,))
    expected = f"code.py:1: {who} subscribe to /cmd_vel, and all obey each command: {way}"
    assert [line for line in told(text, {"a:Driver": base}) if "obey" in line] == ([expected] if who else [])


def test_a_slash_that_keeps_the_namespace_out() -> None:
    """The line of the class is told once for all its nodes, and only where the name within the namespace exists."""
    robot = Interface("a:Robot", "robot", CODE, endpoints=(endpoint("subscription", "/cmd", STRING),))
    pilot = Interface("a:Pilot", "pilot", CODE, endpoints=(endpoint("publisher", "cmd", STRING),))
    text = "nodes:\n" + "".join(
        f"  /{space}/{name}: {{class: a:{name.title()}}}\n" for space in "ab" for name in ("robot", "pilot")
    )
    known = {"a:Robot": robot, "a:Pilot": pilot}
    expected = "code.py:1: no node of this graph publishes /cmd; write 'cmd': a slash in front keeps the namespace out"
    assert told(text, known) == [expected]
    assert told(text.replace("a:Pilot}", "a:Pilot, remap: {cmd: /cmd}}"), known) == []


def test_a_slip_in_a_class() -> None:
    """At the declaration, though no rule was written; names that differ in a number are two names."""
    text = "nodes:\n  /t: {class: a:Talker}\n  /s: {class: a:Slipped}\n"
    assert told(text) == ["code.py:1: no node of this graph publishes /chater; did you mean '/chatter'?"]
    assert told(text.replace("Slipped", "Numbered")) == []


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        ("{call: /spwan, type: std_srvs/srv/Trigger}", "no node of this graph offers the service /spwan; did you mean"),
        ("{call: /outside, type: std_srvs/srv/Trigger}", ""),
        ("{call: /t/get_parameters, type: rcl_interfaces/srv/GetParameters}", ""),
        ("{wait: /chater}", "nothing in this graph is called /chater; did you mean '/chatter'?"),
        ("{wait: /camera}", "nothing in this graph is called /camera"),
        ("{wait: /t}", ""),
    ],
)
def test_steps(step: str, expected: str) -> None:
    """One that gives the type may call outside the graph, unless a service of it is spelt almost so."""
    found = told(f"{GRAPH}steps:\n  s: {step}\n")
    assert len(found) == bool(expected)
    assert expected in "".join(found)


def test_nothing_is_said_of_what_cannot_be_known() -> None:
    """Programs, classes that cannot be imported, and names that a class may make at run time."""
    text = GRAPH.replace("a:Listener", "a:Listener, remap: {chatter: /chater}")
    assert told(text) != []
    assert told(f"{text}  /p: {{command: [sleep, '1']}}\n") == []
    assert told(f"{text}  /a: {{class: a:Any}}\n") == []
    assert told(text, {**KNOWN, "a:Talker": Problem(CODE, "broken")}) == []


def test_a_class_that_the_project_of_an_included_file_has_too(tmp_path: Path) -> None:
    """One module of a name is imported: that of the including project."""
    for project in ("ours", "theirs"):
        for folder in ("graphs", "nodes"):
            (tmp_path / project / folder).mkdir(parents=True)
        (tmp_path / project / "nodes" / "talk.py").touch()
    (tmp_path / "ours/nodes/only.py").touch()
    theirs = tmp_path / "theirs/graphs/theirs.yaml"
    theirs.write_text("nodes: {/t: {class: 'nodes.talk:Talk'}, /o: {class: 'nodes.only:Only'}}")
    ours = tmp_path / "ours/graphs/ours.yaml"
    text = f"include: {theirs}\nnodes: {{/u: {{class: 'nodes.talk:Talk'}}}}\n"
    plan = resolve(source.read(text, str(ours)), ours, [], {})

    def imported(project: str) -> Interfaces:
        places = {name: Place(str(tmp_path / project / "nodes" / f"{name}.py")) for name in ("talk", "only")}
        return {f"nodes.{n}:{n.title()}": Interface(f"nodes.{n}:{n.title()}", n, at) for n, at in places.items()}

    [problem] = loose_ends(plan, imported("ours"))
    assert problem.place.file == str(theirs)
    assert f"ours/nodes/talk.py, not that of this file's project, {tmp_path}/theirs/nodes/talk.py" in problem.message
    (tmp_path / "theirs/nodes/only.py").touch()
    assert loose_ends(plan, imported("theirs")) == []


def test_panes_of_the_console() -> None:
    """A name that a pane misspells is reported, unless a program or a class may have it at run time."""
    panes = "console: {windows: [{panes: [{log: /l}, {echo: /chater}]}]}\n"
    graph = "nodes:\n  /talk: {class: a:Talker}\n  /l: {class: a:Listener}\n"
    assert told(graph + panes) == ["g.yaml:4:48: this graph has no topic /chater; did you mean '/chatter'?"]
    assert told(f"{graph}  /any: {{class: a:Any}}\n{panes}") == []
    assert told(f"{graph}  /rviz: {{command: [rviz2]}}\n{panes}") == []
