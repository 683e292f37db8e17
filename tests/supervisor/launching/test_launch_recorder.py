"""Launch files in Python, run against stand-ins."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.cases import slow
from tests.conftest import PROGRAMS

pytestmark = pytest.mark.real
ROBOT = PROGRAMS / "launch" / "robot.launch.py"


def record(file: Path, **values: Any) -> Any:
    """Return the recorded actions and problems as lines; with values, as for a file that is to be started."""
    recorder = ["-m", "graphflow.rclpy", "-m", "graphflow.supervisor.launching.launch_recorder"]
    command = [sys.executable, "-P", *recorder, str(file)]
    command += [json.dumps(values)] if values else []
    ran = subprocess.run(command, capture_output=True, timeout=30, check=True)
    return json.loads(ran.stdout)


def line_of(text: str) -> int:
    return 1 + next(i for i, line in enumerate(ROBOT.read_text().splitlines()) if text in line)


@slow
def test_what_is_recorded() -> None:
    """Each action with its line and its arguments, substitutions as texts, and what others come after by its number."""
    told = record(ROBOT)
    actions = [next(iter(action.items())) for action in told["actions"]]
    names = "arg arg set_env node executable log executable group group timer include node node_container log"
    assert [name for name, _ in actions] == names.split()
    found = [attributes for _, attributes in actions]
    assert found[1] | {"line": 0} == {
        "line": 0,
        "name": "who",
        "description": "",
        "default": "leo",
        "choice": [{"value": "leo"}, {"value": "don"}],
    }
    assert (found[2]["name"], found[2]["value"]) == ("A", "$(env B c)")
    assert found[3] == {
        "line": line_of("sim = Node("),
        "number": 1,
        "on_exit": "shutdown",
        "name": "sim",
        "pkg": "turtlesim",
        "exec": "turtlesim_node",
        "remap": [{"from": "/turtle1/cmd_vel", "to": "/cmd_vel"}],
        "param": [
            {"name": "background_r", "value": 10},
            {"name": "name", "value": "5"},
            {"name": "gain", "value": "$(var speed 1.0)"},
            {"name": "list", "value": [1.0, 2.0]},
            {"name": "n", "param": [{"name": "a", "value": True}]},
            {"from": "$(find-pkg-share robot)/config/params.yaml"},
        ],
    }
    assert (found[4]["after_number"], found[4]["after_what"], found[4]["shell"]) == (1, "ready", "True")
    assert (found[6]["after_number"], found[6]["after_what"], found[6]["cmd"]) == (1, "exited", ["echo", "over"])
    push, talker = (next(iter(child.items())) for child in found[7]["children"])
    assert (push[0], push[1]["namespace"]) == ("push_ros_namespace", "robot1")
    assert (talker[1]["unless"], talker[1]["on_exit"]) == ("$(var quiet)", "shutdown")
    assert found[8]["if"] == """$(eval "'$(var who)' == 'leo'")"""
    assert found[8]["children"][0]["node"]["args"] == ["-d", "$(find-pkg-share robot)/rviz/a.rviz"]
    assert (found[9]["period"], found[9]["children"][0]["node"]["respawn"]) == (5.0, "True")
    assert found[10]["file"] == "$(find-pkg-share robot)/launch/b.launch.py"
    assert found[10]["arg"] == [{"name": "speed", "value": "$(var speed 1.0)"}]
    assert found[10]["if"] == "$(equals $(var who) don)"
    assert found[11]["name"] == "$(var who)"


@slow
def test_what_has_no_words() -> None:
    """Is told with its line, and so is what is left out."""
    told = record(ROBOT)
    [left_out] = told["remarks"]
    assert left_out["line"] == line_of("OnProcessIO(target")
    assert left_out["message"].startswith("OnProcessIO is left out")
    problems = {problem["line"]: problem["message"] for problem in told["problems"]}
    assert problems[line_of("OpaqueFunction(function")].startswith("OpaqueFunction: it was called once, with $(var")
    assert problems[line_of("SetROSLogDir(new_log_dir")].startswith("SetROSLogDir has no equivalent")
    assert len(problems) == 2


CONTAINER = """
from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode

def generate_launch_description():
    return LaunchDescription([
        ComposableNodeContainer(
            name="eyes", namespace="", package="rclcpp_components", executable="component_container",
            composable_node_descriptions=[ComposableNode(package="composition", plugin="composition::Talker")],
            respawn=True, parameters=[], output="screen",
        ),
    ])
"""


@slow
def test_what_a_container_cannot_be_given(tmp_path: Path) -> None:
    """Is left out, and said so; its nodes can be given it."""
    (tmp_path / "a.launch.py").write_text(CONTAINER)
    told = record(tmp_path / "a.launch.py")
    assert told["actions"][0]["node_container"]["composable_node"][0]["plugin"] == "composition::Talker"
    text = "respawn: left out, since a container is a process that nodes share; write it at the nodes"
    assert (told["problems"], told["remarks"]) == ([], [{"line": 8, "message": text}])


@slow
def test_the_line_of_a_value_that_cannot_be_made(tmp_path: Path) -> None:
    """It is that of the action, where the file itself is not being run any more."""
    (tmp_path / "a.launch.py").write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import SetLaunchConfiguration\n"
        "from launch.substitutions import EnvironmentVariable\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([\n"
        "        SetLaunchConfiguration('x', EnvironmentVariable('NOBODYS')),\n"
        "    ])\n"
    )
    [problem] = record(tmp_path / "a.launch.py", y="1")["problems"]
    assert problem["line"] == 6
    assert "the environment variable NOBODYS is not set" in problem["message"]


SMALL = """
import os
import launch
import launch_ros

def generate_launch_description():
    model = os.environ["NO_SUCH_MODEL"]
    share = launch_ros.substitutions.FindPackageShare("robot").find("robot")
    program = launch_ros.substitutions.ExecutableInPackage(package="tools", executable="look")
    return launch.LaunchDescription([
        launch.actions.ExecuteProcess(cmd=[program, "-x"]),
        launch.actions.ExecuteProcess(cmd=["cat", os.path.join(share, f"{model}.urdf")]),
        launch.actions.AppendEnvironmentVariable("P", share),
        launch.actions.ExecuteProcess(cmd=[
            launch.substitutions.Command(["xacro ", share, "/a b.xacro"]),
            launch.substitutions.Command("x", on_stderr="warn"),
            launch.substitutions.ThisLaunchFile(),
            launch.substitutions.LaunchLogDir(),
            launch.substitutions.IfElseSubstitution("true", "a b", "c"),
            launch.substitutions.AnySubstitution("true", launch.substitutions.LaunchConfiguration("x")),
            launch_ros.substitutions.FindPackagePrefix("robot"),
            launch_ros.substitutions.ExecutableInPackage("look", "tools"),
            launch_ros.substitutions.Parameter("rate"),
        ]),
    ])
"""


@slow
def test_other_ways_of_saying_it(tmp_path: Path) -> None:
    """Submodules that were not imported, variables that are not set, a package's folder found by hand."""
    (tmp_path / "a.launch.py").write_text(SMALL)
    told = record(tmp_path / "a.launch.py")
    assert told["problems"] == []
    look, cat, append, many = told["actions"]
    assert look["node"] == {"line": 11, "pkg": "tools", "exec": "look", "args": ["-x"]}
    assert cat["executable"]["cmd"] == ["cat", "$(find-pkg-share robot)/$(env NO_SUCH_MODEL).urdf"]
    assert append["append_env"]["value"] == "$(find-pkg-share robot)"
    assert many["executable"]["cmd"] == [
        "$(command 'xacro $(find-pkg-share robot)/a b.xacro')",
        "$(command x warn)",
        "$(filename)",
        "$(log_dir)",
        "$(if true 'a b' c)",
        "$(any true $(var x))",
        "$(find-pkg-prefix robot)",
        "$(exec-in-pkg look tools)",
        "$(param rate)",
    ]


@slow
@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("import launch\n\nx = 1 / 0\n", 3, "ZeroDivisionError: division by zero"),
        ("def f(:\n", 1, "SyntaxError: invalid syntax"),
        ("x = 1\n", 1, "NameError: it has no function generate_launch_description()"),
        ("x = 1\nif __name__ == '__main__':\n    x / 0\n", 1, "NameError: it has no function"),
        ("x = 1\nraise SystemExit('no robot')\n", 2, "SystemExit: no robot"),
        ("import numpyy\n", 1, "ModuleNotFoundError: No module named 'numpyy'; if it is on PyPI: pip"),
        ("def generate_launch_description():\n    open('/nowhere/x')\n", 2, "FileNotFoundError: [Errno 2]"),
        (
            "def generate_launch_description():\n    return 3\n",
            2,
            "TypeError: generate_launch_description() returned 3",
        ),
        (
            "def generate_launch_description():\n    return []\n",
            2,
            "TypeError: generate_launch_description() returned a list, and not a LaunchDescription; write Launch",
        ),
        (
            "def generate_launch_description():\n    3\n",
            2,
            "TypeError: generate_launch_description() returned None, and",
        ),
        (
            "def generate_launch_desription(): ...\n",
            1,
            "NameError: it has no function generate_launch_description(); rename generate_launch_desription in line 1",
        ),
        (
            "import launch\ndef f():\n    reading = 1\n    return reeding\nf()\n",
            4,
            "NameError: name 'reeding' is not defined; did you mean 'reading'?",
        ),
        (
            "from launch import LaunchDescription\nLaunchDescripton([])\n",
            2,
            "NameError: name 'LaunchDescripton' is not defined; did you mean 'LaunchDescription'?",
        ),
        (
            "import os\nfrom launch.substitutions import *\nos.path.join('a', LaunchConfiguration('x'))\n",
            3,
            "TypeError: join() argument must be str, bytes, or os.PathLike object, not 'LaunchConfiguration'; write "
            "PathJoinSubstitution([..., LaunchConfiguration(...)])",
        ),
        (
            "from launch import LaunchDescription\nfrom launch_ros import Node\n",
            2,
            "ImportError: launch_ros has no Node; write: from launch_ros.actions import Node",
        ),
        (
            "TimerActon()\n",
            1,
            "NameError: name 'TimerActon' is not defined; did you mean 'TimerAction'? Write from launch.",
        ),
        (
            "import launch\n\ndef generate_launch_description():\n    return launch.LaunchDescripton([])\n",
            4,
            "LaunchDescripton has no equivalent in a graph file; did you mean 'LaunchDescription'?",
        ),
        ("qqqq\n", 1, "NameError: name 'qqqq' is not defined"),
        ("Node()\n", 1, "NameError: name 'Node' is not defined; write from launch_ros.actions import Node"),
        (
            "import launch\ndef generate_launch_description():\n    ld = launch.LaunchDescription()\n"
            "    ld.add_action\n    return ld\n",
            4,
            "add_action is not called: put its argument in parentheses after it",
        ),
        (
            "import launch\ndef generate_launch_description():\n"
            "    return launch.LaunchDescription(launch.actions.LogInfo(msg='x'))\n",
            3,
            "TypeError: LaunchDescription takes a list: write [ ] around LogInfo(...)",
        ),
        (
            "import launch\ndef generate_launch_description():\n    a = launch.actions.LogInfo(msg='x')\n"
            "    return launch.LaunchDescription(a, launch.actions.GroupAction([a]))\n",
            4,
            "TypeError: LaunchDescription takes a list: write [ ] around LogInfo(...), GroupAction(...)",
        ),
        (
            "import launch\ndef generate_launch_description():\n"
            "    return launch.LaunchDescription([launch.actions.ExecuteProcess(cmd='a b')])\n",
            3,
            "cmd: expected a list of words, such as ['a', 'b'], got 'a b'",
        ),
    ],
)
def test_files_that_fail(tmp_path: Path, text: str, line: int, message: str) -> None:
    """The error is told with the line of the file."""
    (tmp_path / "a.launch.py").write_text(text)
    (problem,) = record(tmp_path / "a.launch.py")["problems"]
    assert problem["line"] == line
    assert problem["message"].startswith(message)


@slow
@pytest.mark.parametrize("mark", [b"\xef\xbb\xbf", b"# coding: latin-1\n# \xe4\n"])
def test_an_encoding(tmp_path: Path, mark: bytes) -> None:
    """It is the one that Python would read the file with."""
    file = tmp_path / "launch.py"
    file.write_bytes(
        mark + b"import launch\ndef generate_launch_description():\n    return launch.LaunchDescription([])\n"
    )
    assert record(file)["problems"] == []


@slow
def test_a_description_of_nothing(tmp_path: Path) -> None:
    """It is let pass, and told."""
    (tmp_path / "a.launch.py").write_text("import launch\ngenerate_launch_description = launch.LaunchDescription\n")
    told = record(tmp_path / "a.launch.py")
    assert (told["problems"], told["actions"]) == ([], [])
    assert [remark["message"] for remark in told["remarks"]] == ["the launch description has no actions"]


STARTED = """
import os
from ament_index_python.packages import get_package_share_directory, get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare
from robot.parts import wheels

who, far = LaunchConfiguration("who"), LaunchConfiguration("far")

def several(context, what):
    made = [Node(package="p", executable=what, name=f"{who.perform(context)}{i}") for i in range(wheels)]
    if IfCondition(far).evaluate(context):
        path = PathJoinSubstitution([FindPackageShare("robot"), who])
        made.append(Node(package="p", executable=path.perform(context)))
    return [*made, Node(package="p", executable=context.launch_configurations["where"])]

def generate_launch_description():
    share = get_package_share_directory("robot")
    with open(os.path.join(share, "urdf", "robot.urdf")) as file:
        urdf = file.read()
    same = (get_package_share_path("robot") / "urdf" / "robot.urdf").read_text() == urdf
    return LaunchDescription([
        DeclareLaunchArgument("who", default_value="leo"),
        DeclareLaunchArgument("where", default_value=["at_", who]),
        OpaqueFunction(function=several, args=["drive"]),
        Node(package="p", executable="e", parameters=[{"urdf": urdf, "ok": same}]),
    ])
"""


MISSING = """
from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from launch import LaunchDescription
from launch.actions import LogInfo

def generate_launch_description():
    try:
        folder = get_package_share_directory("elsewhere")
    except PackageNotFoundError as error:
        folder = f"none: {error}"
    return LaunchDescription([LogInfo(msg=folder), *ELSE])
"""


@slow
def test_a_package_that_is_not_there(tmp_path: Path) -> None:
    """Is an error that a file may catch when it is started; the file is written down with a substitution."""
    file = tmp_path / "a.launch.py"
    file.write_text(MISSING.replace(", *ELSE", ""))
    said = "package 'elsewhere' not found; it is neither in the workspace nor installed"
    assert record(file)["actions"][0]["log"]["message"] == "$(find-pkg-share elsewhere)"
    assert record(file, x=1)["actions"][0]["log"]["message"] == f"none: {said}"
    file.write_text(MISSING.replace("*ELSE", "get_package_share_directory('nowhere')"))
    [problem] = record(file, x=1)["problems"]
    assert problem["message"] == f"PackageNotFoundError: {said.replace('elsewhere', 'nowhere')}"


SET = """
from launch import LaunchDescription
from launch.actions import (AppendEnvironmentVariable, GroupAction, LogInfo, OpaqueFunction, SetEnvironmentVariable,
    SetLaunchConfiguration)
from launch.conditions import IfCondition
from launch.substitutions import EnvironmentVariable, LaunchConfiguration

def tell(context, word):
    asked = [EnvironmentVariable("A"), LaunchConfiguration("c", default="")]
    told = [one.perform(context) for one in asked]
    context.launch_configurations["d"] = word
    return [LogInfo(msg=[*told, context.launch_configurations["d"], context.environment.get("A", "")])]

def generate_launch_description():
    return LaunchDescription([
        SetEnvironmentVariable("A", "7"),
        GroupAction([AppendEnvironmentVariable("A", "8"), SetLaunchConfiguration("c", "C"),
            OpaqueFunction(function=tell, args=["in"])]),
        SetLaunchConfiguration("c", "never", condition=IfCondition("false")),
        OpaqueFunction(function=tell, args=["out"]),
    ])
"""


@slow
def test_what_is_set_is_known_to_functions(tmp_path: Path) -> None:
    """In the order of the file and within groups; what a function sets holds for what comes after it."""
    file = tmp_path / "a.launch.py"
    file.write_text(SET)
    told = record(file, far=True)
    assert told["problems"] == []
    _, group, _, changed, last = told["actions"]
    assert [next(iter(child)) for child in group["group"]["children"]] == ["append_env", "let", "let", "log"]
    assert group["group"]["children"][-1]["log"]["message"] == "7:8Cin7:8"
    assert (changed["let"]["name"], changed["let"]["value"]) == ("d", "out")
    assert last["log"]["message"] == "7out7"


@slow
def test_a_file_that_is_about_to_be_started(tmp_path: Path) -> None:
    """Its packages are where they are, it may import from them, and its functions are told what they ask for."""
    robot = tmp_path / "src" / "robot"
    for folder in ("robot", "urdf", "launch"):
        (robot / folder).mkdir(parents=True)
    (robot / "package.xml").write_text("<package><name>robot</name></package>")
    (robot / "robot" / "parts.py").write_text("wheels = 2\n")
    (robot / "urdf" / "robot.urdf").write_text("<robot/>")
    file = robot / "launch" / "a.launch.py"
    file.write_text(STARTED)
    told = record(file, far=True, who="don")
    assert told["problems"] == []
    nodes = [action["node"] for action in told["actions"] if "node" in action]
    assert [node.get("name", node["exec"]) for node in nodes] == ["don0", "don1", f"{robot}/don", "at_don", "e"]
    assert [param["value"] for param in nodes[-1]["param"]] == ["<robot/>", True]
    (problem,) = record(file, who="don")["problems"]
    assert (problem["line"], problem["message"].startswith("SubstitutionError: there is no argument 'far'")) == (
        16,
        True,
    )


LIFE = """\
import launch.events
import launch_ros.events.lifecycle
import lifecycle_msgs.msg
from launch import LaunchDescription
from launch.actions import EmitEvent
from launch_ros.actions import LifecycleNode

def generate_launch_description():
    node = LifecycleNode(package="p", executable="e", name="n", namespace="")
    event = launch_ros.events.lifecycle.ChangeState(
        lifecycle_node_matcher=launch.events.matches_action(node),
        transition_id=lifecycle_msgs.msg.Transition.TRANSITION_CONFIGURE,
    )
    return LaunchDescription([node, EmitEvent(event=event)])
"""


@slow
def test_constants_of_messages(tmp_path: Path) -> None:
    """They are what they are, as where an event brings a lifecycle node up."""
    file = tmp_path / "a.launch.py"
    file.write_text(LIFE)
    told = record(file)
    assert told["problems"] == []
    assert [action["node"]["brought_to"] for action in told["actions"]] == ["inactive"]


LATE = """
import launch.logging
from launch import LaunchDescription, Substitution
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, OpaqueFunction, RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch_ros.actions import Node

argument = DeclareLaunchArgument("word", default_value="none")
launch.logging.get_logger("mine").info("made")


class Shouted(Substitution):
    def __init__(self, word):
        super().__init__()
        self.word = word

    def perform(self, context):
        return f"{self.word}!"


def never(*_):
    raise RuntimeError


def generate_launch_description():
    whole = LaunchDescription([argument])

    def add(context):
        sleeping = ExecuteProcess(cmd=["sleep", "1"])
        then = [OpaqueFunction(function=never), LogInfo(msg=["slept ", Shouted(argument.default_value)])]
        whole.add_action(RegisterEventHandler(OnProcessExit(target_action=sleeping, on_exit=then)))
        whole.add_action(RegisterEventHandler(OnProcessExit(target_action=sleeping, on_exit=never)))
        whole.add_action(RegisterEventHandler(OnProcessExit(on_exit=[LogInfo(msg="any")])))
        return [sleeping]

    whole.add_action(OpaqueFunction(function=add))
    whole.add_action(Node(package="p", executable="e", parameters=[{"small": "1e-3", "text": "1.0", "word": "x"}]))
    return whole
"""


@slow
def test_what_is_added_while_a_file_is_carried_out(tmp_path: Path) -> None:
    """Counts; functions that would be called later are left out, and the file's own substitutions are made."""
    (tmp_path / "a.launch.py").write_text(LATE)
    told = record(tmp_path / "a.launch.py", word="given")
    assert told["problems"] == []
    actions = [next(iter(action.items())) for action in told["actions"]]
    assert [name for name, _ in actions] == ["arg", "executable", "node", "log"]
    assert actions[3][1]["message"] == "slept none!"
    assert (actions[3][1]["after_number"], actions[3][1]["after_what"]) == (actions[1][1]["number"], "exited")
    left_out = ["a function", "a function", "what it does for every process"]
    said = [f"OnProcessExit: {what} is left out: nothing is called while the graph runs" for what in left_out]
    assert [remark["message"] for remark in told["remarks"]] == said
    # ROS writes parameters to a file, unquoted where YAML 1.1 needs no quotes, and reads them by rules of its own.
    assert [type(param["value"]) for param in actions[2][1]["param"]] == [float, str, str]


ENVIRONMENT = """
import os
import subprocess
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *

def generate_launch_description():
    os.environ["MADE"] = "here"
    try:
        found = os.environ["NO_SUCH_VARIABLE"]
    except KeyError:
        found = "none"
    said = subprocess.run(["sh", "-c", "echo $MADE; command -v ros2"], capture_output=True, text=True).stdout.split()
    return LaunchDescription([ExecuteProcess(cmd=["echo", found, said[0], os.path.basename(said[1])])])
"""


def test_the_environment_of_a_file_that_is_started(tmp_path: Path) -> None:
    """Is the real one: what it sets is had by its processes, and it may start programs, `ros2` among them."""
    (tmp_path / "a.launch.py").write_text(ENVIRONMENT)
    told = record(tmp_path / "a.launch.py", x="1")
    assert told["problems"] == []
    first, second = told["actions"]
    assert (first["set_env"]["name"], first["set_env"]["value"]) == ("MADE", "here")
    assert second["executable"]["cmd"] == ["echo", "none", "here", "ros2"]


def described(folder: Path, body: str, **values: str) -> tuple[list[str], list[str]]:
    """The problems and the remarks of a function, each with its line in it."""
    head = ["from launch import *", "from launch.actions import *", "from launch.conditions import *"]
    head += ["from launch.substitutions import *", "from launch_ros.actions import Node"]
    head += ["x = LaunchConfiguration('x')", "def generate_launch_description():"]
    file = folder / "a.launch.py"
    file.write_text("\n".join(head + [f"    {line}" for line in body.splitlines()]))
    told = record(file, **values)
    lines = [[f"{t['line'] - len(head)}: {t['message']}" for t in told[what]] for what in ("problems", "remarks")]
    return lines[0], lines[1]


@slow
@pytest.mark.parametrize("code", ["int(x)", "float(str(x))", "range(x)", "x > 3", "x.lower()", "list(x)", "x[0]"])
def test_values_before_the_launch(tmp_path: Path, code: str) -> None:
    """Code that takes a substitution for its value fails with the way to the value."""
    [problem], _ = described(tmp_path, f"return LaunchDescription([Node(name={code})])")
    assert problem.endswith(
        " has no value before the launch: write OpaqueFunction(function=setup), with def setup(context): and "
        ".perform(context) in it"
    )


@slow
def test_rclpys_node_in_a_launch_file(tmp_path: Path) -> None:
    """The problem names the import of launch's."""
    body = "from rclpy.node import Node as N\nreturn LaunchDescription([N(package='a', executable='b')])"
    [problem], _ = described(tmp_path, body)
    assert problem.endswith("'package'; this Node is rclpy's: write from launch_ros.actions import Node")


@slow
def test_a_path_whose_parts_are_no_list(tmp_path: Path) -> None:
    """It is one problem, with the brackets to write."""
    body = "return LaunchDescription([Node(package='a', executable='b', name=PathJoinSubstitution(x, 'a', 'b'))])"
    [problem], _ = described(tmp_path, body)
    assert problem == "1: PathJoinSubstitution takes a list: write [ ] around LaunchConfiguration(...), 'a', 'b'"


@slow
def test_a_package_that_is_misspelt(tmp_path: Path) -> None:
    """The problem names the nearest of the workspace."""
    (tmp_path / "src" / "turret").mkdir(parents=True)
    (tmp_path / "src" / "turret" / "package.xml").write_text("<package><name>turret</name></package>")
    body = "from ament_index_python.packages import get_package_share_directory as share\nshare('turet')"
    [problem], _ = described(tmp_path, body, x="1")
    assert problem.endswith("package 'turet' not found; did you mean 'turret'?")


@slow
def test_conditions_that_are_compared(tmp_path: Path) -> None:
    """The problem says what to write, and nothing is said twice."""
    problems, remarks = described(
        tmp_path, "return LaunchDescription([LogInfo(msg='a', condition=IfCondition(x == 'a'))])"
    )
    assert problems == [
        "1: x == 'a' is decided before the launch has values: "
        "write IfCondition(EqualsSubstitution(LaunchConfiguration('x'), 'a'))"
    ]
    assert remarks == []


@slow
def test_arguments_in_no_description(tmp_path: Path) -> None:
    """One that is asked for is a problem, unless it is given all the same; others are told of."""
    node = "return LaunchDescription([Node(package='demo_nodes_py', executable='talker', name=x)])"
    text = "1: a is in no description: write LaunchDescription([..., a])"
    assert described(tmp_path, f"a = DeclareLaunchArgument('x', default_value='1')\n{node}") == ([text], [])
    assert described(tmp_path, f"a = DeclareLaunchArgument('x')\n{node}", x="1") == ([], [text])
    assert described(tmp_path, f"a = DeclareLaunchArgument('y')\n{node}") == ([], [text])


@slow
def test_an_argument_that_is_declared_late(tmp_path: Path) -> None:
    """Told at the action that uses it, as ROS 2 would fail there; not when a value is set for it."""
    file = tmp_path / "late.launch.py"
    file.write_text(
        "from launch import LaunchDescription\n"
        "from launch.actions import DeclareLaunchArgument, LogInfo\n"
        "from launch.substitutions import LaunchConfiguration\n\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([\n"
        "        DeclareLaunchArgument('a', default_value='1'),\n"
        "        LogInfo(msg=[LaunchConfiguration('a'), LaunchConfiguration('b')]),\n"
        "        DeclareLaunchArgument('b', default_value='2'),\n"
        "    ])\n"
    )
    text = "'b' is used here and declared only in line 9, and ROS 2 then has no value for it; "
    assert record(file)["remarks"] == [{"line": 8, "message": f"{text}put its DeclareLaunchArgument before this"}]
    assert record(file, b="3")["remarks"] == []


@slow
def test_a_target_that_never_starts(tmp_path: Path) -> None:
    """An action that only an event handler names is in no description."""
    file = tmp_path / "target.launch.py"
    text = """
from launch import LaunchDescription
from launch.actions import LogInfo, RegisterEventHandler
from launch.event_handlers import OnProcessStart
from launch_ros.actions import Node

def generate_launch_description():
    node = Node(package="p", executable="e")
    handler = RegisterEventHandler(OnProcessStart(target_action=node, on_start=[LogInfo(msg="up")]))
    return LaunchDescription([{}handler])
"""
    file.write_text(text.format(""))
    message = (
        "the target of OnProcessStart is in no description, and never starts: name it, as in node = Node(...), and "
    )
    assert [r["message"] for r in record(file)["remarks"]] == [f"{message}put node into LaunchDescription([...]), too"]
    file.write_text(text.format("node, "))
    assert record(file)["remarks"] == []
