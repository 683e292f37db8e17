"""Definitions in one text, as MCAP has them."""

from __future__ import annotations

import pytest
from rosbags.typesys import get_types_from_msg

from graphflow.bag.formats.definitions import RULE, joined, known, parted
from graphflow.errors import InterfaceError
from graphflow.msgs import registry
from graphflow.wire.described import verified
from tests.cases import sample

MESSAGES = [f"{p}/msg/{name}" for p in registry.packages() for name in registry.names_in(p, "msg")]


@pytest.mark.parametrize("name", sample(MESSAGES))
def test_there_and_back(name: str) -> None:
    """Every type that is installed has its hash when it comes back, and others can read the text."""
    text = known(name)
    sources = parted(name, text)
    verified(name, registry.hash_of(name), sources)
    assert joined(name, sources) == text
    assert name in get_types_from_msg(text, name)


def test_its_form() -> None:
    """The type itself has no head; the others have, in the short form of their names."""
    text = joined("a/msg/A", {"a/msg/A": "b/B b", "b/msg/B": "int32 x\n"})
    assert text == f"b/B b\n{RULE}\nMSG: b/B\nint32 x\n"


@pytest.mark.parametrize("head", ["", "MSG:", "MSG: B", "IDL: b/B", "MSG: a/b/c/d"])
def test_what_is_no_definition(head: str) -> None:
    """A part without its name is refused."""
    with pytest.raises(InterfaceError, match="the definition of a/msg/A has a part that begins"):
        parted("a/msg/A", f"int32 x\n{RULE}\n{head}\nint32 y\n")
