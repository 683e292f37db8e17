"""Faults of the installation."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

from graphflow.introspect.installation import faults, recompiled, requirement

ROS = {"AMENT_PREFIX_PATH": "/opt/ros/jazzy", "ROS_DISTRO": "jazzy", "RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}


def found(env: dict[str, str], **versions: str) -> list[str]:
    known = {"eclipse-zenoh": "1.10.2"} | {name.replace("_", "-"): version for name, version in versions.items()}
    return list(faults(env, known.get))


@pytest.fixture(autouse=True)
def defaults(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("GRAPHFLOW_RENDEZVOUS", raising=False)
    monkeypatch.delenv("GRAPHFLOW_WIRE", raising=False)


def test_nothing() -> None:
    """There is no fault, with and without a compatible ROS 2."""
    assert found({}) == []
    assert found(ROS) == []
    assert found(ROS | {"ROS_DOMAIN_ID": "3"}) == []
    assert found(ROS | {"ROS_DOMAIN_ID": "3", "GRAPHFLOW_DOMAIN": "3"}) == []
    assert found({"GRAPHFLOW_DOMAIN": "3"}) == []


@pytest.mark.parametrize(
    ("env", "told"),
    [
        ({"RMW_IMPLEMENTATION": ""}, "they use DDS; export RMW_IMPLEMENTATION=rmw_zenoh_cpp"),
        ({"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}, "they use rmw_cyclonedds_cpp; export"),
        ({"ROS_DISTRO": "kilted"}, "graphflow uses jazzy's definitions: export GRAPHFLOW_WIRE=kilted"),
        ({"ROS_DISTRO": "humble"}, "humble is sourced here, which has no type hashes"),
        ({"GRAPHFLOW_DOMAIN": "5"}, "GRAPHFLOW_DOMAIN is 5, but ROS 2's nodes are in domain 0"),
        ({"GRAPHFLOW_DOMAIN": "5", "ROS_DOMAIN_ID": "4"}, "in domain 4: unset GRAPHFLOW_DOMAIN"),
    ],
)
def test_a_ros_that_would_not_see_the_graph(env: dict[str, str], told: str) -> None:
    """Each with the command that mends it."""
    [text] = found(ROS | env)
    assert told in text


def test_a_rendezvous_that_ros_does_not_know(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keeps the two apart."""
    monkeypatch.setenv("GRAPHFLOW_RENDEZVOUS", "tcp/127.0.0.1:9999")
    [text] = found(ROS)
    assert "its nodes connect to tcp/127.0.0.1:7447, graphflow's to tcp/127.0.0.1:9999" in text
    assert found({}) == []


def test_packages() -> None:
    """Another package of our name, and a Zenoh that is too old."""
    [text] = found({}, graphflow="0.3")
    assert "pip uninstall graphflow" in text
    [text] = found({}, eclipse_zenoh="1.9.9")
    assert "eclipse-zenoh 1.9.9 is too old: pip install -U 'eclipse-zenoh>=1.10'" in text
    assert found({}, eclipse_zenoh="2.0.0rc1") == []


@pytest.mark.parametrize(
    ("origin", "words"),
    [
        ("", "'graphflow-zenoh[plot]'"),
        ('{"url": "file:///home/me/my%20flow", "dir_info": {"editable": true}}', "-e '/home/me/my flow[plot]'"),
        ('{"url": "file:///home/me/flow", "dir_info": {}}', "'/home/me/flow[plot]'"),
        ('{"url": "https://a.b/f.whl", "archive_info": {}}', "'graphflow-zenoh[plot] @ https://a.b/f.whl'"),
        (
            '{"url": "https://a.b/f", "vcs_info": {"vcs": "git", "commit_id": "1f"}}',
            "'graphflow-zenoh[plot] @ git+https://a.b/f@1f'",
        ),
    ],
)
def test_requirement(monkeypatch: pytest.MonkeyPatch, origin: str, words: str) -> None:
    """The requirement names the origin: an index, a folder, a file or a repository."""

    class Distribution:
        def read_text(self, _: str) -> str:
            return origin

    monkeypatch.setattr("importlib.metadata.distribution", lambda _: Distribution())
    assert requirement("plot") == words


def imported(folder: Path) -> ModuleType:
    """A module that Python has just imported from a folder."""
    (folder / "m.py").write_text("")
    spec = importlib.util.spec_from_file_location("m", folder / "m.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_each_start_compiles_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A note has the remedy if Python does not, or cannot, cache bytecode."""
    monkeypatch.setattr(sys, "pycache_prefix", None)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    module = imported(tmp_path)
    [text] = recompiled(module, writes=False)
    assert "PYTHONDONTWRITEBYTECODE is set; compile it once" in text
    assert text.endswith("graphflow")
    [text] = recompiled(module, writes=True)
    assert f"{tmp_path / '__pycache__'} cannot be written" in text

    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    kept = imported(tmp_path)
    assert list(recompiled(kept, writes=True)) == []
    assert list(recompiled(kept, writes=False)) == []
