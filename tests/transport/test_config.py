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


def test_signs_of_life_are_rare_on_this_machine() -> None:
    """The system tells of processes that end; links to other machines say how often."""
    here, beyond = (json.loads(c.get_json("transport/link/tx")) for c in (config("peer"), config("router", lease=4.0)))
    assert (here["lease"], here["keep_alive"]) == (120_000, 2)
    assert (beyond["lease"], beyond["keep_alive"]) == (4_000, 2)


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


CLOSED_ELSEWHERE = """
import threading, time, zenoh
from graphflow.transport import config as module

class Session:
    is_closing = False

    def is_closed(self):  # as Zenoh's, from the first moment on
        return self.is_closing

    def close(self):
        self.is_closing = True
        begun.set()
        time.sleep(0.3)
        print("closed", flush=True)

begun, session = threading.Event(), Session()
module.close_at_exit(session)
threading.Thread(target=module.close_session, args=(session,), daemon=True).start()
begun.wait(20)
"""


def test_a_session_that_another_thread_closes_is_waited_for() -> None:
    """It says that it is closed as soon as that begins."""
    run = subprocess.run([sys.executable, "-c", CLOSED_ELSEWHERE], capture_output=True, text=True, timeout=60)
    assert (run.returncode, run.stdout, run.stderr) == (0, "closed\n", "")


INTERRUPTED = """
import os, signal, sys, threading, time
from graphflow.transport import config as module

def interrupt():
    os.kill(os.getpid(), signal.SIGINT)

def close():
    if sys.argv[1] == "meanwhile":
        interrupt()
    time.sleep(0.3)
    print("closed", flush=True)

module.before_closing_at_exit(close)
if sys.argv[1] == "before":
    threading._register_atexit(interrupt)  # called where Python begins to wait for threads
"""


@pytest.mark.skipif(sys.platform == "win32", reason="it has no SIGINT to be sent")
@pytest.mark.parametrize("when", ["before", "meanwhile"])
def test_an_interrupt_breaks_off_no_closing(when: str) -> None:
    """Neither when the main thread has just ended, nor while it waits."""
    run = subprocess.run([sys.executable, "-c", INTERRUPTED, when], capture_output=True, text=True, timeout=60)
    assert (run.returncode, run.stdout) == (0, "closed\n")
    assert "KeyboardInterrupt" in run.stderr  # Python itself says so


OUTLIVING = """
import threading, time
from graphflow.transport.config import before_closing_at_exit, close_at_exit, config, open_session

session = open_session(config("peer"))
close_at_exit(session)
before_closing_at_exit(lambda: print("closing", flush=True))

def work():
    threading.main_thread().join()
    time.sleep(0.2)
    print(session.is_closed(), flush=True)

threading.Thread(target=work).start()
"""


def test_threads_that_outlive_the_main_thread_keep_sessions_open() -> None:
    """The interpreter waits for them; then the sessions are closed."""
    run = subprocess.run([sys.executable, "-c", OUTLIVING], capture_output=True, text=True, timeout=60)
    assert (run.returncode, run.stdout, run.stderr) == (0, "False\nclosing\n", "")
