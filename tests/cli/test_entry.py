"""The way in: Ctrl-C is quiet from the first moment on."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import graphflow
from tests.cases import slow

INTERRUPTED = "import os, signal; os.kill(os.getpid(), signal.SIGINT); print('goes on')"


def run(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=60)


def test_ctrl_c_while_commands_are_imported() -> None:
    """Ctrl-C ends the process at once, with exit code 0 and without a traceback."""
    done = run(f"import graphflow.cli.entry; {INTERRUPTED}")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_without_it_there_is_a_traceback() -> None:
    """The test above could fail."""
    done = run(INTERRUPTED)
    assert done.returncode != 0
    assert "KeyboardInterrupt" in done.stderr


def test_who_ignores_ctrl_c_goes_on_ignoring_it() -> None:
    """A process that ignores SIGINT, as in a shell's background, keeps ignoring it."""
    done = run(
        f"import signal; signal.signal(signal.SIGINT, signal.SIG_IGN); import graphflow.cli.entry; {INTERRUPTED}"
    )
    assert (done.returncode, done.stdout) == (0, "goes on\n")


def test_a_command_has_pythons_own_handler() -> None:
    """Once it runs, Ctrl-C is a KeyboardInterrupt again, which each verb answers in its way."""
    code = "import signal, graphflow.cli.main as m; m.main = lambda: print(signal.getsignal(signal.SIGINT).__name__)"
    done = run(f"import graphflow.cli.entry; {code}; graphflow.cli.entry.main()")
    assert done.stdout == "default_int_handler\n"


def test_a_graph_is_announced_before_the_command_is_imported(tmp_path: Path) -> None:
    """The announcement lasts as long as the command, since a `down` given meanwhile takes as long to import."""
    code = (
        "import os, sys, graphflow.cli.entry as entry; sys.argv = ['graphflow', 'up']; "
        "assert 'click' not in sys.modules; sys.modules['graphflow.cli.main'] = sys; "
        "from graphflow.supervisor.starts import starting; "
        "sys.main = lambda: sys.exit(0 if [s.pid for s in starting()] == [os.getpid()] else 3); entry.main()"
    )
    environment = {**os.environ, "XDG_RUNTIME_DIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], check=False, timeout=60, env=environment)
    assert done.returncode == 0
    assert not list((tmp_path / "graphflow").iterdir())


def test_the_package_is_a_command() -> None:
    """`python -m graphflow` is `graphflow`."""
    done = subprocess.run(
        [sys.executable, "-m", "graphflow", "--version"], capture_output=True, text=True, check=False, timeout=60
    )
    assert graphflow.__version__ in done.stdout


@slow
def test_what_the_user_wants_done_at_the_end() -> None:
    """`atexit` functions run if the process has run a node; otherwise it ends at once."""
    code = "import atexit, sys, graphflow.cli.main as m; atexit.register(print, 'bye'); m.main = lambda: sys.exit(3)"
    end = "import graphflow.cli.entry as e; e.main()"
    with_node = run(f"import graphflow.runtime.node; {code}; {end}")
    assert (with_node.returncode, with_node.stdout) == (3, "bye\n")
    without = run(f"{code}; {end}")
    assert (without.returncode, without.stdout) == (3, "")
