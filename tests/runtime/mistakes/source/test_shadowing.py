"""Names that a class binds twice are reported at the second binding."""

from __future__ import annotations

import importlib.util
import itertools
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from graphflow.errors import DeclarationError

TEXT = """
import graphflow
from graphflow import Client, Group, Node, Param, Publisher, service, subscription, timer
from graphflow.msgs.std_msgs.msg import String
from graphflow.msgs.std_srvs.srv import Empty


class N(Node):
{body}
"""
_numbers = itertools.count(1)
SERVICE = '@service(Empty, "enable")\nasync def enable(self, request): ...'


@pytest.fixture
def written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Any]:
    """Makes a class with that body, in a file of its own: its first line there is 9."""

    def made(body: str) -> Any:
        name = f"twice_{next(_numbers)}"
        file = tmp_path / f"{name}.py"
        file.write_text(TEXT.replace("{body}", "\n".join(f"    {line}" for line in body.split("\n"))))
        spec = importlib.util.spec_from_file_location(name, file)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, name, module)
        spec.loader.exec_module(module)
        return module.N

    return made


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (f"enable = False\n{SERVICE}", ":11: N has another 'enable' in line 9, which is lost"),
        (f"{SERVICE}\nenable = False", ":11: N has another 'enable' in line 10, which is lost"),
        (f"enable: bool = False\n{SERVICE}", ":11: N has another 'enable' in line 9, which is lost"),
        (f'enable = Client(Empty, "enable")\n{SERVICE}', ":11: N has another 'enable' in line 9, which is lost"),
        (
            '@subscription(String, "a")\ndef callback(self, m): ...\n'
            '@graphflow.subscription(String, "b")\ndef callback(self, m): ...',
            ":12: N has another 'callback' in line 10, which is lost",
        ),
        (f"{SERVICE}\ndef go(self):\n    self.enable = True", ":12: self.enable hides the declaration N.enable"),
        (
            'out = Publisher(String, "out")\ndef go(self):\n    self.out = String()',
            ":11: self.out hides the declaration N.out",
        ),
    ],
)
def test_names_that_stand_for_two_things(written: Callable[[str], Any], body: str, told: str) -> None:
    """In the body, in either order, and where a method assigns to a declaration."""
    with pytest.raises(DeclarationError) as caught:
        written(body).interface()
    assert told in str(caught.value)


@pytest.mark.parametrize(
    "body",
    [
        f"enable: bool\n{SERVICE}",
        "@property\ndef x(self): return 1\n@x.setter\ndef x(self, value): ...",
        "limit = 1\nlimit = limit + 1",
        "rate = Param(1.0)\ndef go(self):\n    self.rate = 2.0",
        f"{SERVICE}\ndef go(self):\n    class N:\n        enable = 1\n        enable = 2\n    return N",
        f"{SERVICE}\ndef go(self):\n    other = self\n    other.enable = 3",
    ],
)
def test_names_that_do_not(written: Callable[[str], Any], body: str) -> None:
    """Annotations, properties, plain values, parameters and assignments to other objects are legal."""
    assert written(body).interface()


def test_a_child_that_says_it_anew(written: Callable[[str], Any]) -> None:
    """Overriding is no loss."""
    parent = written(SERVICE)

    class Child(parent):  # type: ignore[misc,valid-type]
        async def enable(self, request: object) -> None: ...

    assert [h.name for h in Child.interface().handlers] == ["enable"]
