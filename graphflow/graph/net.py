"""Net profiles: files with the addresses and certificates by which graphs are reached over a network.

    listen: tls/0.0.0.0:7448
    tls: {ca: ca.pem, certificate: laptop.pem, key: laptop.key}
    allow: [/turtle1/**]

Both sides of a link present a certificate signed by `ca`; no other connection is accepted. Names that are not allowed,
and all of graphflow's own traffic, stay on the machine.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StrictStr, ValidationError

from graphflow.errors import GraphFileError, Problem
from graphflow.graph.model import Fault, keys_of
from graphflow.graph.zenoh_address import endpoint
from graphflow.markup import source
from graphflow.names import did_you_mean


def _encrypted(text: str) -> str:
    if not endpoint(text).startswith("tls/"):
        raise ValueError(f"{text}: anyone reaching this port could drive the robot; write tls/ and give certificates")
    return text


def _pattern(text: str) -> str:
    if not text.startswith("/") or "$" in text or "//" in text:
        raise ValueError(f"{text!r} is not a name pattern; write /turtle1/cmd_vel, /turtle1/** or /*/pose")
    return text


class _Model(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Certificates(_Model):
    """Files in PEM form, relative to the profile."""

    ca: StrictStr
    certificate: StrictStr
    key: StrictStr


class NetProfile(_Model):
    """A net profile; names in `allow` are topics and services, with * for one part and ** for any number."""

    listen: Annotated[StrictStr, AfterValidator(_encrypted)] | None = None
    connect: list[Annotated[StrictStr, AfterValidator(_encrypted)]] = []
    tls: Certificates
    allow: list[Annotated[StrictStr, AfterValidator(_pattern)]] = Field(["/**"], min_length=1)


def read_profile(path: Path) -> NetProfile:
    """Read a net profile and make its file names absolute.

    Raises:
        GraphFileError: The profile has mistakes; all of them, with their places.
    """
    src = source.read_file(path, str(path))
    try:
        profile = NetProfile.model_validate(src.data)
    except ValidationError as error:
        raise GraphFileError([_problem(src, fault) for fault in error.errors()]) from None
    problems = []
    files: dict[str, str] = {}
    for key, name in profile.tls.model_dump().items():
        file = path.resolve().parent / name
        files[key] = str(file)
        if not file.is_file():
            problems.append(Problem(src.place(("tls", key)), f"there is no file {file}"))
    if profile.listen is None and not profile.connect:
        problems.append(Problem(src.place(()), "neither `listen` nor `connect`: nothing could be reached"))
    if problems:
        raise GraphFileError(problems)
    return profile.model_copy(update={"tls": Certificates(**files)})


def _problem(src: source.Source, fault: Fault) -> Problem:
    path = tuple(part for part in fault["loc"])
    if fault["type"] == "extra_forbidden":
        known = keys_of(Certificates if path[0] == "tls" else NetProfile)
        return Problem(src.key_place(path), f"unknown key {path[-1]!r}{did_you_mean(str(path[-1]), known)}")
    if fault["type"] == "missing":
        return Problem(src.place(path[:-1]), f"the key {path[-1]!r} is missing")
    if fault["type"] == "value_error":
        return Problem(src.place(path), str(fault["ctx"]["error"]))
    return Problem(src.place(path), f"{fault['input']!r}: {fault['msg'].lower()}")
