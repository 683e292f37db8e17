"""`graphflow check` of a file of parameters, and of a `setup.py`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from graphflow.cli import exits
from graphflow.cli.graphs.ros_files import check_parameters, check_setup, is_parameters
from graphflow.errors import UsageFault
from tests.conftest import Machine

PARAMETERS = "/talker:\n  ros__parameters:\n    rate: 2.0\n"
MANIFEST = '<package format="3"><name>lamp</name></package>'
SETUP = "from setuptools import setup\nsetup(entry_points={{'console_scripts': [{}]}})\n"


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        (PARAMETERS, True),
        (PARAMETERS.replace("ros__", "ros_"), True),
        ("/**:\n    'ros__parameters': {rate: 1.0}\n", True),
        (f"nodes:\n  {PARAMETERS}", False),
        ("nodes: {}\n", False),
        ("talker:\n  rate: 1.0\n", True),
        ("rate: 1.0\n", True),
        ("node: {}\n", False),
        ("node:\n  a: 1\n", False),
        ("talker:\n  lamp: {class: x:Y}\n", False),
        ("- a\n", False),
        ("a: [\n", False),
        ("", False),
    ],
)
def test_which_file_has_parameters(tmp_path: Path, text: str, verdict: bool) -> None:
    """A graph file has keys of its own, and other files another suffix."""
    for name in ("p.yaml", "p.yml", "p.txt"):
        (tmp_path / name).write_text(text)
        assert is_parameters(tmp_path / name) is (verdict and name != "p.txt")


def test_a_file_of_parameters(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The nodes that it names are shown, or its mistakes."""
    file = tmp_path / "p.yaml"
    file.write_text(PARAMETERS)
    assert check_parameters(file, as_json=False) == exits.OK
    assert capsys.readouterr().out == f"{file}: parameters of /talker, no problems\n"
    file.write_text("".join(PARAMETERS.replace("talker", f"t{i}") for i in range(7)))
    assert check_parameters(file, as_json=False) == exits.OK
    assert "parameters of /t0, /t1, /t2, /t3, /t4 and 2 more, no problems" in capsys.readouterr().out
    file.write_text(PARAMETERS.replace("ros__", "ros_"))
    assert check_parameters(file, as_json=False) == exits.USAGE
    told = capsys.readouterr()
    assert "did you mean 'ros__parameters', with two _ in a row?" in told.err
    assert told.out == f"{file}: 1 problem\n"
    assert check_parameters(file, as_json=True) == exits.USAGE
    [problem] = json.loads(capsys.readouterr().out)["problems"]
    assert (problem["line"], problem["column"]) == (2, 3)


def test_a_setup_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """An executable whose module is missing is a problem, and so is a file that names none."""
    file = tmp_path / "setup.py"
    file.write_text(SETUP.format("'go = lamp.go:main', 'on = lamp.on:main'"))
    with pytest.raises(UsageFault, match=r"no package\.xml beside it"):
        check_setup(file, as_json=False)
    (tmp_path / "package.xml").write_text(MANIFEST)
    (tmp_path / "lamp").mkdir()
    (tmp_path / "lamp" / "go.py").write_text("import rclpy\ndef main():\n    rclpy.spin(node)\n")
    assert check_setup(file, as_json=False) == exits.USAGE
    told = capsys.readouterr()
    assert f"{file}:2: on is lamp.on:main, and there is no " in told.err
    assert told.out == f"{file}: executables: go, on, 1 problem\n"
    file.write_text(SETUP.format("'go = lamp.go:main',"))
    assert check_setup(file, as_json=True) == exits.OK
    assert json.loads(capsys.readouterr().out) == {"problems": [], "remarks": [], "deadlocks": []}
    file.write_text(SETUP.format(""))
    assert check_setup(file, as_json=True) == exits.USAGE
    [problem] = json.loads(capsys.readouterr().out)["problems"]
    assert (problem["file"], problem["line"]) == (str(file), 0)
    assert problem["message"].startswith("names no executable: add 'go = lamp.go:main'")
    file.write_text(SETUP.format("'go = lamp.go:main'").replace("setup(", "setup(name='lump', "))
    assert check_setup(file, as_json=False) == exits.USAGE
    assert f"{file}:2: the package is called 'lump' here, and 'lamp' in package.xml" in capsys.readouterr().err
    file.write_text(SETUP.format("'on = lamp.on:main'"))
    assert check_setup(file, as_json=True) == exits.USAGE
    [problem] = json.loads(capsys.readouterr().out)["problems"]
    assert (problem["file"], problem["line"]) == (str(file), 2)
    assert problem["message"].startswith("on is lamp.on:main, and there is no ")


@pytest.mark.parametrize(
    ("file", "told"),
    [
        ("lamps/msg/Light.msg", "graphflow interface show lamps/msg/Light reads it; graphflow ws checks all"),
        ("lamps/CMakeLists.txt", "is part of a package: graphflow ws checks those of the workspace"),
    ],
)
def test_other_files_of_a_package(machine: Machine, tmp_path: Path, file: str, told: str) -> None:
    """They are no graph files; another command checks them."""
    (tmp_path / file).parent.mkdir(parents=True)
    (tmp_path / file).write_text("bool on\n")
    assert told in machine.look("check", file, cwd=tmp_path, code=exits.USAGE)


def test_source_without_nodes(machine: Machine, tmp_path: Path) -> None:
    """A module of helpers is no mistake."""
    (tmp_path / "pid.py").write_text("def limit(x):\n    return min(x, 1.0)\n")
    assert machine.look("check", "pid.py", cwd=tmp_path) == "pid.py: no deadlocks visible in the source\n"
