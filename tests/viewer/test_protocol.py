"""Parsing of clients' messages, and encoding of the server's."""

from __future__ import annotations

import json

import pytest

from graphflow.errors import DecodeError
from graphflow.viewer import protocol


def test_words_of_clients() -> None:
    """JSON messages are parsed."""
    said = protocol.read_text('{"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 2, "more": 3}]}')
    assert said == protocol.Subscribe(
        op="subscribe", subscriptions=[protocol.Subscription.model_validate({"id": 1, "channelId": 2})]
    )
    said = protocol.read_text('{"op": "setParameters", "parameters": [{"name": "/a.b", "value": [1, 2.5]}]}')
    assert isinstance(said, protocol.SetParameters)
    assert said.parameters[0].value == [1, 2.5]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "does not follow the protocol: Invalid JSON"),
        ('{"op": "fly"}', "does not match any of the expected tags"),
        ('{"op": "subscribe", "subscriptions": [{"id": 1}]}', "subscribe.subscriptions.0.channelId: Field required"),
        ('{"op": "unsubscribe", "subscriptionIds": [-1]}', "greater than or equal to 0"),
        ('{"op": "unsubscribe", "subscriptionIds": [' + "1," * 5000 + "1]}", "at most 5000 items"),
        ('{"op": "getParameters", "parameterNames": ["' + "x" * 1001 + '"]}', "at most 1000 characters"),
    ],
)
def test_words_that_are_none(text: str, message: str) -> None:
    """Errors in JSON messages are located, in short."""
    with pytest.raises(DecodeError) as caught:
        protocol.read_text(text)
    assert message in str(caught.value)
    assert len(str(caught.value)) < 600


def test_bytes_of_clients() -> None:
    """Binary messages and calls are parsed."""
    assert protocol.read_bytes(b"\x01\x07\x00\x00\x00data") == protocol.Message(7, b"data")
    call = protocol.read_bytes(b"\x02\x01\x00\x00\x00\x02\x00\x00\x00\x03\x00\x00\x00cdrdata")
    assert call == protocol.Call(1, 2, "cdr", b"data")
    assert isinstance(call, protocol.Call)
    assert protocol.response_frame(call, b"x") == b"\x03\x01\x00\x00\x00\x02\x00\x00\x00\x03\x00\x00\x00cdrx"


@pytest.mark.parametrize(
    "data", [b"", b"\x00", b"\x01\x00", b"\x02" + bytes(11), b"\x02" + bytes(8) + b"\x09" + bytes(3)]
)
def test_bytes_that_are_none(data: bytes) -> None:
    """Other bytes are refused."""
    with pytest.raises(DecodeError, match="do not follow the protocol"):
        protocol.read_bytes(data)


def test_what_clients_are_told() -> None:
    """Fields are encoded in camel case; those that are None are left out."""
    assert json.loads(protocol.control_message("unadvertise", channel_ids=[1])) == {
        "op": "unadvertise",
        "channelIds": [1],
    }
    assert json.loads(protocol.control_message("parameterValues", parameters=[], id=None)) == {
        "op": "parameterValues",
        "parameters": [],
    }
    assert protocol.message_head(1, 2) == b"\x01\x01\x00\x00\x00\x02\x00\x00\x00\x00\x00\x00\x00"
    assert protocol.time_frame(3) == b"\x02\x03\x00\x00\x00\x00\x00\x00\x00"
