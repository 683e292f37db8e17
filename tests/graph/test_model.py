"""The grammar of a graph file: what is required, what it is by default, what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from graphflow.graph.model import TOP_KEYS, Arg, GraphFile, NodeSpec, StepSpec, class_meant, keys_of


def test_the_smallest_file() -> None:
    """Nodes with their classes are all a file needs."""
    file = GraphFile.model_validate({"nodes": {"a": {"class": "nodes.talker:Talker"}}})
    assert file.nodes["a"] == NodeSpec.model_validate({"class": "nodes.talker:Talker"})
    node = file.nodes["a"]
    assert (node.namespace, node.params, node.remap, node.process, node.env, node.after) == ("", {}, {}, "", {}, {})
    assert (file.name, file.domain, file.args, file.steps) == (None, None, {}, {})


def test_keys_are_those_written_in_files() -> None:
    """`class` is a key; Python's name for it is not."""
    words = (
        "namespace params params_file remap env restart on_exit critical log_level lifecycle if unless class command"
    )
    more = "pkg exec args keep_names prefix template process after concurrency"
    assert keys_of(NodeSpec) == [*words.split(), *more.split()]
    words = "call set goal wait delay log shutdown type request params after timeout if unless"
    assert keys_of(StepSpec) == words.split()
    assert keys_of(Arg) == ["default", "doc", "unit", "type", "choices"]
    words = (
        "name domain net args nodes steps group for templates include override deadlock call_timeout strategy console"
    )
    assert tuple(words.split()) == TOP_KEYS
    with pytest.raises(ValidationError):
        NodeSpec.model_validate({"class_": "a:B"})


@pytest.mark.parametrize("path", ["nodes.talker:Talker", "talker:T", "_a.b2.c:_D"])
def test_class_paths(path: str) -> None:
    """A class is named by module and name."""
    assert NodeSpec.model_validate({"class": path}).class_ == path


EXAMPLE = "write package.module:Class, for example nodes.talker:Talker"


@pytest.mark.parametrize(
    ("path", "way"),
    [
        *((path, EXAMPLE) for path in ("Talker", ":B", "a:B.C", "")),
        ("nodes.talker.Talker", "write nodes.talker:Talker"),
        ("nodes/talker.py:Talker", "write nodes.talker:Talker"),
        ("nodes.talker: Talker", "write nodes.talker:Talker"),
        ("nodes/talker.py", "write the class in it, too: nodes.talker:CLASS"),
        ("a:", "write the class in it, too: a:CLASS"),
        ("a:B\n", "write a:B"),
        ("nodes.turtle-base:Base", "Python imports no name with a hyphen; rename turtle-base to turtle_base"),
        ("nodes/turtle-base.py", "Python imports no name with a hyphen; rename turtle-base to turtle_base"),
    ],
)
def test_wrong_class_paths(path: str, way: str) -> None:
    """Anything else shows how to write it."""
    with pytest.raises(ValidationError) as caught:
        NodeSpec.model_validate({"class": path})
    assert str(caught.value.errors()[0]["ctx"]["error"]) == f"{path!r} is not a class; {way}"


def test_a_class_of_a_module_in_a_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its module is named if the package's files show it; a file that cannot be read is passed over."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "nodes").mkdir()
    (tmp_path / "nodes" / "a.py").mkdir()
    (tmp_path / "nodes" / "talker.py").write_text("class Talker(Node):\n    pass\n")
    assert class_meant("nodes.Talker") == "write nodes.talker:Talker"
    assert class_meant("nodes.Listener") == "write nodes:Listener"


@pytest.mark.parametrize("name", ["turtlesim/srv/Spawn", "std_srvs/Trigger"])
def test_service_types(name: str) -> None:
    """A step's type has ROS's long or short form."""
    assert StepSpec.model_validate({"call": "/x", "type": name}).type == name


@pytest.mark.parametrize("name", ["Spawn", "turtlesim/msg/Pose", "turtlesim.srv.Spawn", "a/srv/B\n", "A/srv/B", "a/b/"])
def test_wrong_service_types(name: str) -> None:
    """Anything else shows how to write one."""
    with pytest.raises(ValidationError, match="is not a service type; write package/srv/Name"):
        StepSpec.model_validate({"call": "/x", "type": name})


@pytest.mark.parametrize("name", ["a", "my-graph_2", "v1.2", "2nd"])
def test_graph_names(name: str) -> None:
    """A graph's name is a word, since folders are called by it."""
    assert GraphFile.model_validate({"name": name, "nodes": {}}).name == name


@pytest.mark.parametrize("name", ["", "../../etc", "a/b", "/a", ".hidden", "..", "a b", "a\n"])
def test_graph_names_stay_in_their_folder(name: str) -> None:
    """No name leads out of the folder of running graphs."""
    with pytest.raises(ValidationError, match=r"is not a name for a graph; use letters, digits, _, - and \."):
        GraphFile.model_validate({"name": name, "nodes": {}})


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        ({"nodes": {}, "node": {}}, "extra_forbidden"),
        ({"nodes": {}, "domain": -1}, "greater_than_equal"),
        ({"nodes": {}, "domain": 1.0}, "int_type"),
        ({"nodes": {}, "domain": "1"}, "int_type"),
        ({"nodes": {}, "domain": True}, "int_type"),
        ({"nodes": {}, "name": 3}, "string_type"),
        ({"nodes": []}, "dict_type"),
        ({"nodes": {"a": "x"}}, "model_type"),
    ],
)
def test_nothing_is_converted(data: dict[str, Any], kind: str) -> None:
    """Types are exact: a text is no number, a bool is no number, an unknown key is none of ours."""
    with pytest.raises(ValidationError) as caught:
        GraphFile.model_validate(data)
    assert [e["type"] for e in caught.value.errors()] == [kind]


def test_an_empty_section_is_an_absent_one() -> None:
    """A key whose lines have all been commented out does not break the file."""
    file = GraphFile.model_validate(
        {
            "name": None,
            "args": {"rate": None},
            "steps": None,
            "nodes": {"a": {"class": "a:B", "params": None, "remap": None, "after": None, "env": None}},
        }
    )
    assert file == GraphFile.model_validate({"args": {"rate": {}}, "nodes": {"a": {"class": "a:B"}}})


@pytest.mark.parametrize("data", [{"nodes": {"a": None}}, {"nodes": {"a": {"class": None}}}])
def test_what_is_required_may_not_be_empty(data: Any) -> None:
    """The exception are keys that a file cannot do without."""
    with pytest.raises(ValidationError):
        GraphFile.model_validate(data)


@pytest.mark.parametrize("timeout", [0, -1.0, "soon", True, None.__class__])
def test_a_timeout_is_more_than_nothing(timeout: Any) -> None:
    """A step waits for some seconds."""
    with pytest.raises(ValidationError):
        StepSpec.model_validate({"call": "/x", "timeout": timeout})


@pytest.mark.parametrize(
    ("keys", "way"),
    [
        ({"restart": "on-failure"}, "write restart: on_failure"),
        ({"restart": "unless-stopped"}, "write restart: always"),
        ({"restart": "no"}, "write restart: never"),
        ({"restart": True}, "write restart: always"),
        ({"log_level": "INFO"}, "write log_level: info"),
        ({"log_level": "warning"}, "write log_level: warn"),
        ({"after": {"a": {"condition": "service_completed_successfully"}}}, "write after: {a: done}"),
    ],
)
def test_words_of_other_tools(keys: dict[str, Any], way: str) -> None:
    """Each is answered with the word for it here."""
    with pytest.raises(ValidationError) as caught:
        NodeSpec.model_validate({"class": "a:B", **keys})
    assert str(caught.value.errors()[0]["ctx"]["error"]).endswith(way)
