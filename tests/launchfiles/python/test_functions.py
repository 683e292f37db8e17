"""Functions of ROS's launch packages."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from graphflow.launchfiles.python import functions as functions
from graphflow.launchfiles.python.recording import RECORDING
from graphflow.launchfiles.python.stand_ins import OWN, Context, RecordedCall, StandIns
from graphflow.markup.substitutions import SubstitutionError

Substitution = type("Substitution", (RecordedCall,), {"kind": "Substitution"})


class Upper(Substitution):  # type: ignore[misc, valid-type]
    """A substitution of a launch file's own, as packages such as nav2_common have them."""

    def __init__(self, source: object) -> None:
        super().__init__()
        self._source = functions.normalize_to_list_of_substitutions(source)

    @property
    def name(self) -> list[RecordedCall]:
        return self._source

    def perform(self, context: Context) -> str:
        return functions.perform_substitutions(context, self.name).upper()


@pytest.fixture(autouse=True)
def started() -> Iterator[None]:
    RECORDING.values = {"x": "a b"}
    yield
    RECORDING.values = None


def variable(name: str) -> RecordedCall:
    made: RecordedCall = type("LaunchConfiguration", (RecordedCall,), {"kind": "LaunchConfiguration"})(name)
    return made


@pytest.mark.parametrize("given", ["x", Path("x"), variable("x"), [variable("x"), "y", Path("z")], [], ("x",)])
def test_what_a_substitution_is_made_of(given: object) -> None:
    """Texts, paths, and substitutions, in lists or alone."""
    found = functions.normalize_to_list_of_substitutions(given)
    assert all(isinstance(one, RecordedCall) for one in found)
    assert functions.perform_substitutions(Context(), found) == functions.perform_substitutions(Context(), given)


def test_what_is_no_substitution() -> None:
    """Is refused, as ROS refuses it."""
    with pytest.raises(TypeError, match="expected a text, a substitution, or a list of them, got 3"):
        functions.normalize_to_list_of_substitutions(["a", 3])


def test_a_substitution_of_a_files_own() -> None:
    """It is made by its own method, from what it was given; a property called `name` is its own, too."""
    assert functions.perform_substitutions(Context(), ["<", Upper([variable("x"), "/c"]), ">"]) == "<A B/C>"


def test_conditions() -> None:
    """They are true, false, or wrong."""
    assert functions.evaluate_condition_expression(Context(), ["tr", "ue"])
    assert not functions.evaluate_condition_expression(Context(), "0")
    with pytest.raises(SubstitutionError, match="expected true or false, got 'a b'"):
        functions.evaluate_condition_expression(Context(), [variable("x")])


def test_classes() -> None:
    """Values and classes of a class, and the refusal of others."""
    assert functions.is_a(1, int)
    assert functions.is_a_subclass(Upper, RecordedCall)
    assert functions.is_a_subclass(True, int)
    functions.ensure_argument_type(1, [str, int], "x")
    with pytest.raises(TypeError, match="f: x: expected str or float, got 1"):
        functions.ensure_argument_type(1, [str, float], "x", "f")


@pytest.mark.parametrize(
    ("base", "namespace", "expected"),
    [
        (None, None, None),
        ("a", None, "a"),
        (None, "/", "/"),
        ("", "b", "b"),
        ("a", "", "a"),
        ("/", "b", "/b"),
        ("/a", "b/", "/a/b"),
        ("a", "/b/", "/b"),
    ],
)
def test_namespaces(base: str | None, namespace: str | None, expected: str | None) -> None:
    """A relative one comes below another."""
    assert functions.prefix_namespace(base, namespace) == expected
    assert functions.make_namespace_absolute("a") == functions.make_namespace_absolute("/a") == "/a"


def test_packages_that_are_there(tmp_path: Path) -> None:
    """They have a resource; others, and resources of other kinds, are not there."""
    (tmp_path / "package.xml").write_text("<package><name>robot</name></package>")
    RECORDING.file = str(tmp_path / "a.launch.py")
    assert functions.has_resource("packages", "robot")
    assert functions.has_resource("packages", "elsewhere") is False
    assert functions.has_resource("plugins", "robot") is False


def test_where_they_are() -> None:
    """In every module of launch's, by their names; those that are not here say so when they are called."""
    finder = StandIns()
    module = finder.create_module(finder.find_spec("launch.utilities"))  # type: ignore[arg-type]
    assert module.normalize_to_list_of_substitutions is OWN["normalize_to_list_of_substitutions"]
    assert module.expose_action("upper")(Upper) is Upper
    with pytest.raises(NotImplementedError, match=r"launch\.utilities\.signal_them is not here"):
        module.signal_them()
