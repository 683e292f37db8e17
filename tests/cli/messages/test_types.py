"""Types on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.cli.messages.types import agree, check_kind, check_order, names_of_type, use_project
from graphflow.errors import UsageFault
from graphflow.msgs import registry


def test_the_same_type(capsys: pytest.CaptureFixture[str]) -> None:
    """The same type is accepted without a note."""
    assert agree("std_msgs/msg/String", ["a/msg/B", "std_msgs/msg/String"], "/chatter") == "std_msgs/msg/String"
    assert capsys.readouterr() == ("", "")


def test_one_definition_under_two_names(capsys: pytest.CaptureFixture[str]) -> None:
    """The graph's name is used, with a note."""
    assert agree("turtlesim_msgs/msg/Pose", ["a/msg/B", "turtlesim/msg/Pose"], "/turtle1/pose") == "turtlesim/msg/Pose"
    assert capsys.readouterr() == ("", "note: /turtle1/pose is of type turtlesim/msg/Pose; using that\n")


def test_two_types() -> None:
    """Different types are wrong usage; the error has the graph's."""
    with pytest.raises(UsageFault, match=r"^/chatter is of type std_msgs/msg/String, not std_msgs/msg/Int32$"):
        agree("std_msgs/msg/Int32", ["std_msgs/msg/String"], "/chatter")


def test_the_projects_own_are_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From any folder of the project, its `interfaces/` is found."""
    monkeypatch.setattr(registry, "_roots", [])
    folder = tmp_path / "interfaces" / "own_types" / "msg"
    folder.mkdir(parents=True)
    (folder / "Thing.msg").write_text("int32 x\n")
    (tmp_path / "nodes").mkdir()
    (tmp_path / "pyproject.toml").touch()
    monkeypatch.chdir(tmp_path / "nodes")
    use_project()
    assert registry.definition_file("own_types/msg/Thing") == folder / "Thing.msg"


def test_those_of_a_workspace_are_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Types of a workspace are found from any of its folders; it is searched for the first unknown package."""
    monkeypatch.setattr(registry, "_packages", {})
    monkeypatch.setattr(registry, "_later", [])
    package = tmp_path / "src" / "lamp_interfaces"
    (package / "action").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>lamp_interfaces</name></package>")
    (package / "action" / "Fade.action").write_text("int32 to\n---\n---\n")
    monkeypatch.chdir(package)
    use_project()
    assert registry.full_name("std_msgs/String") == "std_msgs/msg/String"
    assert registry._later
    assert registry.full_name("lamp_interfaces/Fade") == "lamp_interfaces/action/Fade"
    assert not registry._later
    assert "lamp_interfaces" in registry.packages()


@pytest.mark.parametrize(
    ("type_name", "kind", "told"),
    [
        ("turtlesim/srv/Spawn", "msg", "is a service, not a message; graphflow service call takes such types"),
        ("std_msgs/msg/String", "srv", "is a message, not a service; graphflow topic pub takes such types"),
        ("a/action/B", "srv", "is an action, not a service; graphflow action send_goal takes such types"),
    ],
)
def test_a_type_of_another_kind(type_name: str, kind: str, told: str) -> None:
    """The error has the command for that kind; derived types of services and actions are accepted."""
    with pytest.raises(UsageFault, match=f"^{type_name} {told}$"):
        check_kind(type_name, kind)
    check_kind(f"{type_name}_Request", kind)
    check_kind(f"a/{kind}/B", kind)


def test_words_in_another_order() -> None:
    """The error has the right command; a name without a leading slash is recognized, too."""
    with pytest.raises(
        UsageFault, match=r"^the name comes first, then its type: graphflow topic pub /t a/msg/B \.\.\.$"
    ):
        check_order("a/msg/B", "/t", "topic pub")
    with pytest.raises(UsageFault, match=r"^the values come last, .*: graphflow service call /t TYPE '\{x: 1\}'$"):
        check_order("{x: 1}", "/t", "service call")
    for name, type_name in (("/t", "a/msg/B"), ("t", "/x"), ("t", None), ("a/t", "a/B")):
        check_order(name, type_name, "topic pub")


def test_a_type_by_its_last_part(capsys: pytest.CaptureFixture[str]) -> None:
    """A type's last part alone is not found, and the full name is suggested."""
    assert names_of_type({"/t": ["std_msgs/msg/String"]}, "String", only_count=False) == []
    assert capsys.readouterr().err == "nothing is of type String; did you mean 'std_msgs/msg/String'?\n"
