"""What a running talker puts on the network, read by raw Zenoh beside it; and sessions that end."""

from __future__ import annotations

import asyncio
import json
import struct
import time
from collections.abc import Iterator

import pytest
import zenoh

from graphflow.qos import Durability, Qos
from graphflow.transport.base import Answer
from graphflow.transport.inbox import Inbox
from graphflow.transport.zenoh import ZenohSession
from graphflow.wire.gid import gid
from tests.cases import slow
from tests.conftest import LIMIT, Machine
from tests.until import eventually, until

pytestmark = pytest.mark.real

GET_PARAMETERS = "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"
STRING = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"


@pytest.fixture
def raw(machine: Machine) -> Iterator[zenoh.Session]:
    """A session that knows nothing of graphflow, at the machine's rendezvous."""
    talker = machine.start("run", "nodes.talker:Talker", "-p", "rate:=50.0", "-r", "__ns:=/robot1")
    talker.wait_for("Publishing")
    config = {"mode": "client", "connect": {"endpoints": [machine.endpoint]}, "scouting": {"delay": 0}}
    with zenoh.open(zenoh.Config.from_json5(json.dumps(config))) as session:
        yield session
    assert talker.end() == 0


def tokens(session: zenoh.Session, domain: int) -> list[str]:
    """Those of the talker, once the session knows the last that it declares."""

    def complete() -> list[str]:
        replies = session.liveliness().get(f"@ros2_lv/{domain}/**", timeout=5.0)
        found = sorted(str(reply.ok.key_expr) for reply in replies if reply.ok is not None)
        return found if all(any(name in token for token in found) for name in ("chatter", "%rosout")) else []

    found: list[str] = until(complete)
    return found


def test_a_running_talker_is_exactly_what_the_specification_says(raw: zenoh.Session, machine: Machine) -> None:
    """Tokens, data key, payload, attachment and GID, byte for byte."""
    samples: list[zenoh.Sample] = []
    key = f"{machine.domain}/robot1/chatter/std_msgs::msg::dds_::String_/{STRING}"
    with raw.declare_subscriber(f"{machine.domain}/**", samples.append):
        until(lambda: sum("chatter" in str(s.key_expr) for s in samples) >= 3)
    said = [s for s in samples if "chatter" in str(s.key_expr)]

    assert {str(s.key_expr) for s in said} == {key}
    publisher = next(t for t in tokens(raw, machine.domain) if "/MP/" in t and "chatter" in t)
    head, _, tail = publisher.partition("/MP/")
    assert tail == f"%/%robot1/talker/%robot1%chatter/std_msgs::msg::dds_::String_/{STRING}/::,10:,:,:,,"
    space, domain, zid, nid, eid = head.split("/")
    assert (space, domain) == ("@ros2_lv", str(machine.domain))
    assert zid == zid.lower()
    assert not zid.startswith("0")
    assert f"@ros2_lv/{domain}/{zid}/{nid}/{nid}/NN/%/%robot1/talker" in tokens(raw, machine.domain)
    assert eid != nid

    sequences = []
    for sample in said:
        payload = sample.payload.to_bytes()
        assert payload[:4] == bytes.fromhex("00010000")
        (length,) = struct.unpack_from("<I", payload, 4)
        assert payload[8 : 8 + length].startswith(b"Hello World: ")
        assert payload[8 + length - 1] == 0
        assert str(sample.encoding) == "zenoh/bytes"
        assert sample.attachment is not None
        sequence, stamp, size, sender = struct.unpack("<qqB16s", sample.attachment.to_bytes())
        assert size == 16
        assert sender == gid(publisher)
        assert abs(stamp - time.time_ns()) < 60e9
        sequences.append(sequence)
    assert sequences == list(range(sequences[0], sequences[0] + len(sequences)))


@slow
def test_a_node_has_the_endpoints_every_ros_node_has(raw: zenoh.Session, machine: Machine) -> None:
    """/rosout latched for ten seconds, /parameter_events and the services, with ROS 2's profiles and hashes."""
    found = [t.split("/", 9) for t in tokens(raw, machine.domain)]
    rest = {t[9].split("/")[0]: (t[5], t[9].split("/", 1)[1]) for t in found if len(t) > 9}

    log = "rcl_interfaces::msg::dds_::Log_/RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac"
    assert rest["%rosout"] == ("MP", f"{log}/:1:,1000:,:10,0:,,")
    digest = "RIHS01_043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204"
    event = f"rcl_interfaces::msg::dds_::ParameterEvent_/{digest}"
    assert rest["%parameter_events"] == ("MP", f"{event}/::,1000:,:,:,,")
    services = {name: kind for name, (kind, _) in rest.items() if kind == "SS"}
    assert set(services) == {
        f"%robot1%talker%{name}"
        for name in (
            "describe_parameters",
            "get_logger_levels",
            "get_parameter_types",
            "get_parameters",
            "get_type_description",
            "list_parameters",
            "set_logger_levels",
            "set_parameters",
            "set_parameters_atomically",
        )
    }
    get = f"rcl_interfaces::srv::dds_::GetParameters_/{GET_PARAMETERS}"
    describe = "type_description_interfaces::srv::dds_::GetTypeDescription_"
    digest = "RIHS01_69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5"
    assert rest["%robot1%talker%get_type_description"] == ("SS", f"{describe}/{digest}/::,10:,:,:,,")
    assert rest["%robot1%talker%get_parameters"] == ("SS", f"{get}/::,1000:,:,:,,")


@slow
def test_a_foreign_client_is_answered_as_ros_2_answers(raw: zenoh.Session, machine: Machine) -> None:
    """A query with rmw_zenoh's settings gets one reply: CDR, and its own sequence number and GID beside it."""
    key = f"{machine.domain}/robot1/talker/get_parameters/rcl_interfaces::srv::dds_::GetParameters_/{GET_PARAMETERS}"
    mine = bytes(range(16))
    querier = raw.declare_querier(
        key, target=zenoh.QueryTarget.ALL_COMPLETE, consolidation=zenoh.ConsolidationMode.NONE, timeout=5.0
    )
    request = bytes.fromhex("00010000 01000000 05000000 72617465 00")
    replies = list(querier.get(payload=request, attachment=struct.pack("<qqB16s", 41, 1, 16, mine)))

    (reply,) = replies
    assert reply.ok is not None
    assert str(reply.ok.key_expr) == key
    assert reply.ok.attachment is not None
    sequence, stamp, size, client = struct.unpack("<qqB16s", reply.ok.attachment.to_bytes())
    assert (sequence, size, client) == (41, 16, mine)
    assert stamp > 1
    payload = reply.ok.payload.to_bytes()
    assert payload[4:9] == bytes.fromhex("01000000 03")
    assert struct.pack("<d", 50.0) in payload


@slow
def test_a_malformed_request_gets_an_error_and_the_service_goes_on(raw: zenoh.Session, machine: Machine) -> None:
    """Whoever sends rubbish is told so; nothing else changes."""
    key = f"{machine.domain}/robot1/talker/get_parameters/rcl_interfaces::srv::dds_::GetParameters_/{GET_PARAMETERS}"
    beside = struct.pack("<qqB16s", 1, 1, 16, bytes(16))
    for payload, attachment in (
        (b"\0\1", beside),
        (b"", beside),
        (bytes.fromhex("00010000ffffffff"), beside),
        (b"x", b""),
    ):
        (reply,) = raw.get(key, payload=payload, attachment=attachment, timeout=5.0)
        assert reply.err is not None
        assert "DecodeError" in reply.err.payload.to_string()
    assert "50.0" in machine.run("param", "get", "/robot1/talker", "rate")


async def test_publishers_end_while_their_listeners_do(
    graphflow_runner: asyncio.Runner, foreign_router: zenoh.Session
) -> None:
    """What they are told of meanwhile must not hold up the end of one that keeps messages, which holds the GIL."""
    loop = asyncio.get_running_loop()
    mine, other = ZenohSession(loop), ZenohSession(loop)
    kept = [mine.open_sender(f"kept/{i}", Qos(1, durability=Durability.TRANSIENT_LOCAL)) for i in range(3)]
    plain = [mine.open_sender(f"plain/{i}", Qos(1)) for i in range(60)]
    keys = [f"plain/{i}" for i in range(len(plain))]
    listeners = [other.raw.declare_subscriber(key, zenoh.handlers.RingChannel(1)) for key in keys]
    await eventually(lambda: all(sender.is_wanted for sender in plain))
    other.raw.close()  # type: ignore[no-untyped-call]
    began = time.monotonic()
    for sender in kept:
        sender.close()
    took = time.monotonic() - began
    await eventually(lambda: not any(sender.is_wanted for sender in plain))
    mine.raw.close()  # type: ignore[no-untyped-call]
    del listeners
    assert took < 8  # Zenoh itself gives up after ten


async def test_a_session_that_leaves_withdraws_all_at_once(
    graphflow_runner: asyncio.Runner, foreign_router: zenoh.Session
) -> None:
    """What is closed while it leaves is gone for others when the session is, and not one by one before."""
    loop = asyncio.get_running_loop()
    mine, other = ZenohSession(loop), ZenohSession(loop)
    seen: dict[str, bool] = {}
    other.watch("@x/*", seen.__setitem__)

    async def see(wanted: dict[str, bool]) -> None:
        await eventually(lambda: seen == wanted, lambda: f"{wanted} and not {seen}")

    tokens = [mine.announce(f"@x/{i}") for i in range(3)]
    await see(dict.fromkeys(("@x/0", "@x/1", "@x/2"), True))
    tokens[0].close()
    await see({"@x/0": False, "@x/1": True, "@x/2": True})
    asked = loop.create_future()
    other.ask_tokens("@x/*", 0.1, asked.set_result)
    assert sorted(await asked) == ["@x/1", "@x/2"]
    mine.leave()
    tokens.pop(1).close()
    last = mine.announce("@x/last")  # which overtakes nothing
    await see({"@x/0": False, "@x/1": True, "@x/2": True, "@x/last": True})
    await mine.close()
    await see(dict.fromkeys(("@x/0", "@x/1", "@x/2", "@x/last"), False))
    last.close()
    await other.close()


async def test_asking_for_tokens(
    graphflow_runner: asyncio.Runner, foreign_router: zenoh.Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of more than so many, some are left out."""
    loop = asyncio.get_running_loop()
    mine, other = ZenohSession(loop), ZenohSession(loop)
    tokens = [mine.announce(f"@x/{i}") for i in range(3)]
    monkeypatch.setattr("graphflow.transport.zenoh.ASKED_BOUND", 2)
    found: list[str] = []
    async with asyncio.timeout(LIMIT):
        while len(found) < 2:
            asked: asyncio.Future[list[str]] = loop.create_future()
            other.ask_tokens("@x/*", 0.2, asked.set_result)
            found = await asked
    assert len(found) == 2
    for token in tokens:
        token.close()
    await mine.close()
    await other.close()


async def test_questions_about_the_process_are_answered(
    graphflow_runner: asyncio.Runner, foreign_router: zenoh.Session
) -> None:
    """Also where warnings are errors, as in these tests: Zenoh's are of arguments that it no longer knows."""
    loop = asyncio.get_running_loop()
    client, server = ZenohSession(loop), ZenohSession(loop)
    requests = Inbox(server.bell, None, lambda: requests.items.popleft().reply(b"yes", b""))
    server.open_server("@graphflow/0/groups/1", requests)
    caller = client.open_caller("@graphflow/0/groups/1", lambda: None)
    answers = list[Answer]()
    await eventually(lambda: caller.has_server)
    async with asyncio.timeout(LIMIT):
        done = loop.create_future()
        caller.call(b"", b"", lambda answer: done.set_result(None) if answer is None else answers.append(answer))
        await done
    client.raw.close()  # type: ignore[no-untyped-call]
    server.raw.close()  # type: ignore[no-untyped-call]
    assert [answer.payload for answer in answers] == [b"yes"]


async def test_an_answer_does_not_overtake_what_was_published_before_it(
    graphflow_runner: asyncio.Runner, foreign_router: zenoh.Session
) -> None:
    """Where that is asked for, as for the feedback of actions: 300 answers, each after three publications."""
    loop = asyncio.get_running_loop()
    client, server = ZenohSession(loop), ZenohSession(loop)
    sender = server.open_sender("feedback", Qos())

    def work() -> None:
        while requests.items:
            for _ in range(3):
                sender.put(b"", attachment=b"")
            requests.items.popleft().reply(b"", b"")

    requests = Inbox(server.bell, None, work)
    server.open_server("result", requests)
    heard, counts = Inbox(client.bell, None, lambda: None), list[int]()
    client.open_receiver("feedback", Qos(), heard, in_order=True)
    caller = client.open_caller("result", lambda: None)
    await eventually(lambda: caller.has_server and sender.is_wanted)
    async with asyncio.timeout(LIMIT):
        for _ in range(300):
            done = loop.create_future()

            def answered(answer: Answer | None, done: asyncio.Future[None] = done) -> None:
                if answer is not None:
                    counts.append(len(heard.items))
                elif not done.done():
                    done.set_result(None)

            caller.call(b"", b"", answered)
            await done
    client.raw.close()  # type: ignore[no-untyped-call]
    server.raw.close()  # type: ignore[no-untyped-call]
    assert counts == [3 * (i + 1) for i in range(300)]
