"""Wrong graph files: one mistake, one line that says where it is and what to do, and nothing is started.

Each `wrong/NAME.yaml` has what is said about it beside it, in `wrong/NAME.txt`.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from graphflow.cli import exits
from graphflow.cli.main import main
from tests.cases import slow
from tests.conftest import Machine

WRONG = Path(__file__).parent / "wrong"
NAMES = sorted(path.stem for path in WRONG.glob("*.yaml"))

MODULES = {
    "robot": '''\
from graphflow import Node, Param, Publisher, service
from graphflow.msgs.geometry_msgs.msg import Twist
from graphflow.msgs.std_srvs.srv import SetBool


class Robot(Node):
    """A robot that can be held."""

    rate = Param(10.0, unit="Hz", gt=0.0, le=100.0)
    wheel_base = Param(0.2, unit="m")
    cmd_vel = Publisher(Twist, "cmd_vel")

    @service(SetBool, "~/hold")
    async def hold(self, request: SetBool.Request) -> SetBool.Response:
        return SetBool.Response(success=request.data)
''',
    "broken": """\
from graphflow import Node

import wheels


class Broken(Node):
    drive = wheels.Drive()
""",
    "unfinished": """\
from graphflow import Node


class Unfinished(Node)
    pass
""",
}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A user's project: nodes, of which some are broken, and all the wrong graph files."""
    folder = tmp_path / "project"
    (folder / "nodes").mkdir(parents=True)
    (folder / "pyproject.toml").touch()
    for name, text in MODULES.items():
        (folder / "nodes" / f"{name}.py").write_text(text)
    shutil.copytree(WRONG, folder / "graphs")
    return folder


def expected(name: str, project: Path) -> str:
    return (WRONG / f"{name}.txt").read_text().strip().replace("{project}", str(project))


@pytest.mark.parametrize("name", NAMES)
def test_check_says_what_is_wrong(
    name: str, project: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """`graphflow check` gives one line for one mistake, and exit code 2."""
    monkeypatch.chdir(project)
    with pytest.raises(SystemExit) as end:
        main(["check", f"graphs/{name}.yaml"])
    out, err = capfd.readouterr()
    assert (out, err.splitlines()) == ("", [expected(name, project), "1 problem"])
    assert end.value.code == exits.USAGE
    assert not (project / "harm").exists()


@slow
@pytest.mark.real
@pytest.mark.parametrize("name", ["class_typo", "python_tag", "request_field"])
def test_up_starts_nothing(name: str, project: Path, machine: Machine) -> None:
    """`graphflow up` says the same, ends with code 2, and leaves neither a run directory nor logs."""
    text = machine.run("up", f"graphs/{name}.yaml", cwd=project, code=exits.USAGE)
    assert text.splitlines() == [expected(name, project), "1 problem; nothing was started"]
    assert [path for path in machine.run_directory.rglob("*") if not path.is_dir()] == []
    assert not Path(machine.env["XDG_STATE_HOME"]).exists()
    assert not (project / "harm").exists()


@slow
def test_several_mistakes_come_together(
    project: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """What several nodes and steps have wrong is told at once, in the order of the file."""
    monkeypatch.chdir(project)
    (project / "graphs/many.yaml").write_text(
        """\
nodes:
  /robot: {class: nodes.robot:Robot, params: {rte: 1, rate: 0}, remap: {cmd: /x}}
  /broken: {class: nodes.broken:Broken}
  /other: {class: nodes.robot:Roboter}
steps:
  hold: {call: /robot/hold, request: {data: 3, date: true}}
"""
    )
    with pytest.raises(SystemExit) as end:
        main(["check", "graphs/many.yaml"])
    lines = capfd.readouterr().err.splitlines()
    assert [":".join(line.split(":")[1:3]) for line in lines[:-1]] == [
        "2:52",
        "2:61",
        "2:73",
        "3:20",
        "4:19",
        "6:39",
        "6:48",
    ]
    assert lines[-1] == "7 problems"
    assert end.value.code == exits.USAGE


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["graphs/rign.yaml"], "error: graphs/rign.yaml: there is no such file; did you mean 'graphs/ring.yaml'?"),
        (
            ["graphs"],
            "error: graphs: no nodes, of graphflow or of rclpy; check its graph files one by one: ",
        ),
        (["graphs/key_typo.yaml", "rate"], "command line: 'rate': an argument is written name:=value"),
    ],
)
def test_a_wrong_command_line(
    words: list[str], message: str, project: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """A file that is not there, a folder, or a malformed argument is told with what was meant; exit code 2."""
    monkeypatch.chdir(project)
    with pytest.raises(SystemExit) as end:
        main(["check", *words])
    assert any(line.startswith(message) for line in capfd.readouterr().err.splitlines())
    assert end.value.code == exits.USAGE


@slow
def test_what_is_right_passes(
    project: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """The same project with a right file has no problem, so what is told above is due to the files."""
    monkeypatch.chdir(project)
    (project / "graphs/right.yaml").write_text(
        "nodes:\n  /robot: {class: nodes.robot:Robot, params: {rate: 2}, remap: {cmd_vel: /turtle1/cmd_vel}}\n"
        "steps:\n  hold: {call: /robot/hold, after: /robot, request: {data: true}}\n"
    )
    with pytest.raises(SystemExit) as end:
        main(["check", "graphs/right.yaml"])
    assert capfd.readouterr().out == "graphs/right.yaml: 1 node, 1 step, no problems\n"
    assert end.value.code == exits.OK
