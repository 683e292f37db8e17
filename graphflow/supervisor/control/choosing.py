"""The choice of the running graph that a command applies to, and its errors."""

from __future__ import annotations

from graphflow.domain import domain_id, rendezvous_endpoint
from graphflow.errors import SupervisorError
from graphflow.names import did_you_mean
from graphflow.supervisor import rundir
from graphflow.supervisor.last_end import recent_death
from graphflow.supervisor.rundir import GraphRun
from graphflow.supervisor.starts import being_started


def running_here(*, everything: bool = False) -> list[GraphRun]:
    """Return the graphs that run in the domain and at the endpoint of this process, at least one.

    Args:
        everything: Include graphs elsewhere.

    Raises:
        SupervisorError: There is none (exit 3); the text names graphs elsewhere and graphs that are being started.
    """
    runs = rundir.running()
    if not runs:
        raise _none("no graph is running", f"{_latest()}; start one with: graphflow up GRAPH.yaml")
    here = [run for run in runs if everything or run.is_here]
    if not here:
        listing = ", ".join(f"{r.graph} (domain {r.domain})" for r in runs)
        where = f"domain {domain_id()}" if all(r.domain != domain_id() for r in runs) else rendezvous_endpoint()
        elsewhere = f"; elsewhere there is {listing}: name it with --graph {runs[0].graph}"
        raise _none(f"no graph is running in {where}", _latest() + elsewhere)
    return here


def choose(name: str | None) -> GraphRun:
    """Return the only running graph of this domain or, with a name, the graph of that name wherever it runs.

    Raises:
        SupervisorError: None is running (exit 3), or `name` does not decide between several (exit 2).
    """
    runs = running_here(everything=name is not None)
    if name is not None:
        named = [r for r in runs if r.graph == name]
        if not named:
            raise _none(f"graph {name!r} is not running", did_you_mean(name, [r.graph for r in runs]))
        runs = named
    if len(runs) > 1:
        here = [r for r in runs if r.domain == domain_id()]
        runs = here if name is not None and len(here) == 1 else runs
    if len(runs) > 1:
        listing = ", ".join(f"{r.graph} (domain {r.domain})" for r in runs)
        raise SupervisorError(
            f"several graphs are running: {listing}; say which with --graph NAME"
            f"{' and GRAPHFLOW_DOMAIN' if len({r.graph for r in runs}) < len(runs) else ''}",
            exit_code=2,
        )
    return runs[0]


def _latest() -> str:
    """Return how the newest graph of this domain was killed, if that was a short while ago, to append to an error."""
    death = recent_death()
    return f"; the latest, {death}" if death else ""


def _none(what: str, otherwise: str) -> SupervisorError:
    """Return the error for no graph; its advice is to wait if one is being started."""
    starts = being_started()
    return SupervisorError(f"{what} yet; {starts}" if starts else f"{what}{otherwise}", exit_code=3)
