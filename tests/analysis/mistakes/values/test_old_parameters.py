"""Callbacks for new parameter values that read the old ones."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.mistakes.values.old_parameters import old_parameters

SOURCE = """
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.{register}(self.changed)

    def changed(self, params):
        {line}
        return SetParametersResult(successful=True)
"""


def test_an_old_value() -> None:
    """The sentence names the callback's argument."""
    line = 'self.speed = self.get_parameter("speed").value'
    module = ast.parse(SOURCE.format(register="add_on_set_parameters_callback", line=line))
    [(found, text)] = old_parameters(module)
    assert found == 8
    assert text.startswith("get_parameter returns the old value until this callback has accepted the new one")
    assert text.endswith("from params: for parameter in params: parameter.name, parameter.value")


@pytest.mark.parametrize(
    ("register", "line"),
    [
        ("add_post_set_parameters_callback", 'self.speed = self.get_parameter("speed").value'),
        ("add_on_set_parameters_callback", 'limit = self.get_parameter("limit").value'),
        ("add_on_set_parameters_callback", "self.speed = params[0].value"),
    ],
)
def test_new_and_other_values(register: str, line: str) -> None:
    """A callback after the change, a check against another parameter and the argument itself are left alone."""
    assert not list(old_parameters(ast.parse(SOURCE.format(register=register, line=line))))
