"""Which interfaces there are."""

from __future__ import annotations

from pathlib import Path

import pytest
from rosidl_runtime_py import (
    get_action_interfaces,
    get_interface_packages,
    get_interface_path,
    get_interfaces,
    get_message_interfaces,
    get_service_interfaces,
)

from graphflow.msgs import registry
from graphflow.rclpy.messages import finder


def test_by_kind_and_package() -> None:
    """Packages without one of a kind are left out."""
    assert get_interfaces(["turtlesim"])["turtlesim"][:2] == ["msg/Color", "msg/Pose"]
    assert get_message_interfaces(["turtlesim"]) == {"turtlesim": ["msg/Color", "msg/Pose"]}
    assert get_service_interfaces(["std_msgs", "std_srvs"]) == {"std_srvs": ["srv/Empty", "srv/SetBool", "srv/Trigger"]}
    assert "action/Fibonacci" in get_action_interfaces()["example_interfaces"]
    with pytest.raises(LookupError, match="Unknown package 'nothing'"):
        get_interfaces(["nothing"])


def test_files() -> None:
    """With and without their endings; what is not there, or no name, is told."""
    file = get_interface_path("std_msgs/msg/String")
    assert Path(file).name == "String.msg"
    assert get_interface_path("std_msgs/msg/String.msg") == file
    for name, error in [("String", ValueError), ("x/msg/String", LookupError), ("std_msgs/msg/Strng", LookupError)]:
        with pytest.raises(error):
            get_interface_path(name)


def test_a_workspace_has_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are there as well."""
    (tmp_path / "msg").mkdir()
    (tmp_path / "msg" / "Light.msg").write_text("int32 level\n")
    monkeypatch.setitem(finder.KNOWN, "shed_interfaces", str(tmp_path))
    monkeypatch.setattr(registry, "_packages", dict(registry._packages))
    assert get_interface_packages()["shed_interfaces"] == str(tmp_path)
    assert get_interfaces(["shed_interfaces"]) == {"shed_interfaces": ["msg/Light"]}
