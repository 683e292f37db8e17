"""The types of the messages between supervisor, preload process and workers."""

from __future__ import annotations

from pathlib import Path
from typing import get_args, get_type_hints

import pytest

from graphflow.supervisor.processes.jobs import first_starts
from graphflow.supervisor.processes.messages import Order, PreloadEvent, PreloadRequest, WorkerJob
from tests.supervisor.processes.test_jobs import job_of, plan_of


@pytest.mark.parametrize(("union", "key"), [(PreloadEvent, "event"), (PreloadRequest, "do"), (Order, "do")])
def test_a_tag_belongs_to_one_type(union: object, key: str) -> None:
    """A reader tells messages apart by their tag alone."""
    tags = [get_args(get_type_hints(kind)[key])[0] for kind in get_args(union)]
    assert tags
    assert len(tags) == len(set(tags))


def test_a_job_has_the_keys_of_its_type(tmp_path: Path) -> None:
    """A worker reads all of them."""
    start = next(iter(first_starts(plan_of(tmp_path), 7, tmp_path)))
    assert job_of(start).keys() == WorkerJob.__annotations__.keys()
