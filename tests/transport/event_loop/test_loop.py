"""Which event loop nodes run on."""

from __future__ import annotations

import inspect

import pytest

from graphflow.errors import UsageFault
from graphflow.system import is_portable
from graphflow.transport.event_loop import loop as loop_module
from graphflow.transport.event_loop.loop import new_event_loop


def test_uvloop_is_taken_where_it_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The extra `fast` is enough; the variable overrules."""
    monkeypatch.delenv("GRAPHFLOW_LOOP", raising=False)
    with monkeypatch.context() as patched:
        patched.setattr(loop_module, "find_spec", lambda name: None)
        made = new_event_loop()
    assert type(made).__name__ == ("_UnixSelectorEventLoop" if is_portable() else "BellLoop")
    made.close()
    monkeypatch.setenv("GRAPHFLOW_LOOP", "uvloop")
    uvloop = pytest.importorskip("uvloop", reason="the extra `fast` is not installed")
    other = new_event_loop()
    assert isinstance(other, uvloop.Loop)
    other.close()


def test_no_loop_no_coroutine(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the loop is refused, the coroutine is closed, and Python does not call it forgotten."""

    async def main() -> None: ...

    monkeypatch.setenv("GRAPHFLOW_LOOP", "trio")
    coroutine = main()
    with pytest.raises(UsageFault, match="'asyncio' or 'uvloop'"):
        loop_module.run(coroutine)
    assert inspect.getcoroutinestate(coroutine) == inspect.CORO_CLOSED
