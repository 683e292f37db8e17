"""What packages have registered."""

from __future__ import annotations

from pathlib import Path

import pytest
from ament_index_python.resources import get_resource, get_resource_types, get_resources, has_resource


def test_packages_and_interfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of the workspace, and those with messages."""
    (tmp_path / "src" / "lamp").mkdir(parents=True)
    (tmp_path / "src" / "lamp" / "package.xml").write_text("<package><name>lamp</name></package>")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.argv", [""])
    assert get_resource_types() == {"packages", "rosidl_interfaces"}
    assert get_resources("packages")["lamp"] == str(tmp_path / "src" / "lamp")
    assert get_resource("packages", "lamp") == ("", str(tmp_path / "src" / "lamp"))
    assert "std_msgs" in get_resources("rosidl_interfaces")
    content, _ = get_resource("rosidl_interfaces", "turtlesim")
    assert "srv/Spawn.srv" in content.splitlines()
    assert get_resources("rqt_gui_py.plugins") == {}
    assert has_resource("packages", "nobody") is False
    with pytest.raises(LookupError):
        get_resource("packages", "nobody")
    for wrong in (lambda: get_resources(""), lambda: has_resource("packages", "a/b")):
        with pytest.raises(ValueError, match="is invalid"):
            wrong()
