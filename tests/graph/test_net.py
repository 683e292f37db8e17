"""Net profiles: read, or refused with every mistake and its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.graph.net import read_profile

TLS = "tls: {ca: ca.pem, certificate: own.pem, key: own.key}\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("ca.pem", "own.pem", "own.key"):
        (tmp_path / name).touch()
    return tmp_path


def problems(folder: Path, text: str) -> list[str]:
    file = folder / "net.yaml"
    file.write_text(text)
    with pytest.raises(GraphFileError) as caught:
        read_profile(file)
    return [str(p).removeprefix(str(file) + ":") for p in caught.value.problems]


def test_a_profile_is_read_and_its_files_found_beside_it(folder: Path) -> None:
    """Paths are relative to the profile, whatever the working directory; without `allow` everything passes."""
    file = folder / "net.yaml"
    file.write_text("listen: tls/0.0.0.0:7448\n" + TLS)
    profile = read_profile(file)
    assert profile.listen == "tls/0.0.0.0:7448"
    assert profile.connect == []
    assert profile.allow == ["/**"]
    assert profile.tls.key == str(folder / "own.key")


def test_every_mistake_is_told_with_its_place(folder: Path) -> None:
    """All at once, as for graph files."""
    text = (
        "listen: tcp/0.0.0.0:7448\nalow: []\ntls: {ca: ca.pem, certificate: own.pem, kee: own.key}\nallow: [turtle1]\n"
    )
    assert sorted(problems(folder, text)) == [
        "1:9: tcp/0.0.0.0:7448: anyone reaching this port could drive the robot; write tls/ and give certificates",
        "2:1: unknown key 'alow'; did you mean 'allow'?",
        "3:41: unknown key 'kee'; did you mean 'key'?",
        "3:6: the key 'key' is missing",
        "4:9: 'turtle1' is not a name pattern; write /turtle1/cmd_vel, /turtle1/** or /*/pose",
    ]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("listen: tls/0.0.0.0:7448\n", "1:1: the key 'tls' is missing"),
        (TLS, "1:1: neither `listen` nor `connect`: nothing could be reached"),
        ("listen: tls/0.0.0.0:7448\n" + TLS.replace("own.key", "her.key"), "2:46: there is no file "),
        ("listen: 7\n" + TLS, "1:9: 7: input should be a valid string"),
        ("connect: [tls/robot:7448]\nallow: []\n" + TLS, "2:8: []: has 0 of at least 1 items"),
        ("7\n", "1:1: 7: "),
    ],
)
def test_one_mistake(folder: Path, text: str, told: str) -> None:
    """Missing keys and files, wrong types."""
    (found,) = problems(folder, text)
    assert found.startswith(told)
