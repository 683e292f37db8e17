"""Imports of modules that are not there."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from graphflow.msgs import registry
from graphflow.rclpy.hints.missing_modules import imported_in, where_to_have
from graphflow.system import SITE
from graphflow.workspace.packages import find_workspace
from tests.cases import slow


@pytest.mark.parametrize(
    ("module", "sentence"),
    [
        ("lamp.srv", "lamp has no .srv file; they are in lamp_interfaces: from lamp_interfaces.srv import ..."),
        ("lamp_interfaces.action", "{}/srv/Shine.action must be {}/action/Shine.action"),
        ("lamp.action", "lamp has no .action file: "),
    ],
)
def test_definitions_of_another_package_or_folder(tmp_path: Path, module: str, sentence: str) -> None:
    """An import of what is not there is answered with where it is, or has to be."""
    for name in ("lamp", "lamp_interfaces"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    folder = tmp_path / "src/lamp_interfaces"
    (folder / "srv").mkdir()
    (folder / "srv/SetLight.srv").write_text("---\n")
    (folder / "srv/Shine.action").write_text("---\n---\n")
    assert where_to_have(module, find_workspace(tmp_path)).startswith(sentence.format(folder, folder))


def test_a_type_that_another_package_of_the_workspace_has(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The import to write has its name."""
    for name in ("lamp", "lamp_kinds"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (tmp_path / "src/lamp_kinds/srv").mkdir()
    (tmp_path / "src/lamp_kinds/srv/SetLight.srv").write_text("---\n")
    monkeypatch.setattr(registry, "_packages", {"lamp_kinds": tmp_path / "src/lamp_kinds"})
    program = tmp_path / "program.py"
    program.write_text("import os\nfrom lamp_no_such.srv import SetLight, Other\n")
    with pytest.raises(ModuleNotFoundError) as caught:
        exec(compile(program.read_text(), str(program), "exec"), {})
    wanted = imported_in(caught.value)
    assert wanted == "SetLight"
    right = "SetLight is in lamp_kinds.srv: from lamp_kinds.srv import SetLight"
    assert where_to_have("lamp.srv", find_workspace(tmp_path), wanted) == right
    own = "SetLight is in lamp_kinds.srv: from lamp_kinds.srv import SetLight"
    assert where_to_have("lamp_kinds.msg", find_workspace(tmp_path), wanted) == own


def run_by_python(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run `program.py` of a folder by Python itself, in an environment in which `rclpy enable` was run."""
    (folder / "site").mkdir()
    hook = f"import sys; sys.path.append({SITE!r}); import graphflow.rclpy.site_hook\n"
    (folder / "site" / "sitecustomize.py").write_text(hook)
    words, env = [sys.executable, "program.py"], {**os.environ, "PYTHONPATH": str(folder / "site")}
    return subprocess.run(words, cwd=folder, env=env, capture_output=True, text=True, timeout=30, check=False)


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        ("from lamp_kinds.msg import Light", "lamp_kinds/Light.msg must be {}/src/lamp_kinds/msg/Light.msg"),
        ("import rclpy\nfrom rclpy.action import ActionSever", "note: did you mean 'ActionServer'?"),
        ("import rclpy\nfrom tf2_ros import TransformListner", "note: did you mean 'TransformListener'?"),
        ("import rclpy\nfrom tf_ros import Buffer", "note: there is no tf_ros here; did you mean 'tf2_ros'?"),
        ("import rclpy\nclass Lamp(Node):\n    pass", "note: Node is in rclpy.node: from rclpy.node import Node"),
    ],
)
@slow
def test_programs_that_python_itself_runs(tmp_path: Path, lines: str, sentence: str) -> None:
    """Are told the next step as well, before they have called `rclpy.init`."""
    (tmp_path / "src" / "lamp_kinds").mkdir(parents=True)
    (tmp_path / "src" / "lamp_kinds" / "package.xml").write_text("<package><name>lamp_kinds</name></package>")
    (tmp_path / "src" / "lamp_kinds" / "Light.msg").write_text("int8 level\n")
    (tmp_path / "program.py").write_text(lines)
    ended = run_by_python(tmp_path)
    assert ended.returncode == 1
    told = ended.stderr.splitlines()[-1]
    assert told.endswith(sentence.format(tmp_path)), ended.stderr


@slow
def test_a_program_that_has_not_initialized(tmp_path: Path) -> None:
    """Its traceback has its own lines alone, as after `rclpy.init`."""
    (tmp_path / "program.py").write_text("import rclpy\nfrom rclpy.node import Node\nNode('lamp')\n")
    told = run_by_python(tmp_path).stderr.splitlines()
    assert [line.split(",")[0] for line in told if line.startswith("  File ")] == [f'  File "{tmp_path}/program.py"']
    assert told[-1].endswith("NotInitializedException: rclpy.init() has not been called: cannot create node")
