"""ROS 2's parameter files: read, matched to nodes, and written so that they read back the same."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.errors import GraphFileError, Place
from graphflow.graph import params_file
from graphflow.graph.checks.check import check
from graphflow.graph.params_file import Section, params_for, strays, write
from graphflow.graph.plan import Plan
from graphflow.graph.resolve import load
from graphflow.interface import Interface, Parameter
from tests.cases import count, slow

TEXT = """\
/**:
  ros__parameters:
    use_sim_time: true
/turtle1/follower:
  ros__parameters:
    gain: 2.0
    limits: {speed: 1.0, turn.rate: 2}
    names: [a, 'b c']
turtle2:
  follower:
    ros__parameters: {gain: 3}
"""


def sections(tmp_path: Path, text: str = TEXT) -> list[Section]:
    file = tmp_path / "p.yaml"
    file.write_text(text)
    return params_file.read(file, "p.yaml")


def values(found: list[Section], node: str) -> dict[str, Any]:
    return {name: setting.value for name, setting in params_for(found, node).items()}


def test_sections_give_their_nodes_values(tmp_path: Path) -> None:
    """Full names, nested namespaces, wildcards; nested mappings are flattened; the place of each value is kept."""
    found = sections(tmp_path)
    assert [s.pattern for s in found] == ["/**", "/turtle1/follower", "/turtle2/follower"]
    assert values(found, "/turtle1/follower") == {
        "use_sim_time": True,
        "gain": 2.0,
        "limits.speed": 1.0,
        "limits.turn.rate": 2,
        "names": ["a", "b c"],
    }
    assert values(found, "/turtle2/follower") == {"use_sim_time": True, "gain": 3}
    assert values(found, "/other") == {"use_sim_time": True}
    setting = params_for(found, "/turtle1/follower")["limits.speed"]
    assert (setting.place, setting.is_optional) == (Place("p.yaml", 7, 21), False)
    assert params_for(found, "/other")["use_sim_time"].is_optional


@pytest.mark.parametrize(
    ("pattern", "fitting", "other"),
    [
        ("/a", ["/a"], ["/b", "/n/a", "/ab"]),
        ("/*", ["/a", "/b"], ["/n/a"]),
        ("/**", ["/a", "/n/a", "/n/m/a"], []),
        ("/n/*", ["/n/a"], ["/a", "/n/m/a", "/n"]),
        ("/n/**", ["/n/a", "/n/m/a"], ["/a", "/m/n/a"]),
        ("/**/a", ["/a", "/n/a", "/n/m/a"], ["/b", "/n/ba"]),
        ("/*/a", ["/n/a"], ["/a", "/n/m/a"]),
    ],
)
def test_patterns(pattern: str, fitting: list[str], other: list[str]) -> None:
    """One star stands for one part of a name, two for any number."""
    section = Section(pattern, Place("p"), {})
    assert [n for n in fitting if not section.fits(n)] == []
    assert [n for n in other if section.fits(n)] == []


def test_the_later_section_counts(tmp_path: Path) -> None:
    """Whether it is by name or by wildcard."""
    text = "a: {ros__parameters: {x: 1, y: 1}}\n'/**': {ros__parameters: {x: 2}}\n"
    assert values(sections(tmp_path, text), "/a") == {"x": 2, "y": 1}


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "p.yaml:1:1: a parameter file is a mapping: NODE: {ros__parameters: ...}"),
        ("{}", "p.yaml:1:1: the file has no section; write NODE: {ros__parameters: {rate: 2.0}}"),
        ("nodes: {/a: {class: 'n:A'}}", "p.yaml:1:1: this is a graph file: graphflow up p.yaml"),
        ("nodes: {a: 1}", "p.yaml:1:9: 'a': write above it ros__parameters: and indent it below that"),
        ("a: 1", "p.yaml:1:1: 'a': write above it /**: and, indented, ros__parameters: and indent it below that"),
        ("a:\n  rate: 1", "p.yaml:2:3: 'rate': write above it ros__parameters: and indent it below that"),
        ("a:\nros__parameters:\n  x: 1", "p.yaml:2:1: 'ros__parameters' belongs below 'a': indent it and what follows"),
        ("a:\n  ros__parameters:\n  x: 1", "p.yaml:3:3: 'x' belongs below 'ros__parameters': indent it and what"),
        ("ros__parameters: {x: 1}", "p.yaml:1:1: ros__parameters belongs below a node: write NODE: above, and"),
        ("a:\n  ros__parameters:\n    x=150", "p.yaml:3:5: ros__parameters is a mapping; write x: 150"),
        ("a:\n  ros__parameters:\n    x 150", "p.yaml:3:5: ros__parameters is a mapping; write x: 150"),
        ("a: {ros__parameters: 3}", "p.yaml:1:5: ros__parameters is a mapping, for example {rate: 2.0}"),
        (
            "a: {ros__parameters: {'x.y: 2.0': }}",
            "p.yaml:1:23: parameter 'x.y: 2.0' has no value; as a whole it is read as a name: write "
            "x.y: 2.0, without quotes",
        ),
        ("a: {ros__parameters: {'x:=2.0': }}", "p.yaml:1:23: parameter 'x:=2.0' has no value; write x: 2.0"),
        ("a: {ros__parameters: {x=: }}", "p.yaml:1:23: parameter 'x=' has no value; an empty string is ''"),
        ("a: {ros__parameters: {x: }}", "p.yaml:1:23: parameter 'x' has no value; an empty string is ''"),
        (
            "a: {ros__parameters: {x: 2,0}}",
            "p.yaml:1:28: parameter '0' has no value; a number is written with a point, as 2.5",
        ),
        (
            "a:\n  ros__parameters:\n    x.y: 1\n    x: {y: 2}",
            "p.yaml:4:12: parameter 'x.y' is given twice, first on line 3; remove one",
        ),
        ("a: [", "p.yaml:1:5: not valid YAML"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(tmp_path: Path, text: str, problem: str) -> None:
    """A file that is none, parameters in the wrong place, values twice or missing."""
    with pytest.raises(GraphFileError) as caught:
        sections(tmp_path, text)
    assert problem in str(caught.value)


def test_a_section_for_nobody_is_a_mistake(tmp_path: Path) -> None:
    """Its place, and the node that was probably meant."""
    found = sections(tmp_path, "/taklers: {ros__parameters: {rate: 1}}")
    assert [str(p) for p in strays(found, ["/talker", "/listener"])] == [
        "p.yaml:1:1: there is no node /taklers; did you mean '/talker'?"
    ]


NAMES = st.from_regex(r"[a-z][a-z0-9_]{0,5}(\.[a-z][a-z0-9_]{0,5}){0,2}", fullmatch=True)
SCALARS: list[st.SearchStrategy[Any]] = [
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.floats(allow_nan=False),
    st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=12)
    | st.sampled_from(
        ["5", "1e5", "true", "on", "y", "nan", "~", "", " x", "a: b", "#", "0x1F", "12:30", "-", "1_000"]
    ),
]
VALUES = st.one_of(*SCALARS, *(st.lists(s, min_size=1, max_size=4) for s in SCALARS))


@slow
@settings(deadline=None, max_examples=count(few=50, full=200), derandomize=True)
@given(st.dictionaries(NAMES, VALUES, max_size=6))
def test_what_is_written_reads_back_the_same(tmp_path_factory: pytest.TempPathFactory, params: dict[str, Any]) -> None:
    """Values and types, texts that look like something else included."""
    text = write("/a/b", params)
    file = tmp_path_factory.getbasetemp() / "written.yaml"
    file.write_text(text, encoding="utf-8")
    found = params_for(params_file.read(file, "p.yaml"), "/a/b")
    assert {k: s.value for k, s in found.items()} == params
    assert {k: type(s.value) for k, s in found.items()} == {k: type(v) for k, v in params.items()}


@pytest.mark.parametrize("text", ["5", "1e5", "true", "on", "y", "No", "null", "", "12:30", "1.5", "plain text"])
def test_other_readers_take_texts_for_texts(text: str) -> None:
    """PyYAML's YAML 1.1, which the launch tools of ROS 2 use, reads a text that was written as a text."""
    assert yaml.safe_load(write("/a", {"x": text}))["/a"]["ros__parameters"]["x"] == text


def test_it_looks_like_ros(tmp_path: Path) -> None:
    """Sorted, nested by dots, two spaces a level."""
    text = write("/turtlesim", {"b": 255, "a.y": "on", "a.x": 1.0, "big": 1e20, "l": [1.0, 2.5], "raw": b"\x01\x02"})
    assert text == (
        "/turtlesim:\n  ros__parameters:\n    a:\n      x: 1.0\n      y: 'on'\n    b: 255\n    big: 1.0e+20\n"
        "    l: [1.0, 2.5]\n    raw: [1, 2]\n"
    )
    assert write("/n", {}) == "/n:\n  ros__parameters:\n    {}\n"


# in graph files


def plan_of(tmp_path: Path, graph: str, **files: str) -> Plan:
    for name, text in files.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    (tmp_path / "g.yaml").write_text(graph)
    return load(tmp_path / "g.yaml")


def interface(path: str, *params: str) -> Interface:
    made = tuple(Parameter(p, "float", 0.0, Place("x")) for p in params)
    return Interface(path, "n", Place("x"), params=made)


GRAPH = """\
nodes:
  /a: {class: x:A, params_file: p.yaml, params: {gain: 9.0}}
  /b: {class: x:B, params_file: [p.yaml, q.yaml]}
"""


def test_a_graph_takes_values_from_files(tmp_path: Path) -> None:
    """Below the node's own `params`, later files above earlier ones; paths begin at the graph file."""
    p = "'/**': {ros__parameters: {rate: 1.0}}\n/a: {ros__parameters: {gain: 2.0, speed: 3.0}}\n"
    plan = plan_of(tmp_path, GRAPH, p=p, q="b: {ros__parameters: {rate: 5.0}}")
    a, b = plan.nodes
    assert {k: s.value for k, s in a.params.items()} == {"rate": 1.0, "gain": 9.0, "speed": 3.0}
    assert {k: s.value for k, s in b.params.items()} == {"rate": 5.0}
    assert Plan.from_json(plan.to_json()) == plan

    assert check(plan, {"x:A": interface("x:A", "gain", "speed"), "x:B": interface("x:B", "rate")}) == []
    (problem,) = check(plan, {"x:A": interface("x:A", "gain"), "x:B": interface("x:B", "rate")})
    assert problem.message == "A has no parameter 'speed'; there is gain"
    assert problem.place.file.endswith("p.yaml")


def test_a_file_of_a_group(tmp_path: Path) -> None:
    """Comes before a node's own, may have nothing for one of them, and its path begins at the graph file."""
    graph = "group: {params_file: p.yaml, nodes: {/a: {class: x:A}, /b: {class: x:B, params_file: [q.yaml]}}}"
    p = "'/a': {ros__parameters: {rate: 1.0}}\n'/b': {ros__parameters: {gain: 2.0, speed: 3.0}}\n"
    a, b = plan_of(tmp_path, graph, p=p, q="b: {ros__parameters: {gain: 5.0}}").nodes
    assert {k: s.value for k, s in a.params.items()} == {"rate": 1.0}
    assert {k: s.value for k, s in b.params.items()} == {"gain": 5.0, "speed": 3.0}
    a, b = plan_of(tmp_path, graph, p="'/a': {ros__parameters: {rate: 1.0}}\n", q="b: {ros__parameters: {}}").nodes
    assert (len(a.params), len(b.params)) == (1, 0)


def test_a_wildcard_must_mean_somebody(tmp_path: Path) -> None:
    """What is there for many nodes may miss some of them, and not all."""
    graph = "nodes: {/a: {class: x:A, params_file: p.yaml}}"
    plan = plan_of(tmp_path, graph, p="'/**': {ros__parameters: {use_sim_time: true, rtae: 1.0}}")
    (problem,) = check(plan, {"x:A": interface("x:A", "rate")})
    assert problem.message == "no node of this graph has a parameter 'rtae'; did you mean 'rate'?"


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("/c: {ros__parameters: {x: 1}}", "p.yaml has nothing for /a"),
        ("/a: {ros__parameters: {x: 1}}\n/ab: {ros__parameters: {x: 1}}", "there is no node /ab; did you mean '/a'?"),
        ("/a: {ros_parameters: {x: 1}}", "'ros_parameters': did you mean 'ros__parameters', with two _ in a row?"),
        ("/a: {x: 1}", "'x': write above it ros__parameters: and indent it below that"),
    ],
)
def test_mistakes_in_a_file_are_mistakes_of_the_graph(tmp_path: Path, text: str, problem: str) -> None:
    """With the place where they were made."""
    with pytest.raises(GraphFileError) as caught:
        plan_of(tmp_path, "nodes: {/a: {class: x:A, params_file: p.yaml}}", p=text)
    assert problem in str(caught.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    """With the one that was probably meant."""
    with pytest.raises(GraphFileError, match=r"g\.yaml:1:39: there is no file .*parms\.yaml; did you mean 'params"):
        plan_of(tmp_path, "nodes: {/a: {class: x:A, params_file: parms.yaml}}", params="{}")


def test_a_section_that_goes_on_further_down(tmp_path: Path) -> None:
    """As in the files of some robots; what stands in it twice is a mistake all the same."""
    text = "/**: {ros__parameters: {a: 1}}\nn: {ros__parameters: {b: 2}}\n/**: {ros__parameters: {c: {d: 3}}}\n"
    assert values(sections(tmp_path, text), "/n") == {"a": 1, "b": 2, "c.d": 3}
    for again, line in (("/**: {ros__parameters: {a: 4}}", 4), ("n: 5", 4)):
        with pytest.raises(GraphFileError, match=rf"p.yaml:{line}:\d+: .* appears twice, first on line"):
            sections(tmp_path, f"{text}{again}\n")


def test_keys_are_texts(tmp_path: Path) -> None:
    """As in ROS, whatever they look like."""
    found = sections(tmp_path, "lamp:\n  ros__parameters: {motors: {0: {id: 7}, on: a}, 1.5: b}\n")
    assert values(found, "/lamp") == {"motors.0.id": 7, "motors.on": "a", "1.5": "b"}
