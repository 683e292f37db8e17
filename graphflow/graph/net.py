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

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StrictStr

from graphflow.errors import GraphFileError, Problem
from graphflow.graph.zenoh_address import endpoint
from graphflow.markup import source
from graphflow.markup.validated import validated


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
    profile = validated(src, NetProfile)
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
