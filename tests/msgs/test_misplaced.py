"""Advice on files of definitions that are not found where they lie."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import UnknownInterface
from graphflow.msgs import registry
from graphflow.msgs.misplaced import camel


def test_a_folder_with_a_dash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is no package; what its name has to be is told."""
    monkeypatch.setattr(registry, "_roots", [tmp_path])
    (tmp_path / "rover-msgs" / "msg").mkdir(parents=True)
    assert registry.no_kinds("rover_msgs") == f"; rename {tmp_path / 'rover-msgs'} to rover_msgs"
    assert registry.no_kinds("lamp_msgs") == ""


@pytest.mark.parametrize("where", ["msgs/Light.msg", "Light.msg", "reg_moved/msg/Light.msg"])
def test_definitions_in_a_wrong_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str) -> None:
    """Make no package; where they have to be is told."""
    monkeypatch.setattr(registry, "_packages", {"reg_moved": tmp_path})
    with pytest.raises(UnknownInterface, match=f"'reg_moved'; {tmp_path} has no .msg, .srv or .action files$"):
        registry.full_name("reg_moved/msg/Light")
    (tmp_path / where).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / where).write_text("int8 level\n")
    assert "reg_moved" not in registry.packages()
    right = tmp_path / "msg" / "Light.msg"
    with pytest.raises(UnknownInterface, match=f"'reg_moved'; {tmp_path / where} must be {right}$"):
        registry.full_name("reg_moved/msg/Light")


@pytest.mark.parametrize("where", ["srv/SetGoal.srv", "SetGoal.srv"])
def test_a_definition_in_no_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str) -> None:
    """The folder of its package is missing; where it has to go is told."""
    monkeypatch.setattr(registry, "_roots", [tmp_path])
    file = tmp_path / where
    file.parent.mkdir(exist_ok=True)
    file.write_text("---\n")
    right = tmp_path / "turtle_msgs" / "srv" / "SetGoal.srv"
    assert registry.no_kinds("turtle_msgs") == f"; {file} lies in no package: move it to {right}"


def test_a_definition_that_is_not_called_as_interfaces_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The name that it has to have is told, and so is the folder of one that lies among those of another kind."""
    (tmp_path / "srv").mkdir()
    (tmp_path / "srv" / "set_goal.srv").write_text("---\n")
    (tmp_path / "srv" / "Drive.action").write_text("---\n---\n")
    monkeypatch.setattr(registry, "_packages", {"reg_snake": tmp_path})
    told = f"{tmp_path}/srv/set_goal.srv must be {tmp_path}/srv/SetGoal.srv: names of interfaces are in camel case$"
    for asked in ("reg_snake/srv/SetGoal", "reg_snake/SetGoal"):
        with pytest.raises(UnknownInterface, match=told):
            registry.full_name(asked)
    with pytest.raises(UnknownInterface, match=f"{tmp_path}/srv/Drive.action must be {tmp_path}/action/Drive.action$"):
        registry.full_name("reg_snake/action/Drive")
    assert registry.misplaced("reg_snake", "Other") == ""
    assert camel("set_goal") == camel("setGoal") == camel("SetGoal") == "SetGoal"
