"""Lines that a server logs while a command waits for it."""

from __future__ import annotations

from graphflow.introspect.server_logs import SHOWN, lines, read
from graphflow.msgs.rcl_interfaces.msg import Log

WARN, ERROR = Log.WARN, Log.ERROR


def test_only_problems_of_the_servers() -> None:
    """Warnings and errors of the nodes' loggers and their children, each once; not those of a similar name."""
    logs = [
        Log(name="sim", level=WARN, msg="slow"),
        Log(name="sim", level=WARN, msg="slow"),
        Log(name="sim", level=Log.INFO, msg="fine"),
        Log(name="lab.sim.camera", level=ERROR, msg="dark \x1b[31mred\x1b[0m"),
        Log(name="simulator", level=ERROR, msg="another"),
    ]
    assert lines(logs, ["/sim", "/lab/sim"]) == [
        "meanwhile /sim logged a warning: slow",
        "meanwhile /lab/sim logged an error: dark red",
    ]
    assert lines(logs, []) == []


def test_the_newest_of_many() -> None:
    """Are shown, without those that repeat a known reason."""
    logs = [Log(name="sim", level=WARN, msg=str(n)) for n in range(10)]
    assert [text.rpartition(" ")[2] for text in lines(logs, ["/sim"])] == ["7", "8", "9"][-SHOWN:]
    assert lines([Log(name="sim", level=WARN, msg="go: aborted: a wall")], ["/sim"], "a wall") == []


def test_malformed_messages() -> None:
    """Are left out."""
    log = Log(name="sim", level=ERROR, msg="no")
    assert list(read([b"", b"\0\1\0\0", log.to_bytes()])) == [log]
