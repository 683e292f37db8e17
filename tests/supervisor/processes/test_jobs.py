"""The jobs of workers, and the workers that start first."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from graphflow.graph.plan import Plan
from graphflow.graph.resolve import load
from graphflow.supervisor.processes.jobs import MESH_LIMIT, Start, first_starts
from graphflow.supervisor.processes.messages import WorkerJob

LAB = """
deadlock: report
nodes:
  /a: {class: "n:A", env: {COLOUR: blue}}
  /b: {class: "n:A", process: shared}
  /c: {class: "n:A", process: shared, env: {SHAPE: round}}
  /late: {class: "n:A", after: /a}
  /mate: {class: "n:A", process: half, after: /a}
  /other: {class: "n:A", process: half}
  /program: {command: [sleep, "1"]}
"""


def plan_of(folder: Path, text: str = LAB) -> Plan:
    file = folder / "lab.yaml"
    file.write_text(text)
    return load(file, [])


def job_of(start: Start) -> WorkerJob:
    assert "nodes" in start.job
    return start.job


def test_the_first_are_workers_that_come_after_nothing(tmp_path: Path) -> None:
    """Programs, and processes of which a node comes after something, are started when their turn has come."""
    plan = plan_of(tmp_path)
    first = {start.process: start for start in first_starts(plan, 7, tmp_path)}
    assert [*first] == ["/a", "shared"]
    a, shared = first.values()
    assert (a.env, shared.env) == ({"COLOUR": "blue"}, {"SHAPE": "round"})
    assert [node["name"] for node in job_of(shared)["nodes"]] == ["/b", "/c"]
    job = job_of(a)
    assert (job["domain"], job["deadlock"], job["mode"], job["debug"]) == (7, "report", "peer", False)
    assert job["log"] == a.log
    assert Path(a.log).parent == tmp_path


def test_one_that_is_debugged_is_not_among_them(tmp_path: Path) -> None:
    """It waits for whoever debugs it, and is told of by the supervisor."""
    plan = plan_of(tmp_path)
    debugged = replace(plan, nodes=(replace(plan.nodes[0], is_debugged=True), *plan.nodes[1:]))
    assert [start.process for start in first_starts(debugged, 7, tmp_path)] == ["shared"]


def test_more_than_a_mesh_carries_are_clients(tmp_path: Path) -> None:
    """Of the rendezvous."""
    many = "nodes:\n" + "".join(f'  /n{i}: {{class: "n:A"}}\n' for i in range(MESH_LIMIT + 1))
    assert {job_of(start)["mode"] for start in first_starts(plan_of(tmp_path, many), 7, tmp_path)} == {"client"}
