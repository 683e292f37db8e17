"""Two hosts and a network between them: a graph here, and a robot there behind a router with rmw_zenoh's settings."""

from __future__ import annotations

import shutil
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
import trustme
import zenoh

from graphflow.errors import TransportError
from graphflow.graph.net import read_profile
from graphflow.transport import link
from graphflow.transport.link import dial
from tests.cases import slow
from tests.conftest import PROGRAMS, Machine, Program
from tests.network.hosts import Hosts, why_not

NEAR = "nodes:\n  /draw_circle: {class: nodes.draw_circle:DrawCircle}\n"
ROUTER = str(Path(__file__).parents[1] / "network" / "rmw_router.py")


@pytest.fixture(scope="module")
def allowed() -> None:
    """Skip where a test may not make hosts."""
    if reason := why_not():
        pytest.skip(reason)


@pytest.fixture
def hosts(allowed: None) -> Iterator[Hosts]:
    with Hosts() as made:
        yield made


@pytest.fixture
def near(hosts: Hosts, tmp_path: Path) -> Iterator[Machine]:
    """The laptop."""
    (tmp_path / "near").mkdir()
    machine = Machine(tmp_path / "near", hosts.near.command())
    yield machine
    machine.close()


@pytest.fixture
def far(hosts: Hosts, near: Machine, tmp_path: Path) -> Iterator[Machine]:
    """The robot; its nodes stay on its loopback, as ROS 2's do."""
    (tmp_path / "far").mkdir()
    machine = Machine(tmp_path / "far", hosts.far.command())
    machine.env["GRAPHFLOW_DOMAIN"] = near.env["GRAPHFLOW_DOMAIN"]
    machine.env["GRAPHFLOW_RENDEZVOUS"] = "tcp/127.0.0.1:7447"
    yield machine
    machine.close()


def start_robot(far: Machine) -> tuple[Program, Program]:
    router = far.start_python(ROUTER)
    router.wait_for("router up")
    node = far.start("run", "nodes.turtlesim:TurtleSim")
    node.wait_for("Spawning turtle [turtle1]")
    return router, node


def start_graph(near: Machine, tmp_path: Path, *options: str) -> Program:
    file = tmp_path / "near.yaml"
    file.write_text(NEAR)
    return near.start("up", *options, str(file))


def reaches(machine: Machine, node: str) -> bool:
    return node in machine.run("node", "list", code=None).split()


@slow
@pytest.mark.real
def test_data_services_and_parameters_both_ways(hosts: Hosts, near: Machine, far: Machine, tmp_path: Path) -> None:
    """50 ms away and with every fiftieth packet lost, either side's nodes are as the other's own."""
    hosts.delay, hosts.loss = 0.05, 0.02
    start_robot(far)
    graph = start_graph(near, tmp_path, "--connect", f"tcp/{hosts.far.address}:7447")
    graph.wait_for(f"linked to tcp/{hosts.far.address}:7447")
    near.until(lambda: reaches(near, "/turtlesim") and reaches(far, "/draw_circle"), "both see both")

    assert "theta: " in near.run("topic", "echo", "/turtle1/pose", "--once")
    assert "x: 2.0" in far.run("topic", "echo", "/turtle1/cmd_vel", "--once")
    assert "name='turtle2'" in near.run("service", "call", "/spawn", "turtlesim/srv/Spawn", "{x: 2.0, y: 2.0}")
    near.run("param", "set", "/turtlesim", "background_r", "7")
    assert far.run("param", "get", "/turtlesim", "background_r") == "Integer value is: 7\n"
    far.run("param", "set", "/draw_circle", "linear", "0.5")
    assert near.run("param", "get", "/draw_circle", "linear") == "Double value is: 0.5\n"
    # What the graph drives has moved: its commands arrive, and not only at tools.
    echo = near.start("topic", "echo", "/turtle1/pose")
    echo.wait_for("linear_velocity: 0.5\n")
    echo.end()
    assert graph.end() == 0


@slow
@pytest.mark.real
def test_an_outage_is_told_and_ends(hosts: Hosts, near: Machine, far: Machine, tmp_path: Path) -> None:
    """With the cable cut the graph runs on and says so; mended, both sides find each other again."""
    hosts.delay = 0.05
    start_robot(far)
    endpoint = f"tcp/{hosts.far.address}:7447"
    graph = start_graph(near, tmp_path, "--connect", endpoint)
    graph.wait_for(f"linked to {endpoint}")
    near.until(lambda: reaches(near, "/turtlesim"), "the robot is seen")

    hosts.is_cut = True
    graph.wait_for(f"lost the link to {endpoint}")
    near.until(lambda: not reaches(near, "/turtlesim"), "what cannot be reached is not listed")
    near.until(lambda: not reaches(far, "/draw_circle"), "nor there")
    hosts.is_cut = False
    graph.text = ""
    graph.wait_for(f"linked to {endpoint}")
    near.until(lambda: reaches(near, "/turtlesim") and reaches(far, "/draw_circle"), "both see both again")
    assert "theta: " in near.run("topic", "echo", "/turtle1/pose", "--once")
    assert graph.end() == 0


@slow
@pytest.mark.real
def test_what_a_latched_topic_said_meanwhile_is_heard(
    hosts: Hosts, near: Machine, far: Machine, tmp_path: Path
) -> None:
    """After an outage a listener gets what it missed, and nothing twice."""
    endpoint = f"tcp/{hosts.far.address}:7447"
    far.start_python(ROUTER).wait_for("router up")
    shutil.copy(PROGRAMS / "network" / "speaker.py", tmp_path)
    far.start("run", "speaker:Speaker", cwd=tmp_path).wait_for("listening")
    start_graph(near, tmp_path, "--connect", endpoint).wait_for(f"linked to {endpoint}")
    near.until(lambda: reaches(near, "/speaker"), "the robot is seen")
    echo = near.start("topic", "echo", "/said", "--qos-durability", "transient_local")
    far.run("service", "call", "/speak", "std_srvs/srv/Trigger")
    echo.wait_for("word 1")

    hosts.is_cut = True
    near.until(lambda: not reaches(near, "/speaker"), "the near side has noticed")
    far.run("service", "call", "/speak", "std_srvs/srv/Trigger")
    hosts.is_cut = False
    echo.wait_for("word 2")
    far.run("service", "call", "/speak", "std_srvs/srv/Trigger")
    echo.wait_for("word 3")
    echo.end()
    assert [line for line in echo.text.splitlines() if "word" in line] == [f"data: word {n}" for n in (1, 2, 3)]


@slow
@pytest.mark.real
def test_a_robot_that_comes_later_is_waited_for(hosts: Hosts, near: Machine, far: Machine, tmp_path: Path) -> None:
    """The graph starts without it, and says that nobody answers; then the robot is switched on."""
    endpoint = f"tcp/{hosts.far.address}:7447"
    graph = start_graph(near, tmp_path, "--connect", endpoint)
    graph.wait_for(f"{endpoint}: no answer yet; still trying")
    assert "graph near is up" in graph.text
    start_robot(far)
    graph.wait_for(f"linked to {endpoint}")
    near.until(lambda: reaches(near, "/turtlesim"), "the robot is seen")
    assert graph.end() == 0


@slow
@pytest.mark.real
def test_commands_reach_a_robot_without_a_graph_of_ones_own(hosts: Hosts, near: Machine, far: Machine) -> None:
    """On a laptop where nothing runs, every verb takes --connect."""
    start_robot(far)
    reach = ("--connect", f"tcp/{hosts.far.address}:7447")
    assert "/turtlesim" in near.run(*reach, "node", "list")
    assert near.run(*reach, "param", "get", "/turtlesim", "background_r") == "Integer value is: 69\n"
    assert "theta: " in near.run(*reach, "topic", "echo", "/turtle1/pose", "--once")
    near.run(*reach, "topic", "pub", "--once", "/turtle1/cmd_vel", "geometry_msgs/msg/Twist", "{linear: {x: 1.0}}")
    text = near.run("--connect", f"tcp/{hosts.far.address}:7448", "node", "list", code=3)
    assert "nor where --connect or --net points" in text


@slow
@pytest.mark.real
def test_other_users_of_other_machines_are_no_strangers(hosts: Hosts, near: Machine, far: Machine) -> None:
    """A graphflow rendezvous on the robot belongs to the robot's user, whoever that is, and is linked all the same."""
    far.start("run", "nodes.turtlesim:TurtleSim").wait_for("Spawning")
    far.start_python(str(PROGRAMS / "network" / "stranger.py")).wait_for("declared")
    assert "/turtlesim" in far.run("node", "list")


KILLER = """\
from graphflow import Client, Node, task
from graphflow.msgs.turtlesim.srv import Kill


class Killer(Node):
    kill = Client(Kill, "/kill")

    @task
    async def work(self) -> None:
        await self.kill.call(Kill.Request(name="turtle1"))
"""
CERTIFICATES = """\
listen: {listen}
connect: [{connect}]
tls: {{ca: {ca}, certificate: {certificate}, key: {key}}}
allow: [{allow}]
"""


def profile(
    folder: Path,
    name: str,
    ca: trustme.CA,
    address: str,
    *,
    listen: str = "null",
    connect: str = "",
    allow: str = "/turtle1/**, /spawn",
) -> str:
    """Write a net profile with a certificate of its own; returns its path."""
    issued = ca.issue_cert(address)
    files = {n: folder / f"{name}.{n}" for n in ("ca", "certificate", "key")}
    ca.cert_pem.write_to_path(files["ca"])
    issued.cert_chain_pems[0].write_to_path(files["certificate"])
    issued.private_key_pem.write_to_path(files["key"])
    path = folder / f"net_{name}.yaml"
    path.write_text(
        CERTIFICATES.format(listen=listen, connect=connect, allow=allow, **{k: str(v) for k, v in files.items()})
    )
    return str(path)


@slow
@pytest.mark.real
def test_a_net_profile_lets_in_who_has_a_certificate_and_out_what_is_allowed(
    hosts: Hosts, near: Machine, far: Machine, tmp_path: Path
) -> None:
    """Two machines with certificates of one authority share what both allow; others get no connection at all."""
    ca, stranger = trustme.CA(), trustme.CA()
    endpoint = f"tls/{hosts.far.address}:7448"
    there = profile(tmp_path, "far", ca, hosts.far.address, listen="tls/0.0.0.0:7448")
    more = "/turtle1/**, /spawn, /news"
    here = profile(tmp_path, "near", ca, hosts.near.address, connect=endpoint, allow=more)
    other = profile(tmp_path, "other", stranger, hosts.near.address, connect=endpoint)
    far.start("--net", there, "run", "nodes.turtlesim:TurtleSim").wait_for("Spawning")

    graph = start_graph(near, tmp_path, "--net", other)
    graph.wait_for("no answer yet")
    assert not reaches(near, "/turtlesim")
    graph.end()

    graph = start_graph(near, tmp_path, "--net", here)
    graph.wait_for(f"linked to {endpoint}")
    near.until(lambda: reaches(near, "/turtlesim"), "the robot is seen")
    assert "theta: " in near.run("topic", "echo", "/turtle1/pose", "--once")
    near.run("service", "call", "/spawn", "turtlesim/srv/Spawn", "{x: 2.0, y: 2.0}")
    text = near.run("param", "get", "/turtlesim", "background_r", code=None)
    assert f"/turtlesim/get_parameters does not pass the net profile {here}, which allows" in text
    assert f"or beyond the net profile {here}" in near.run("up", "turtlesim", code=1)
    assert f"/kill does not pass the net profile {here}" in near.run(
        "service", "call", "/kill", "turtlesim/srv/Kill", "{name: turtle1}", code=1
    )
    (tmp_path / "killer.py").write_text(KILLER)
    killer = near.start("run", "killer.py", cwd=tmp_path)
    killer.wait_for(f"/kill does not pass the net profile {here}, which allows {more}; if its node is on")
    killer.end()
    far.start("topic", "pub", "-r", "5", "/news", "std_msgs/msg/String", "{data: x}").wait_for("publishing")
    silent = near.run("topic", "echo", "/news", "--timeout", "7", code=4)
    assert "/news is published on another machine, whose net profile may not pass it" in silent
    assert graph.end(signal.SIGTERM) == 0


@pytest.fixture
def net(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A net profile that is in force."""
    made = profile(tmp_path, "here", trustme.CA(), "127.0.0.1", connect="tls/127.0.0.1:1")
    monkeypatch.setenv("GRAPHFLOW_NET", made)
    return Path(made)


@pytest.mark.parametrize(
    ("connect", "text"),
    [
        ("robot", "GRAPHFLOW_CONNECT: 'robot' is not an endpoint"),
        ("tcp/127.0.0.1:1 udp/127.0.0.1:2", "udp"),
    ],
)
def test_an_endpoint_that_is_misspelt(monkeypatch: pytest.MonkeyPatch, connect: str, text: str) -> None:
    """It is told before anything is opened."""
    monkeypatch.setenv("GRAPHFLOW_CONNECT", connect)
    with pytest.raises(TransportError, match=text):
        dial()


def test_with_a_profile_everything_is_encrypted(net: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A plain endpoint beside it is refused, with what to write."""
    monkeypatch.setenv("GRAPHFLOW_CONNECT", "tcp/127.0.0.1:1")
    with pytest.raises(TransportError, match=r"tcp/.*:1: with a net profile everything is encrypted; write tls/"):
        dial()


def test_a_dial_beyond_this_machine_has_a_short_lease(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing tells the other side that the way between has been cut."""
    dialled: list[zenoh.Config] = []
    monkeypatch.setenv("GRAPHFLOW_CONNECT", "tcp/192.0.2.1:7447")
    monkeypatch.setattr(link, "open_session", dialled.append)
    dial()
    assert dialled[0].get_json("transport/link/tx/lease") == "4000"


def test_without_endpoints_nobody_is_dialled(monkeypatch: pytest.MonkeyPatch) -> None:
    """A profile alone may only listen."""
    monkeypatch.delenv("GRAPHFLOW_CONNECT", raising=False)
    monkeypatch.delenv("GRAPHFLOW_NET", raising=False)
    assert dial() is None


def test_only_what_a_profile_allows_passes_to_others(net: Path) -> None:
    """Over TLS the names that are allowed, with their latched messages and who is there; on this machine everything."""
    access = link._access(read_profile(net), 3)

    assert access["default_permission"] == "deny"
    assert {(p["rules"][0], p["subjects"][0]) for p in access["policies"]} == {("here", "here"), ("there", "there")}
    assert {s["id"]: s["link_protocols"] for s in access["subjects"]} == {"here": ["tcp"], "there": ["tls"]}
    keys = {rule["id"]: rule["key_exprs"] for rule in access["rules"]}
    assert "**" in keys["here"]
    assert keys["there"][0] == "@ros2_lv/3/**"
    said, asked, other = (zenoh.KeyExpr(f"3/{name}/type/hash") for name in ("turtle1/pose", "spawn", "kill"))
    allowed = [zenoh.KeyExpr(key) for key in keys["there"]]
    assert [any(key.includes(name) for key in allowed) for name in (said, asked, other)] == [True, True, False]
    assert not any(key.intersects(zenoh.KeyExpr("@graphflow/**")) for key in allowed)
