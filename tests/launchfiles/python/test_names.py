"""The names of ROS's launch packages."""

from __future__ import annotations

from importlib import import_module
from importlib.machinery import ModuleSpec

import pytest

from graphflow.launchfiles.python.names import NAMES, home
from graphflow.launchfiles.python.stand_ins import PACKAGES, Context, RecordedCall, StandIns


@pytest.mark.parametrize("module", NAMES)
def test_a_star_brings_them(module: str) -> None:
    """Each is something that remembers what it is called with, or a context."""
    assert module.partition(".")[0] in PACKAGES
    finder = StandIns()
    spec = finder.find_spec(module)
    assert spec is not None
    made = finder.create_module(spec)
    assert made.__all__ == NAMES[module].split()
    assert import_module("graphflow.supervisor.launching.launch_service")  # where one of them is
    assert all(issubclass(getattr(made, name), (RecordedCall, Context)) for name in made.__all__)


@pytest.mark.parametrize(
    ("module", "name", "expected"),
    [
        ("launch_ros", "Node", "launch_ros.actions"),
        ("launch.actions", "Node", "launch_ros.actions"),
        ("launch.substitutions", "FindPackageShare", "launch_ros.substitutions"),
        ("launch_ros.actions", "ComposableNode", "launch_ros.descriptions"),
        ("launch", "Shutdown", "launch.actions"),
        ("launch.events", "Shutdown", None),
        ("launch_ros.descriptions", "Parameter", None),
        ("launch_ros.actions.node", "Node", None),
        ("launch.actions", "OfANewerRos", None),
    ],
)
def test_classes_that_are_imported_from_elsewhere(module: str, name: str, expected: str | None) -> None:
    """Are known by the module that has them."""
    assert home(module, name) == expected


def test_a_class_of_another_module() -> None:
    """Cannot be imported, as in ROS."""
    made = StandIns().create_module(ModuleSpec("launch.actions", None))
    with pytest.raises(ImportError, match=r"^launch\.actions has no Node; write: from launch_ros\.actions import Node"):
        getattr(made, "Node")  # noqa: B009 - as an import does
