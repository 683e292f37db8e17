"""Which running graph a command means, and what is said where there is none."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from graphflow.errors import SupervisorError
from graphflow.supervisor.control.choosing import choose, running_here
from graphflow.supervisor.starts import Announcement
from tests.supervisor.test_rundir import a_run, start


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A user who has nothing running, in domain 7."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "run"))
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", "7")
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "tcp/x")
    return tmp_path


def test_choosing_among_several() -> None:
    """One running graph needs no name, several do, and none is code 3."""
    with pytest.raises(SupervisorError, match="no graph is running; start one with: graphflow up") as caught:
        choose(None)
    assert caught.value.exit_code == 3
    directories = [start("chase")]
    assert choose(None) == choose("chase") == a_run()
    directories += [start("draw"), start("draw", domain=8)]
    with pytest.raises(SupervisorError) as caught:
        choose(None)
    assert str(caught.value) == (
        "several graphs are running: chase (domain 7), draw (domain 7); say which with --graph NAME"
    )
    assert caught.value.exit_code == 2
    assert len(running_here(everything=True)) == 3
    assert choose("chase").graph == "chase"
    with pytest.raises(SupervisorError, match="graph 'chas' is not running; did you mean 'chase'") as caught:
        choose("chas")
    assert caught.value.exit_code == 3
    assert choose("draw").domain == 7
    for directory in directories:
        directory.release()


@pytest.mark.parametrize(("domain", "endpoint", "where"), [("9", "tcp/x", "domain 9"), ("7", "tcp/other", "tcp/other")])
def test_graphs_elsewhere(domain: str, endpoint: str, where: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Are named, and never meant unless they are."""
    directory = start("chase")
    monkeypatch.setenv("GRAPHFLOW_DOMAIN", domain)
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", endpoint)
    elsewhere = "elsewhere there is chase (domain 7): name it with --graph chase"
    with pytest.raises(SupervisorError) as caught:
        choose(None)
    assert str(caught.value) == f"no graph is running in {where}; {elsewhere}"
    assert caught.value.exit_code == 3
    monkeypatch.setattr("graphflow.supervisor.control.choosing.recent_death", lambda: "lab: it was killed")
    with pytest.raises(SupervisorError, match=re.escape(f"; the latest, lab: it was killed; {elsewhere}")):
        choose(None)
    assert choose("chase").graph == "chase"
    directory.release()


@pytest.mark.parametrize("running", [[], ["draw"]])
def test_a_graph_that_is_being_started(here: Path, running: list[str]) -> None:
    """Is named in place of the advice to start one, and with the way to wait for it."""
    directories = [start(graph, domain=8) for graph in running]
    announced = Announcement()
    announced.begin(here / "chase.yaml")
    about = f"being started: {here}/chase.yaml (process {os.getpid()}); wait for it with: graphflow wait"
    with pytest.raises(SupervisorError) as caught:
        choose(None)
    assert str(caught.value) == f"no graph is running{' in domain 7' if running else ''} yet; {about}"
    assert caught.value.exit_code == 3
    with pytest.raises(SupervisorError) as caught:
        choose("chase")
    assert str(caught.value).endswith(f"running yet; {about}")
    announced.end()
    for directory in directories:
        directory.release()
