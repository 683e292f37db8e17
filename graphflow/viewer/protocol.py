"""Foxglove's WebSocket protocol: validation of clients' messages, and encoding of the server's.

Source: github.com/foxglove/ws-protocol, docs/spec.md; for playback, the SDK at github.com/foxglove/foxglove-sdk.
"""

from __future__ import annotations

import json
import struct
from typing import Annotated, Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError
from pydantic.alias_generators import to_camel

from graphflow.errors import DecodeError

SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
"""The names of the protocol, newest first."""

_REQUEST_ID_BOUND = 1_000
ENTRIES_BOUND = 5_000
"""Maximum entries of one message from a client."""

Id = Annotated[int, Field(ge=0, lt=1 << 32)]
Name = Annotated[str, Field(max_length=1_000)]
Names = Annotated[list[Name], Field(max_length=ENTRIES_BOUND)]
Ids = Annotated[list[Id], Field(max_length=ENTRIES_BOUND)]


class _Part(BaseModel):
    model_config = ConfigDict(alias_generator=to_camel, strict=True)


class Subscription(_Part):
    """A subscription to a channel, numbered by the client."""

    id: Id
    channel_id: Id


class ClientChannel(_Part):
    """A channel on which the client will publish."""

    id: Id
    topic: Name
    encoding: Name
    schema_name: Name
    """The type: `geometry_msgs/msg/Twist`, or `geometry_msgs/Twist`."""


class Value(_Part):
    """A parameter with its value; without one, it is to be unset."""

    name: Name
    value: object = None
    type: Name | None = None


class Subscribe(_Part):
    op: Literal["subscribe"]
    subscriptions: Annotated[list[Subscription], Field(max_length=ENTRIES_BOUND)]


class Unsubscribe(_Part):
    op: Literal["unsubscribe"]
    subscription_ids: Ids


class Advertise(_Part):
    op: Literal["advertise"]
    channels: Annotated[list[ClientChannel], Field(max_length=ENTRIES_BOUND)]


class Unadvertise(_Part):
    op: Literal["unadvertise"]
    channel_ids: Ids


class GetParameters(_Part):
    op: Literal["getParameters"]
    parameter_names: Names
    id: Name | None = None


class SetParameters(_Part):
    op: Literal["setParameters"]
    parameters: Annotated[list[Value], Field(max_length=ENTRIES_BOUND)]
    id: Name | None = None


class FollowParameters(_Part):
    op: Literal["subscribeParameterUpdates", "unsubscribeParameterUpdates"]
    parameter_names: Names


class FollowGraph(_Part):
    op: Literal["subscribeConnectionGraph", "unsubscribeConnectionGraph"]


class FetchAsset(_Part):
    """A file that a client wants, such as a mesh of a robot."""

    op: Literal["fetchAsset"]
    uri: Name
    request_id: Id


class Message(NamedTuple):
    """A message that a client publishes on one of its channels."""

    channel_id: int
    data: bytes


class Call(NamedTuple):
    """A client's call of a service."""

    service_id: int
    call_id: int
    encoding: str
    data: bytes


class PlaybackControl(NamedTuple):
    """A client's request to a server that plays a bag.

    Attributes:
        sought_ns: The time to go to, nanoseconds since 1970; None to go on from the present one.
        request_id: To be repeated in the answer.
    """

    is_playing: bool
    speed: float
    sought_ns: int | None
    request_id: str


ClientRequest = (
    Subscribe
    | Unsubscribe
    | Advertise
    | Unadvertise
    | GetParameters
    | SetParameters
    | FollowParameters
    | FollowGraph
    | FetchAsset
)
_CLIENT_REQUEST: TypeAdapter[ClientRequest] = TypeAdapter(Annotated[ClientRequest, Field(discriminator="op")])

ClientMessage = ClientRequest | Message | Call | PlaybackControl
_CONTROL = struct.Struct("<BfBQI")
"""Of a request for playback: the command, 0 to play, the speed, whether there is a time, the time, a length."""
PLAYING, PAUSED, ENDED = 0, 1, 3
"""The states of playback."""


def read_text(text: str) -> ClientRequest:
    """Parse a client's JSON message.

    Raises:
        DecodeError: The message is not part of the protocol; the text is for the client.
    """
    try:
        return _CLIENT_REQUEST.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise DecodeError(
            f"this message does not follow the protocol: {where + ': ' if where else ''}{first['msg']}"
        ) from None


def read_bytes(data: bytes) -> Message | Call | PlaybackControl:
    """Parse a client's binary message.

    Raises:
        DecodeError: As for `read_text`.
    """
    try:
        if data[:1] == b"\x01":
            return Message(struct.unpack_from("<I", data, 1)[0], data[5:])
        if data[:1] == b"\x02":
            service, call, length = struct.unpack_from("<III", data, 1)
            if length <= len(data) - 13:
                return Call(service, call, data[13 : 13 + length].decode(), data[13 + length :])
        if data[:1] == b"\x03":
            command, speed, is_sought, sought_ns, length = _CONTROL.unpack_from(data, 1)
            request_id = data[1 + _CONTROL.size :]
            if command <= 1 and length == len(request_id) <= _REQUEST_ID_BOUND:
                return PlaybackControl(not command, speed, sought_ns if is_sought else None, request_id.decode())
    except (struct.error, UnicodeDecodeError):
        pass
    raise DecodeError(f"these {len(data)} bytes do not follow the protocol")


def control_message(op: str, **fields: object) -> str:
    """Encode a message of the server as JSON, with fields in camel case, leaving out those that are None."""
    return json.dumps(
        {"op": op, **{to_camel(name): value for name, value in fields.items() if value is not None}}, allow_nan=False
    )


def message_head(subscription_id: int, time_ns: int) -> bytes:
    """Return the header of a channel's message."""
    return struct.pack("<BIQ", 1, subscription_id, time_ns)


def time_frame(time_ns: int) -> bytes:
    """Encode the server's time."""
    return struct.pack("<BQ", 2, time_ns)


def response_frame(call: Call, data: bytes) -> bytes:
    """Encode the response to a call, in the encoding of the request."""
    encoding = call.encoding.encode()
    return struct.pack("<BIII", 3, call.service_id, call.call_id, len(encoding)) + encoding + data


def playback_frame(status: int, time_ns: int, speed: float, control: PlaybackControl | None) -> bytes:
    """Encode the state of playback.

    Args:
        status: `PLAYING`, `PAUSED` or `ENDED`.
        control: The request that this answers; None if it answers none.
    """
    request_id = control.request_id.encode() if control is not None else b""
    has_sought = control is not None and control.sought_ns is not None
    return struct.pack("<BBQfBI", 5, status, time_ns, speed, has_sought, len(request_id)) + request_id


def asset_frame(request_id: int, data: bytes, error: str = "") -> bytes:
    """Encode a file that a client has asked for, or the reason why it cannot have it."""
    text = error.encode()
    return struct.pack("<BIBI", 4, request_id, bool(error), len(text)) + text + data
