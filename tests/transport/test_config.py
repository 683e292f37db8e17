"""How sessions are configured."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from graphflow.errors import TransportError
from graphflow.transport.config import config, open_session


@pytest.mark.parametrize("mode", ["peer", "client", "router"])
def test_sessions_of_nodes_are_patient(mode: str) -> None:
    """Two peers that find each other try to connect once; with half a second for it, as commands have, one pair in some
    hundred stayed apart for good when twenty nodes started on a busy machine.
    """
    found = json.loads(config(mode).get_json("transport/unicast"))
    assert found["open_timeout"] >= 10_000
    assert found["accept_timeout"] >= 10_000


def test_a_command_is_not() -> None:
    """It says within half a second that nobody answers."""
    found = json.loads(config("client", connect=["tcp/127.0.0.1:7447"], open_limit=0.5).get_json("transport/unicast"))
    assert found["open_timeout"] == 500
    assert config("client", connect=["tcp/127.0.0.1:7447"]).get_json("connect/endpoints") == '["tcp/127.0.0.1:7447"]'


def test_zenoh_has_threads_for_what_may_wait_for_the_gil() -> None:
    """What the user says comes first."""
    program = "import os; import graphflow.transport.config; print(os.environ['ZENOH_RUNTIME'])"
    own = "(net: (worker_threads: 3))"
    plain = {name: value for name, value in os.environ.items() if name != "ZENOH_RUNTIME"}
    for more, expected in (({}, "(net: (worker_threads: 8))"), ({"ZENOH_RUNTIME": own}, own)):
        said = subprocess.check_output([sys.executable, "-c", program], env=plain | more, text=True, timeout=60)
        assert said.strip() == expected


def test_python_without_its_lock_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search reads frames of other threads, which only the lock holds still."""
    monkeypatch.setattr(sys, "_is_gil_enabled", lambda: False, raising=False)
    with pytest.raises(TransportError, match="unset PYTHON_GIL"):
        open_session(config("peer"))


ENDING = """
import threading, time, zenoh
from graphflow.transport.config import callback_threads, close_at_exit, config, open_session

called = threading.Event()

def heard(sample):
    called.set()
    time.sleep(0.3)
    print("heard", flush=True)

def listen():
    global session, subscriber
    session = open_session(config("peer"))
    subscriber = session.declare_subscriber("a/b", heard)
    assert [thread.daemon for thread in callback_threads()] == [True]
    close_at_exit(session)
    session.put("a/b", b"")

threading.Thread(target=listen, daemon=True).start()
assert called.wait(20)
"""


def test_zenohs_callback_threads_end_before_the_interpreter() -> None:
    """They are daemons when a daemon started them. One that asks for the GIL too late aborts the process."""
    run = subprocess.run([sys.executable, "-c", ENDING], capture_output=True, text=True, timeout=60)
    assert (run.returncode, run.stdout, run.stderr) == (0, "heard\n", "")
