"""`--connect` and `--net`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any
from unittest.mock import patch

import click
import pytest

from graphflow.cli.net_options import apply_reach, reach_options
from graphflow.errors import UsageFault
from graphflow.transport.config import CONNECT_VARIABLE, PROFILE_VARIABLE


@pytest.fixture(autouse=True)
def _environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that asks for nothing, and is as it was afterwards."""
    for name in (CONNECT_VARIABLE, PROFILE_VARIABLE):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)


@click.command()
@reach_options
def command(**options: Any) -> None:
    """Something that reaches out."""


def given(*words: str) -> dict[str, Any]:
    return command.make_context("command", list(words)).params


def test_it_is_put_where_the_transport_looks(tmp_path: Path) -> None:
    """Several endpoints with spaces between them, and the whole path of the profile."""
    profile = tmp_path / "net.yaml"
    profile.touch()
    apply_reach(**given("--connect", "tcp/robot:7447", "--connect", "tls/10.0.0.2:1", "--net", str(profile)))
    assert os.environ[CONNECT_VARIABLE] == "tcp/robot:7447 tls/10.0.0.2:1"
    assert os.environ[PROFILE_VARIABLE] == str(profile)


def test_without_options_the_environment_stands() -> None:
    """Without options, the environment is not changed."""
    with patch.dict(os.environ, {CONNECT_VARIABLE: "tcp/robot:7447"}):
        apply_reach(**given())
        assert os.environ[CONNECT_VARIABLE] == "tcp/robot:7447"
        assert PROFILE_VARIABLE not in os.environ


def test_an_endpoint_that_is_misspelt() -> None:
    """A misspelt endpoint is wrong usage, found before any connection, and changes nothing."""
    with pytest.raises(UsageFault, match="--connect: "):
        apply_reach(("tcp/robot:7447", "robot"), None)
    assert CONNECT_VARIABLE not in os.environ


def test_a_profile_must_be_a_file(tmp_path: Path) -> None:
    """One that is not there is wrong usage."""
    with pytest.raises(click.BadParameter, match="does not exist"):
        given("--net", str(tmp_path / "net.yaml"))
