"""Peers and routers of older Zenoh versions, as robots in the field have them."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases import slow, some
from tests.conftest import PROGRAMS, Machine, Program

pytestmark = pytest.mark.real

VERSIONS = ["1.5.1", "1.7.2", "1.9.0"]
LATCHED = str(PROGRAMS / "interop" / "latched.py")


@pytest.fixture(scope="session")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with each version in a folder of its name."""
    folder = tmp_path_factory.mktemp("zenoh")
    for version in VERSIONS:
        words = ("-m", "pip", "install", "--quiet", "--no-deps", "--disable-pip-version-check")
        done = subprocess.run(
            [sys.executable, *words, "--target", str(folder / version), f"eclipse-zenoh=={version}"],
            capture_output=True,
            timeout=100,
            check=False,
        )
        if done.returncode:
            pytest.skip(f"eclipse-zenoh {version} cannot be installed here: {done.stderr.decode()[-200:]}")
    return folder


@pytest.fixture(params=some(VERSIONS, "1.5.1"))
def version(request: pytest.FixtureRequest, wheels: Path) -> Path:
    return wheels / str(request.param)


def old(machine: Machine, version: Path, role: str) -> Program:
    """A process that finds the old version before the installed one."""
    program = str(Path(__file__).with_name("old_zenoh.py"))
    found = machine.env.get("PYTHONPATH", "")
    machine.env["PYTHONPATH"] = os.pathsep.join(filter(None, (str(version), found)))
    try:
        return machine.start_python(program, role)
    finally:
        machine.env["PYTHONPATH"] = found


def latched(machine: Machine, folder: Path, name: str) -> Program:
    return machine.start_python(LATCHED, name, cwd=folder)


@slow
def test_an_old_router_is_joined(machine: Machine, version: Path) -> None:
    """Nodes find each other through it, are listed and have their parameters read; when it ends they go on."""
    router = old(machine, version, "router")
    router.wait_for("READY")
    machine.start("run", "nodes.talker:Talker", "-p", "rate:=20.0")
    listener = machine.start("run", "nodes.listener:Listener")
    listener.wait_for("I heard")
    assert machine.run("node", "list").split() == ["/listener", "/talker"]
    assert machine.run("param", "get", "/talker", "rate") == "Double value is: 20.0\n"
    router.end()
    listener.text = ""
    listener.wait_for("I heard")
    machine.until(lambda: "/talker" in machine.run("node", "list", code=None), "a node has taken over")


@slow
def test_an_old_peer_is_heard_and_hears(machine: Machine, version: Path) -> None:
    """Both ways, with the 33 bytes beside each message, and gone from the graph when it is killed."""
    machine.start("run", "nodes.talker:Talker", "-p", "rate:=20.0")
    # First the rendezvous: what 1.5.1 and 1.7.2 announce before they reach a router, no router ever hears of.
    machine.until(lambda: "/talker" in machine.run("node", "list", code=None), "there is a rendezvous")
    ear = old(machine, version, "hear")
    ear.wait_for("HEARD Hello World: ")
    ear.wait_for(" 33\n")
    listener = machine.start("run", "nodes.listener:Listener")
    mouth = old(machine, version, "say")
    listener.wait_for("I heard: [old ")
    machine.until(lambda: machine.run("node", "list").count("/old\n/old\n") == 1, "both old peers are listed")
    for peer in (ear, mouth):
        peer.process.kill()
    machine.until(lambda: "/old" not in machine.run("node", "list"), "the old peers are gone")


@slow
@pytest.mark.parametrize("order", ["publisher first", "subscription first"])
def test_an_old_publisher_keeps_messages_for_us(machine: Machine, version: Path, tmp_path: Path, order: str) -> None:
    """A transient-local subscription gets the last three of five, whoever was there first."""
    machine.start("run", "nodes.draw_circle:DrawCircle")  # somebody to be the rendezvous
    machine.until(lambda: "/draw_circle" in machine.run("node", "list", code=None), "there is a rendezvous")
    if order == "publisher first":
        old(machine, version, "say-latched").wait_for("SAID")
        ear = latched(machine, tmp_path, "Hear")
    else:
        ear = latched(machine, tmp_path, "Hear")
        machine.until(lambda: "/hear" in machine.run("node", "list"), "the listener is up")
        old(machine, version, "say-latched")
    for n in (3, 4, 5):
        ear.wait_for(f"HEARD old {n}\n")
    if order == "publisher first":
        assert "old 2\n" not in ear.text


@slow
@pytest.mark.parametrize("order", ["publisher first", "subscription first"])
def test_we_keep_messages_for_an_old_subscription(machine: Machine, version: Path, tmp_path: Path, order: str) -> None:
    """The other way round."""
    machine.start("run", "nodes.draw_circle:DrawCircle")
    machine.until(lambda: "/draw_circle" in machine.run("node", "list", code=None), "there is a rendezvous")
    if order == "publisher first":
        latched(machine, tmp_path, "Say").wait_for("SAID")
        ear = old(machine, version, "hear-latched")
    else:
        ear = old(machine, version, "hear-latched")
        ear.wait_for("READY")
        latched(machine, tmp_path, "Say")
    for n in (3, 4, 5):
        ear.wait_for(f"HEARD new {n} 33\n")
