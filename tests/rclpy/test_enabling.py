"""Where rclpy can be imported."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.rclpy import enabling
from graphflow.system import SITE
from tests.cases import slow


def test_a_ros_that_is_sourced_wins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever it stands in the path."""
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").touch()
    monkeypatch.setattr(sys, "path", [*sys.path, str(tmp_path)])
    assert enabling.elsewhere() == str(tmp_path / "rclpy" / "__init__.py")
    assert not enabling.here()
    assert SITE not in sys.path
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry != str(tmp_path)])
    assert enabling.elsewhere() is None
    assert enabling.here()
    assert sys.path[-1] == SITE


@slow
def test_a_source_tree_of_rclpy_does_not_win(tmp_path: Path) -> None:
    """It could not be imported before it is built; what is beside it can be."""
    (tmp_path / "rclpy").mkdir()
    (tmp_path / "rclpy" / "__init__.py").write_text("raise ImportError")
    (tmp_path / "beside.py").touch()
    (tmp_path / "package.xml").write_text("<package><name>rclpy</name></package>")
    script = "from graphflow.rclpy import enabling; print(enabling.here()); import beside, rclpy; print(rclpy.__file__)"
    env = os.environ | {"PYTHONPATH": str(tmp_path)}
    shown = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=env, check=True).stdout
    assert shown.split() == ["True", os.path.join(SITE, "rclpy", "__init__.py")]


@slow
def test_a_virtual_environment_has_it_from_enable_to_disable(tmp_path: Path) -> None:
    """With messages, and not before it was asked for."""
    subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", tmp_path], check=True)
    python = tmp_path / "bin" / "python"
    folder = Path(next((tmp_path / "lib").iterdir()), "site-packages")
    paths = [str(Path(enabling.__file__).parents[2]), *(p for p in sys.path if p.endswith("site-packages"))]
    (folder / "a.pth").write_text("\n".join(paths) + "\n")
    env = {**os.environ, "PYTHONPATH": ""}

    def run(code: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([python, "-c", code], env=env, capture_output=True, text=True, timeout=30, check=False)

    use = "import rclpy.task; from std_msgs.msg import String; print(String(data='a'))"
    assert "No module named 'rclpy'" in run(use).stderr
    made = run("from graphflow.rclpy import enabling; print(enabling.enable(), enabling.is_enabled())").stdout.split()
    assert made == [str(folder / enabling.FILE), "True"]
    assert run(use).stdout == "std_msgs.msg.String(data='a')\n"
    assert (folder / enabling.TYPINGS / "std_msgs" / "msg" / "__init__.pyi").is_file()
    undo = "from graphflow.rclpy import enabling; print(enabling.disable(), enabling.disable())"
    assert run(undo).stdout == "True False\n"
    assert not (folder / enabling.TYPINGS).exists()
    assert "No module named 'rclpy'" in run(use).stderr
