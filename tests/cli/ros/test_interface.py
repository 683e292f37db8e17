"""`interface show`: definitions with the fields of nested types below each."""

from __future__ import annotations

import io
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner

from graphflow.cli import exits
from graphflow.cli.main import cli, main
from graphflow.msgs import registry
from tests.cases import slow

Show = Callable[..., tuple[int, str, str]]


@pytest.fixture
def show(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Show:
    monkeypatch.setattr(registry, "_roots", list(registry._roots))

    def show(*words: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as end:
            main(["interface", "show", *words])
        assert isinstance(end.value.code, int)
        return (end.value.code, *capsys.readouterr())

    return show


@pytest.mark.parametrize("name", ["geometry_msgs/msg/Twist", "geometry_msgs/Twist", "geometry_msgs.msg.Twist"])
def test_a_message(name: str, show: Show) -> None:
    """Nested fields are indented by a tab; the type may be written in each of ROS's ways."""
    assert show(name) == (
        exits.OK,
        "Vector3  linear\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n"
        "Vector3  angular\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n",
        "",
    )


def test_types_within_types(show: Show) -> None:
    """Each level is one tab further in."""
    code, out, _ = show("geometry_msgs/msg/PoseStamped")
    lines = out.splitlines()
    assert code == exits.OK
    assert "\tbuiltin_interfaces/Time stamp" in lines
    assert "\t\tint32 sec" in lines
    assert "\t\tfloat64 w 1" in [line.removesuffix(".0") for line in lines]


def test_a_service(show: Show) -> None:
    """Request and response are apart."""
    assert show("turtlesim/srv/Spawn")[1] == "float32 x\nfloat32 y\nfloat32 theta\nstring name\n---\nstring name\n"


def test_an_action(show: Show) -> None:
    """Goal, result and feedback are apart."""
    found = show("turtlesim/action/RotateAbsolute")[1]
    assert found == "float32 theta\n---\nfloat32 delta\n---\nfloat32 remaining\n"


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project with an interface of its own, and a working directory inside it."""
    for name in ("nodes", "interfaces/show_msgs/msg"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "interfaces/show_msgs/msg/Leg.msg").write_text(
        "# A leg of the way.\n\nuint8 WALK=1  # slow\ngeometry_msgs/Point[2] ends  # both\n\nuint8 how 1\n"
    )
    monkeypatch.chdir(tmp_path / "nodes")
    return tmp_path


def test_the_projects_own_with_its_comments(own: Path, show: Show) -> None:
    """Definitions of the project around are found, and shown as they are written."""
    assert show("show_msgs/msg/Leg")[1] == (
        "# A leg of the way.\n\nuint8 WALK=1  # slow\ngeometry_msgs/Point[2] ends  # both\n"
        "\tfloat64 x\n\tfloat64 y\n\tfloat64 z\n\nuint8 how 1\n"
    )


def test_without_comments(own: Path, show: Show) -> None:
    """`--no-comments` leaves the definition alone, as it leaves out empty lines."""
    assert show("show_msgs/msg/Leg", "--no-comments")[1] == (
        "uint8 WALK=1\ngeometry_msgs/Point[2] ends\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z\nuint8 how 1\n"
    )


@slow
@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("geometry_msgs/msg/Twst", "error: package 'geometry_msgs' has no interface 'Twst'; did you mean 'Twist'?"),
        (
            "geometry_msg/msg/Twist",
            "error: there is no interface package 'geometry_msg'; did you mean 'geometry_msgs'?",
        ),
        ("std_msgs/Heder", "error: package 'std_msgs' has no interface 'Heder'; did you mean 'Header'?"),
        ("Twist", "error: 'Twist' is not an interface name; did you mean 'geometry_msgs/msg/Twist'?"),
        ("std_msgs", "error: std_msgs is a package: graphflow interface package std_msgs lists its types"),
        *(
            (word, "error: linear of geometry_msgs/msg/Twist is geometry_msgs/msg/Vector3: graphflow interface show ")
            for word in ("Twist.linear", "geometry_msgs/msg/Twist.linear", "geometry_msgs/Twist/linear")
        ),
        (
            "Twist.linear.x",
            "error: linear.x of geometry_msgs/msg/Twist is float64; whole type: graphflow interface show ",
        ),
        ("Twist.zzz", "error: there is no interface package 'Twist'"),
        ("a/b/c/d", "error: 'a/b/c/d' is not an interface name; write package/msg/Name"),
        ("../msg/Name", "error: '../msg/Name' is not an interface name"),
    ],
)
def test_an_unknown_type(name: str, message: str, show: Show) -> None:
    """For a misspelt type the nearest is suggested, with exit code 2."""
    code, out, err = show(name)
    assert (code, out) == (exits.USAGE, "")
    assert err.startswith(message)


def test_a_type_in_two_words(capsys: pytest.CaptureFixture[str]) -> None:
    """A type in two words is corrected to one."""
    for words, told in (
        (["geometry_msgs", "Twist"], "a type is one word: graphflow interface show geometry_msgs/msg/Twist"),
        (["a", "b"], "Got unexpected extra argument (b)"),
    ):
        with pytest.raises(SystemExit):
            main(["interface", "show", *words])
        assert told in capsys.readouterr().err


@pytest.fixture
def mylab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, show: Show) -> Path:
    """A new project, and in its folder."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit):
        main(["init", "mylab"])
    monkeypatch.chdir(tmp_path / "mylab")
    return tmp_path / "mylab"


def stubs(*words: str) -> int:
    with pytest.raises(SystemExit) as end:
        main(["interface", "stubs", *words])
    assert isinstance(end.value.code, int)
    return end.value.code


def test_stubs_of_a_project(mylab: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Stubs are written where editors find them, match the definitions, and do not touch other packages'."""
    definition = mylab / "interfaces/mylab_interfaces/msg/Greeting.msg"
    definition.write_text(definition.read_text() + "float64[] pitch\n")
    capsys.readouterr()
    assert stubs() == exits.OK
    assert capsys.readouterr().out == "typings/graphflow/msgs/mylab_interfaces/msg/__init__.pyi\n"
    text = (mylab / "typings/graphflow/msgs/mylab_interfaces/msg/__init__.pyi").read_text()
    assert "class Greeting(base.Message):" in text
    assert "    pitch: npt.NDArray[np.float64]" in text
    assert [f.name for f in (mylab / "typings/graphflow/msgs").iterdir()] == ["mylab_interfaces"]


def test_stubs_of_a_workspace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Stubs are in the workspace, under the names that ROS's code imports."""
    monkeypatch.setattr(registry, "_packages", {})
    package = tmp_path / "src" / "lamp_interfaces"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>lamp_interfaces</name></package>")
    (package / "msg" / "Light.msg").write_text("geometry_msgs/Point[] at\nint32 level\n")
    monkeypatch.chdir(package)
    assert stubs() == exits.OK
    file = tmp_path / "typings" / "lamp_interfaces" / "msg" / "__init__.pyi"
    assert str(file) in capsys.readouterr().out
    assert "    def at(self) -> list[geometry_msgs.msg.Point]: ...\n" in file.read_text()


def test_stubs_where_there_is_nothing_to_describe(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], show: Show
) -> None:
    """The error says what is missing, and where."""
    monkeypatch.chdir(tmp_path)
    assert stubs() == exits.USAGE
    assert f"{tmp_path / 'interfaces'} has no PACKAGE/msg" in capsys.readouterr().err


@slow
@pytest.mark.real
@pytest.mark.timeout(300)
def test_a_type_checker_finds_the_stubs(mylab: Path) -> None:
    """mypy finds a misspelt field of the project's own message, and nothing else to complain about."""
    assert stubs() == exits.OK
    wrong = mylab / "mylab" / "wrong.py"
    wrong.write_text("from graphflow.msgs.mylab_interfaces.msg import Greeting\n\nGreeting(text='x', cuont=1)\n")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "mylab"], capture_output=True, text=True, timeout=290, check=False
    )
    assert done.stdout.splitlines()[0].startswith("mylab/wrong.py:3: error: Unexpected keyword argument"), done.stdout
    assert "Found 1 error" in done.stdout


@slow
def test_types_are_listed(mylab: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Types are listed by kind and by package, including the project's own."""
    runner = CliRunner()
    listed = runner.invoke(cli, ["interface", "list"]).output.splitlines()
    assert [line for line in listed if line.endswith(":")] == ["Messages:", "Services:", "Actions:"]
    assert "    mylab_interfaces/msg/Greeting" in listed
    assert "    example_interfaces/action/Fibonacci" in listed
    only = runner.invoke(cli, ["interface", "list", "-a"]).output.splitlines()
    assert only[0] == "Actions:"
    assert all("/action/" in line for line in only[1:])
    assert "mylab_interfaces/msg/Greeting" in runner.invoke(cli, ["interface", "package", "mylab_interfaces"]).output
    assert "std_srvs" in runner.invoke(cli, ["interface", "packages"]).output.splitlines()
    wrong = runner.invoke(cli, ["interface", "package", "std_srv"])
    assert "did you mean 'std_srvs'?" in str(wrong.exception)


def looked(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    with pytest.raises(SystemExit) as end:
        main(["interface", *words])
    assert end.value.code == exits.OK
    return capsys.readouterr().out


def test_proto(capsys: pytest.CaptureFixture[str]) -> None:
    """`proto` prints a quoted message, as ROS 2 does; a service's request; an action's goal."""
    point = "x: 0.0\ny: 0.0\nz: 0.0\n"
    assert looked(capsys, "proto", "geometry_msgs/msg/Point") == f'"{point}"\n'
    assert looked(capsys, "proto", "geometry_msgs/Point", "--no-quotes") == point
    assert looked(capsys, "proto", "example_interfaces/srv/AddTwoInts", "--no-quotes") == "a: 0\nb: 0\n"
    assert looked(capsys, "proto", "example_interfaces/action/Fibonacci", "--no-quotes") == "order: 0\n"


@slow
def test_the_slides_words(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """`info` for `show`; `package` without one; a type from standard input."""
    assert looked(capsys, "info", "std_msgs/Header") == looked(capsys, "show", "std_msgs/msg/Header")
    assert "geometry_msgs\n" in looked(capsys, "package")
    monkeypatch.setattr(sys, "stdin", io.StringIO("std_msgs/msg/String\n"))
    assert looked(capsys, "show", "-") == "string data\n"


def test_kinds(capsys: pytest.CaptureFixture[str]) -> None:
    """Only packages, or only types, of one kind."""
    assert "std_msgs\n" not in looked(capsys, "packages", "--only-srvs")
    assert "std_srvs\n" in looked(capsys, "packages", "-s")
    assert looked(capsys, "package", "turtlesim", "-a") == "turtlesim/action/RotateAbsolute\n"


def test_comments(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`--all-comments` shows comments of nested types, too."""
    folder = tmp_path / "interfaces" / "commented_msgs" / "msg"
    folder.mkdir(parents=True)
    (tmp_path / "pyproject.toml").touch()
    (folder / "Outer.msg").write_text("# outer\nInner inner\n")
    (folder / "Inner.msg").write_text("# inner\n\nint32 x # why\nstring y '#' # what\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(registry, "_roots", list(registry._roots))
    words = ("show", "commented_msgs/msg/Outer")
    nested = "\t# inner\n\n\tint32 x # why\n\tstring y '#' # what\n"
    assert looked(capsys, *words, "--all-comments") == f"# outer\nInner inner\n{nested}"
    assert looked(capsys, *words) == "# outer\nInner inner\n\tint32 x\n\tstring y '#'\n"
    assert looked(capsys, *words, "--no-comments") == "Inner inner\n\tint32 x\n\tstring y '#'\n"
