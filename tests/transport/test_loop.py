"""Which event loop nodes run on."""

from __future__ import annotations

import pytest

from graphflow.system import is_portable
from graphflow.transport import loop as loop_module
from graphflow.transport.loop import new_event_loop


def test_uvloop_is_taken_where_it_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The extra `fast` is enough; the variable overrules."""
    monkeypatch.delenv("GRAPHFLOW_LOOP", raising=False)
    monkeypatch.setattr(loop_module, "find_spec", lambda name: None)
    made = new_event_loop()
    assert type(made).__name__ == ("_UnixSelectorEventLoop" if is_portable() else "BellLoop")
    made.close()
    monkeypatch.setenv("GRAPHFLOW_LOOP", "uvloop")
    uvloop = pytest.importorskip("uvloop", reason="the extra `fast` is not installed")
    other = new_event_loop()
    assert isinstance(other, uvloop.Loop)
    other.close()
