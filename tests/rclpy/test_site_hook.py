"""Python that was started by itself, where rclpy is enabled."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases import slow

NODE = "from lamp_msgs.msg import Light\nfrom lamp.level import LEVEL\nprint(Light(level=LEVEL))\n"
TEST = "import rclpy\nfrom lamp_msgs.msg import Light\n\ndef test_it():\n    import lamp.node\n"


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    """A workspace with a package of code, whose test imports it, and one of messages."""
    for file, text in {
        "lamp/package.xml": "<package><name>lamp</name></package>",
        "lamp/lamp/__init__.py": "",
        "lamp/lamp/node.py": NODE,
        "lamp/lamp/level.py": "LEVEL = 7\n",
        "lamp/test/test_lamp.py": TEST,
        "lamp_msgs/package.xml": "<package><name>lamp_msgs</name></package>",
        "lamp_msgs/msg/Light.msg": "int32 level\n",
    }.items():
        (tmp_path / "src" / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "src" / file).write_text(text)
    return tmp_path


def python(folder: Path, code: str) -> str:
    """What a Python prints in which rclpy is enabled, or the last line of its complaint."""
    lines = f"import graphflow.rclpy.site_hook\n{code}"
    ran = subprocess.run(
        [sys.executable, "-c", lines], cwd=folder, capture_output=True, text=True, timeout=60, check=False
    )
    return ran.stdout or ran.stderr.strip().rpartition("\n")[2]


@slow
@pytest.mark.parametrize("folder", ["", "src", "src/lamp", "src/lamp/test"])
def test_what_lies_around_can_be_imported(workspace: Path, folder: str) -> None:
    """Wherever in the workspace the shell is: code, and messages, also where folders look like packages."""
    assert python(workspace / folder, "import lamp.node") == "lamp_msgs.msg.Light(level=7)\n"
    assert python(workspace / folder, "from lamp_msgs.msg import Light; print(Light())") == (
        "lamp_msgs.msg.Light(level=0)\n"
    )


@slow
def test_a_program_finds_what_lies_around_it(workspace: Path, tmp_path: Path) -> None:
    """Wherever the shell is; what lies nowhere is not found."""
    run = f"import runpy, sys; sys.argv = [{str(workspace / 'src/lamp/lamp/node.py')!r}]; runpy.run_path(sys.argv[0])"
    (tmp_path / "elsewhere").mkdir()
    assert python(Path("/"), run) == "lamp_msgs.msg.Light(level=7)\n"
    assert python(Path("/"), "import lamp") == "ModuleNotFoundError: No module named 'lamp'"
    assert python(workspace, "import lampp") == "ModuleNotFoundError: No module named 'lampp'"


@slow
def test_a_packages_own_tests(workspace: Path) -> None:
    """Are run by pytest, which looks for a module of pickle's before all else is imported."""
    code = "import sys, pytest; sys.exit(pytest.main(['-q', '-p', 'no:cacheprovider', 'src/lamp/test']))"
    assert "1 passed" in python(workspace, code)
    env = {**os.environ, "PYTHONPATH": "."}
    assert subprocess.run([sys.executable, "-c", "import lamp"], cwd=workspace, env=env, check=False).returncode == 1


def test_where_nothing_is_looked_for(workspace: Path, tmp_path: Path) -> None:
    """In a folder that has been removed, from a home folder on, and by a Python that is to be safe."""
    gone = "import os, sys; os.mkdir('gone'); os.chdir('gone'); os.rmdir('../gone'); sys.argv = ['']; import lamp"
    assert python(tmp_path, gone) == "ModuleNotFoundError: No module named 'lamp'"
    home = f"import pathlib; pathlib.Path.home = lambda: pathlib.Path({str(workspace)!r}); import lamp"
    assert python(workspace, home) == "ModuleNotFoundError: No module named 'lamp'"
    safe = [sys.executable, "-P", "-c", "import graphflow.rclpy.site_hook\nimport lamp"]
    ran = subprocess.run(safe, cwd=workspace, capture_output=True, text=True, timeout=60, check=False)
    assert ran.stderr.endswith("ModuleNotFoundError: No module named 'lamp'\n")
