"""Programs of ROS 2's packages, as modules, for tests without processes."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from typing import Any

import pytest

from graphflow.workspace.packages import BUNDLED

Program = dict[str, Any]


@pytest.fixture
def program() -> Callable[[str], Program]:
    """What a program, such as `tf2_ros/tf2_echo`, defines."""

    def load(name: str) -> Program:
        package, _, file = name.partition("/")
        return runpy.run_path(str(BUNDLED / package / "programs" / f"{file}.py"))

    return load
