"""Stand-ins for ROS's launch packages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import Context, RecordedCall, StandIns, plain, stand_in_of, text
from graphflow.markup.substitutions import SubstitutionError


@pytest.fixture(autouse=True)
def nothing_is_known() -> Iterator[None]:
    """What a file is about to be started with is forgotten."""
    yield
    RECORDING.values, RECORDING.defaults, RECORDING.needed = None, {}, set()


def said(name: str, /, *args: object, **kwargs: object) -> RecordedCall:
    made: RecordedCall = type(name, (RecordedCall,), {"kind": name})(*args, **kwargs)
    return made


def test_substitutions_are_texts() -> None:
    """Also where they are put together in a list."""
    x = said("LaunchConfiguration", "x")
    assert text(["a", x, 3]) == "a$(var x)3"
    assert text(said("LaunchConfiguration", "x", default="a b")) == "$(var x 'a b')"
    assert text(said("PathJoinSubstitution", [said("FindPackageShare", "p"), "a/", x])) == (
        "$(find-pkg-share p)/a/$(var x)"
    )
    assert [plain(value) for value in (3, [1.5, True], [x], x)] == [3, [1.5, True], "$(var x)", "$(var x)"]
    assert plain([["a", x], ["b"], x]) == ["a$(var x)", "b", "$(var x)"]


def test_substitutions_are_no_texts_before_the_launch(monkeypatch: pytest.MonkeyPatch) -> None:
    """Adding one is an error, as in ROS; an f-string would have its address there, which is told."""
    monkeypatch.setattr(RECORDING, "remarks", [])
    x = stand_in_of("LaunchConfiguration")("x")
    with pytest.raises(TypeError, match=r"and has no \+; write a list: \['a', LaunchConfiguration\(\.\.\.\)\]$"):
        "a" + x
    with pytest.raises(TypeError, match=r"write a list: \[LaunchConfiguration\(\.\.\.\), 'b'\]$"):
        x + "b"
    with pytest.raises(TypeError, match="not 'LaunchConfiguration'"):
        os.path.join("a", x)
    assert f"{x:>9}" == " $(var x)"
    [remark] = RECORDING.remarks
    assert remark["message"] == "LaunchConfiguration in an f-string is an object to ROS 2; write a list: ['text', ...]"


def test_paths_are_joined() -> None:
    """By a slash as well; a part that is absolute begins anew, as in ROS."""
    share, x = said("PathSubstitution", said("FindPackageShare", "p")), said("LaunchConfiguration", "x")
    assert text(share / "a" / ["b_", x] / "c.yaml") == "$(find-pkg-share p)/a/b_$(var x)/c.yaml"
    assert text("home" / said("PathJoinSubstitution", [x, "a"])) == "home/$(var x)/a"
    assert text(said("PathJoinSubstitution", [x, "/etc", "a"])) == "/etc/a"


def test_values_are_known_when_a_file_is_started() -> None:
    """What is given, then defaults; otherwise texts stay as they are."""
    x, y = said("LaunchConfiguration", "x"), said("LaunchConfiguration", "y")
    said("DeclareLaunchArgument", "x", default_value="3")
    said("DeclareLaunchArgument", "y", default_value=["y of ", x])
    assert x.perform(Context()) == "$(var x)"
    RECORDING.values = {}
    assert (x.perform(Context()), y.perform(Context())) == ("3", "y of 3")
    RECORDING.values = {"x": "4"}
    assert Context().launch_configurations == {"x": "4", "y": "y of 4"}
    assert Context().perform_substitution(["", y]) == "y of 4"
    assert said("IfCondition", said("PythonExpression", [x, " > 3"])).evaluate(Context())
    assert not said("UnlessCondition", "true").evaluate(Context())
    assert said("LaunchConfigurationEquals", "x", "4").evaluate(Context())
    said("DeclareLaunchArgument", "w")
    with pytest.raises(SubstitutionError, match="'w' has no default; give w:=VALUE"):
        said("LaunchConfiguration", "w").perform(Context())
    with pytest.raises(SubstitutionError, match="there is no argument 'z'"):
        said("LaunchConfiguration", "z").perform(Context())


def test_classes_are_derived_as_in_ros() -> None:
    """For helpers that ask for a class."""
    variable, node = stand_in_of("LaunchConfiguration")("x"), stand_in_of("LifecycleNode")(package="p", executable="e")
    assert isinstance(variable, stand_in_of("Substitution"))
    assert not isinstance(variable, stand_in_of("Action"))
    assert all(isinstance(node, stand_in_of(base)) for base in ("Node", "ExecuteProcess", "Action"))
    assert (node.kind, variable.kind) == ("LifecycleNode", "LaunchConfiguration")


def test_what_was_given_can_be_asked_for() -> None:
    """By the name that it has, also when it was given by place; what launch alone would know is not there."""
    argument = said("DeclareLaunchArgument", "x", default_value="1")
    assert (argument.name, argument.default_value, argument.choices) == ("x", "1", None)
    assert said("Node", package="p").describe() == "Node(p)"
    with pytest.raises(AttributeError, match="Node has no 'process_details' here"):
        _ = said("Node", package="p").process_details


def test_what_cannot_be_given() -> None:
    """It is a problem of the line, and the rest is read."""
    RECORDING.problems = []
    said("LogInfo", "hello")
    assert [problem["message"] for problem in RECORDING.problems] == [
        "LogInfo takes nothing without a name, and not 'hello'; write msg='hello'"
    ]
    RECORDING.problems = []


def test_modules_are_found_by_name() -> None:
    """Those of ROS's launch packages, and no others."""
    finder = StandIns()
    spec = finder.find_spec("launch_ros.actions")
    assert spec is not None
    module = finder.create_module(spec)
    assert module.Node(package="p").kwargs == {"package": "p"}
    assert (finder.find_spec("launcher"), finder.find_spec("json")) == (None, None)


def test_folders_of_packages(tmp_path: Path) -> None:
    """As substitutions; as they are where the file is about to be started."""
    (tmp_path / "package.xml").write_text("<package><name>robot</name></package>")
    RECORDING.file = str(tmp_path / "a.launch.py")
    share = said("FindPackageShare", "robot")
    assert share.find("robot") == "$(find-pkg-share robot)"
    RECORDING.values = {}
    assert (share.find("robot"), share.perform()) == (str(tmp_path), str(tmp_path))


def test_what_fails_can_be_caught() -> None:
    """By the names that ROS has for it."""
    module = StandIns().create_module(StandIns().find_spec("launch.substitutions"))  # type: ignore[arg-type]
    RECORDING.values = {}
    with pytest.raises(module.SubstitutionFailure):
        said("LaunchConfiguration", "z").perform(Context())
    with pytest.raises(module.InvalidConditionExpressionError):
        said("IfCondition", "typo").evaluate(Context())
    assert issubclass(module.InvalidLaunchFileError, Exception)


def test_conditions_and_choices() -> None:
    """By name or by place, and of any number."""
    assert text(said("IfElseSubstitution", "on", else_value="b")) == "$(if on '' b)"
    assert [text(said(f"{name}Substitution")) for name in ("Any", "All")] == ["$(any)", "$(all)"]
    assert text(said("EqualsSubstitution", None, True)) == "$(equals '' True)"
    assert text(said("Parameter", "rate", default="2")) == "$(param rate 2)"


def test_substitutions_in_words_of_others() -> None:
    """They keep their own quotes: they are made first."""
    same = said("EqualsSubstitution", said("LaunchConfiguration", "x"), "it's")
    chosen = said("IfElseSubstitution", same, if_value=["a ", said("LaunchConfiguration", "y")], else_value="b c")
    assert text(chosen) == """$(if $(equals $(var x) "it's") 'a $(var y)' 'b c')"""
