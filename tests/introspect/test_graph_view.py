"""A look at the graph from outside."""

from __future__ import annotations

import re
import time
from collections.abc import Iterator
from unittest.mock import patch

import pytest

from graphflow.errors import CallError, CallTimeout, RemoteError, ServerLost, ServiceUnavailable, SupervisorError
from graphflow.introspect import graph_view as module
from graphflow.introspect.graph_view import NODE_SERVICES, View, refuse_taken_names
from graphflow.msgs import registry
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.transport.base import Answer
from graphflow.wire import net, process
from graphflow.wire.liveliness import NODES, Entity, Kind, watch_key

ADD, TYPE = "/office/clerk/add", "example_interfaces/srv/AddTwoInts"
HASH = registry.hash_of(TYPE)
CLERK = Entity(7, "z1", 0, 0, Kind.NODE, "/office", "clerk")
ROS = Entity(7, "z9", 0, 0, Kind.NODE, "/", "ros")
HIDDEN = Entity(7, "z1", 2, 2, Kind.NODE, "/", "_tool")


def server(type_: str = TYPE, hash_: str = HASH, node: str = "clerk") -> Entity:
    return Entity(7, "z1", 0, 1, Kind.SERVICE, "/office", node, ADD, type_, hash_)


class Client:
    """Stands for the session: it has tokens, and an answer."""

    def __init__(self) -> None:
        self.entities = [CLERK, server(), ROS, HIDDEN]
        self.answer: Answer | Exception | None = None
        self.asked: list[tuple[str, bytes]] = []
        self.is_closed = False
        self.profiles: list[str] = []
        self.elsewhere: list[Entity] = []

    def tokens(self, key: str) -> list[str]:
        if key == watch_key(7):
            return [entity.token for entity in self.entities]
        if key == net.watch_key(7):
            return self.profiles
        if key == NODES:
            return [entity.token for entity in self.entities + self.elsewhere]
        assert key == process.watch_key(7)
        return [process.token(7, "z1"), "@graphflow/7/proc/z2/0/12/elsewhere", "@graphflow/7/proc/nonsense"]

    def call(self, key: str, payload: bytes, attachment: bytes, timeout: float) -> Answer | None:
        self.asked.append((key, payload))
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer

    def reports(self, key: str, timeout: float) -> list[bytes]:
        return [key.encode(), str(timeout).encode()]

    def close(self) -> None:
        self.is_closed = True


@pytest.fixture
def client() -> Iterator[Client]:
    made = Client()
    with patch.object(module, "Client", lambda: made):
        yield made


@pytest.fixture
def view(client: Client) -> View:
    return View(7)


def test_it_is_closed_at_the_end(client: Client) -> None:
    """Also when something goes wrong."""
    with pytest.raises(LookupError), View(7):
        assert not client.is_closed
        raise LookupError
    assert client.is_closed


def test_it_shows_one_moment(view: View, client: Client) -> None:
    """Later changes are seen after `refresh`."""
    client.entities.append(Entity(7, "z1", 3, 3, Kind.NODE, "/", "late"))
    assert "/late" not in view.cache.nodes()
    view.refresh()
    assert "/late" in view.cache.nodes()


@pytest.mark.parametrize("name", ["/office/clerk", "office/clerk"])
def test_a_node_by_its_name(view: View, name: str) -> None:
    """With or without the leading slash."""
    assert view.node(name) == "/office/clerk"


def test_a_node_that_is_not_there(view: View, client: Client) -> None:
    """The nearest node is suggested, but never a hidden one; an empty domain is mentioned."""
    with pytest.raises(CallError, match=r"^there is no node /office/clrk; did you mean '/office/clerk'\?$"):
        view.node("office/clrk")
    client.entities = [HIDDEN]
    view.refresh()
    with pytest.raises(CallError, match=r"^there is no node /_tol; domain 7 has no nodes$"):
        view.node("/_tol")
    client.elsewhere = [ROS._replace(domain=9)]
    alone = r"; this domain, 7, has no other nodes; domain 9 has 1: graphflow --domain 9 \.\.\.$"
    with pytest.raises(CallError, match=f"^there is no node /ros{alone}"):
        view.node("/ros")
    with pytest.raises(ServiceUnavailable, match=f"^no node offers the service /spawn{alone}"):
        view.service_types("/spawn")


def test_the_type_of_a_service(view: View) -> None:
    """A service has its server's type; for a missing one, the nearest is suggested."""
    assert view.service_types(ADD) == [TYPE]
    with pytest.raises(ServiceUnavailable, match=f"^no node offers the service /office/ad; did you mean '{ADD}'"):
        view.service_types("/office/ad")


def test_waiting_for_a_service(view: View, client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    """The graph is read again until the service is offered, or the timeout."""
    client.entities = [CLERK]
    view.refresh()
    looks: list[float] = []

    def sleep(seconds: float) -> None:
        looks.append(seconds)
        if len(looks) == 3:
            client.entities.append(server())

    monkeypatch.setattr(time, "sleep", sleep)
    view.wait_for_service(ADD, 100.0)
    assert len(looks) == 3
    with pytest.raises(ServiceUnavailable, match="no node offers"):
        view.wait_for_service("/other", -1.0)


def test_a_call(view: View, client: Client) -> None:
    """The request goes to the service's key as bytes, and the answer comes back as a message."""
    client.answer = Answer(AddTwoInts.Response(sum=3).to_bytes(), None, False)
    request = AddTwoInts.Request(a=1, b=2)
    assert view.call(ADD, TYPE, request) == AddTwoInts.Response(sum=3)
    assert client.asked == [(server().data_key, request.to_bytes())]


@pytest.mark.parametrize(
    ("answer", "error", "text"),
    [
        (TimeoutError(), CallTimeout, f"{ADD} did not answer within 1.5 s"),
        (Answer(b'{"type": "ValueError", "message": "no"}', None, True), RemoteError, "raised ValueError: no"),
        (None, ServerLost, "the server went away before it answered; its terminal may say why"),
    ],
)
def test_a_call_that_fails(
    view: View, client: Client, answer: Answer | Exception | None, error: type[CallError], text: str
) -> None:
    """Each failure has its own name."""
    client.answer = answer
    with pytest.raises(error, match=text):
        view.call(ADD, TYPE, AddTwoInts.Request(), 1.5)


@pytest.mark.parametrize(
    ("zid", "allow", "text"),
    [
        ("z9", ["/spawn"], f"{ADD} does not pass the net profile /lab.yaml, which allows /spawn; if its node is on"),
        (
            "z9",
            ["/office/**"],
            "does not answer: the net profile of its machine does not pass the call",
        ),
        ("z1", ["/spawn"], "the server went away before it answered"),
    ],
)
def test_a_net_profile_is_told(view: View, client: Client, zid: str, allow: list[str], text: str) -> None:
    """A net profile is named if the server is on another machine and the name may not pass."""
    client.profiles = [net.token(7, "z5", "/lab.yaml", allow)]
    client.entities = [server()._replace(zid=zid)]
    view.refresh()
    with pytest.raises(ServerLost, match=re.escape(text)):
        view.call(ADD, TYPE, AddTwoInts.Request(), 1.5)
    assert view.owner("/office/ros").endswith(f"beyond the net profile /lab.yaml, which allows {allow[0]}")


NEWS = Entity(7, "z9", 0, 1, Kind.PUBLISHER, "/", "ros", "/news", "std_msgs/msg/String", "RIHS01_0")
BEYOND = "/news is published on another machine, whose net profile may not pass it: add it to `allow` there"


@pytest.mark.parametrize(
    ("publishers", "allow", "text"),
    [
        ([NEWS], ["/chat"], "/news does not pass the net profile /lab.yaml, which allows /chat; if its node is on"),
        ([NEWS], ["/news"], BEYOND),
        ([NEWS], [], ""),
        ([NEWS, NEWS._replace(zid="z1")], ["/chat"], ""),
        ([], ["/chat"], ""),
    ],
)
def test_what_keeps_messages_back(
    view: View, client: Client, publishers: list[Entity], allow: list[str], text: str
) -> None:
    """A net profile, here or there, if all publishers are beyond a link; nothing else is known."""
    client.profiles = [net.token(7, "z5", "/lab.yaml", allow)] if allow else []
    client.entities = [CLERK, *publishers]
    view.refresh()
    assert view.why_silent("/news")[: len(text) or None] == text


@pytest.mark.parametrize(
    ("other", "text"),
    [
        (server(type_="std_srvs/srv/Trigger"), f"{ADD} is of type std_srvs/srv/Trigger, not {TYPE}"),
        (server(hash_="RIHS01_0"), f"{ADD}: the server's definition of {TYPE} differs from the one here"),
    ],
)
def test_why_there_was_no_answer(view: View, client: Client, other: Entity, text: str) -> None:
    """A server of another type never gets the call, and the error says so."""
    client.entities = [CLERK, other]
    view.refresh()
    with pytest.raises(ServerLost, match=text):
        view.call(ADD, TYPE, AddTwoInts.Request())


def test_a_token_that_somebody_forges(view: View, client: Client) -> None:
    """A forged token does not hide the real server's type: all announced types are returned."""
    forged = server(type_="a_msgs/srv/A", node="aaa")
    client.entities = [CLERK, forged, server(hash_="RIHS01_0", node="aab"), server()]
    view.refresh()
    assert view.service_types(ADD) == ["a_msgs/srv/A", TYPE]
    with pytest.raises(ServerLost, match="the server went away"):
        view.call(ADD, TYPE, AddTwoInts.Request())
    client.entities.remove(server())
    view.refresh()
    with pytest.raises(ServerLost, match=f"the server's definition of {TYPE} differs"):
        view.call(ADD, TYPE, AddTwoInts.Request())


def test_asking_a_process(view: View, client: Client) -> None:
    """Its answer, or that it is gone; and what all of them report."""
    client.answer = Answer(b"yes", None, False)
    assert view.ask("@graphflow/7/groups/z1", b"?", 1.0).payload == b"yes"
    assert client.asked == [("@graphflow/7/groups/z1", b"?")]
    client.answer = None
    with pytest.raises(ServerLost, match="the process has ended"):
        view.ask("@graphflow/7/groups/z1", b"?", 1.0)
    assert view.reports("@graphflow/7/waits/*", 0.5) == [b"@graphflow/7/waits/*", b"0.5"]


def test_processes_and_owners(view: View) -> None:
    """By session, without what is no token; the owner of a node is its process, or a session that is not ours."""
    assert set(view.processes()) == {"z1", "z2"}
    assert str(view.processes()["z2"]) == "process 12 on elsewhere"
    assert view.owner("/office/clerk").startswith("process ")
    assert view.owner("/ros") == "session z9, no graphflow process"


def parameters_of(node: Entity) -> Entity:
    """The service that every node has."""
    type_ = NODE_SERVICES["get_parameters"]
    return node._replace(eid=9, kind=Kind.SERVICE, name=f"{node.node_name}/get_parameters", type=type_, hash=HASH)


@pytest.mark.parametrize("answer", [Answer(b"?", None, True), TimeoutError()])
def test_names_that_are_taken(client: Client, answer: Answer | Exception) -> None:
    """Taken names are listed with owners and a remedy; free ones are not; the view is closed.

    Whoever answers, or keeps the question as a process that is stopped does, is there.
    """
    client.entities += [parameters_of(CLERK), parameters_of(ROS)]
    client.answer = answer
    refuse_taken_names(["/a", "/b"], 7)
    assert client.is_closed
    assert client.asked == []
    with pytest.raises(SupervisorError) as caught:
        refuse_taken_names(["/ros", "/a", "/office/clerk"], 7, "call it otherwise")
    assert [key for key, _ in client.asked] == [parameters_of(node).data_key for node in (CLERK, ROS)]
    text = str(caught.value)
    assert text.startswith("already in domain 7: /office/clerk (process ")
    assert "; /ros (session z9, no graphflow process). Stop those nodes, call it otherwise, or choose another" in text


def test_names_that_are_only_announced(client: Client, caplog: pytest.LogCaptureFixture) -> None:
    """A forged token does not keep a node from starting, whatever services it announces."""
    client.entities += [parameters_of(ROS)]
    refuse_taken_names(["/ros", "/office/clerk"], 7)
    assert "/ros is announced in domain 7 by session z9, no graphflow process, but does not answer" in caplog.text
    assert "/office/clerk is announced in domain 7 by process " in caplog.text


@pytest.mark.parametrize("code", [3, 1])
def test_where_nothing_runs_no_name_is_taken(code: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another trouble is one."""

    def nobody() -> Client:
        raise SupervisorError("nothing is running", code)

    monkeypatch.setattr(module, "Client", nobody)
    if code == 3:
        refuse_taken_names(["/a"], 7)
    else:
        with pytest.raises(SupervisorError, match="nothing is running"):
            refuse_taken_names(["/a"], 7)
