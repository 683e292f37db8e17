"""Wire profiles: what each distribution offers, and how a peer of another one is told."""

from __future__ import annotations

import pytest

from graphflow.errors import GraphflowError
from graphflow.msgs import registry
from graphflow.wire.liveliness import Entity, Kind, parse_token
from graphflow.wire.profile import PROFILES, advice, speakers, wire_profile, wire_type

NEW_EVENT = "RIHS01_78b19e2be41a797fc009c96bda68944182edabec7852cccd928a40bc06f6f9d7"
OLD_EVENT = "RIHS01_d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38"
EVENT = "lifecycle_msgs/msg/TransitionEvent"
DIFFERENT = sorted(
    (profile, f"{file.parent.parent.name}/{file.parent.name}/{file.stem}")
    for profile in PROFILES
    for kind in registry.KINDS
    for file in (registry.BUNDLED / profile).glob(f"*/{kind}/*.{kind}")
)
"""The definitions that a profile has of its own."""


def entity(type_: str, hash_: str = "RIHS01_0", more: str = "") -> Entity:
    """A publisher's token, read."""
    made = Entity(0, "a1", 0, 1, Kind.PUBLISHER, "/", "n", "/t", type_, hash_)
    parsed = parse_token(made.token + more)
    assert parsed is not None
    return parsed


def test_jazzy_is_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the variable, or with an empty one, definitions are Jazzy's."""
    monkeypatch.delenv("GRAPHFLOW_WIRE", raising=False)
    assert wire_profile() == "jazzy"
    monkeypatch.setenv("GRAPHFLOW_WIRE", " ")
    assert wire_profile() == "jazzy"


@pytest.mark.parametrize("profile", PROFILES)
def test_a_profile_is_chosen_by_its_name(profile: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The variable names the profile."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", profile)
    assert wire_profile() == profile


def test_a_mistyped_profile_is_an_error_that_helps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another word is refused, with the nearest that is right, or with all of them, once."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", "lyrial")
    with pytest.raises(GraphflowError, match=r"GRAPHFLOW_WIRE='lyrial' is not a wire profile; did you mean 'lyrical'"):
        wire_profile()
    monkeypatch.setenv("GRAPHFLOW_WIRE", "humble")
    with pytest.raises(
        GraphflowError, match=r"GRAPHFLOW_WIRE='humble' is not .* profile; there is [a-z]+, [a-z]+, [a-z]+$"
    ):
        wire_profile()


@pytest.mark.parametrize(
    ("profile", "digest", "first_field"),
    [("jazzy", OLD_EVENT, "timestamp"), ("kilted", OLD_EVENT, "timestamp"), ("lyrical", NEW_EVENT, "stamp")],
)
def test_transition_event_is_the_profiles(
    profile: str, digest: str, first_field: str, monkeypatch: pytest.MonkeyPatch, fresh_registry: None
) -> None:
    """TransitionEvent has the fields and the hash that the distribution gives it."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", profile)
    assert registry.hash_of(EVENT) == digest
    assert registry.message_schema(EVENT).fields[0].name == first_field


@pytest.mark.parametrize(("profile", "name"), DIFFERENT)
def test_a_profiles_own_definitions_are_whole(
    profile: str, name: str, monkeypatch: pytest.MonkeyPatch, fresh_registry: None
) -> None:
    """Each has a hash and a class, is written without comments, and is not what Jazzy has."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", profile)
    text = registry.definition(name)
    assert "#" not in text
    assert registry.definition_file(name).is_relative_to(registry.BUNDLED / profile)
    usual = registry.BUNDLED / f"{name}.{name.split('/')[1]}"
    assert not usual.exists() or usual.read_text(encoding="utf-8") != text
    assert registry.hash_of(name).startswith("RIHS01_")
    assert registry.interface_class(name).__name__ == name.rpartition("/")[2]


@pytest.mark.parametrize(
    ("profile", "digest"),
    [
        ("jazzy", "5a590fa8e9a32b7b9c838fdf5939a2fb8858d6cfd25bdf2f2e5f0f7bbb25f52b"),
        ("kilted", "0fb14135a40c3900a9a184f95b2ed6966a0ffd298739cc9de7903ebc6dc06a25"),
    ],
)
def test_nav2s_goals_are_the_profiles(
    profile: str, digest: str, monkeypatch: pytest.MonkeyPatch, fresh_registry: None
) -> None:
    """A goal of Nav2 has the hash that rosidl gives it in the distribution."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", profile)
    assert registry.hash_of("nav2_msgs/action/NavigateThroughPoses_SendGoal") == f"RIHS01_{digest}"


@pytest.mark.parametrize(("profile", "package"), [("jazzy", "turtlesim"), ("lyrical", "turtlesim_msgs")])
def test_turtlesims_classes_are_the_profiles(
    profile: str, package: str, monkeypatch: pytest.MonkeyPatch, fresh_registry: None
) -> None:
    """A node that uses `turtlesim` announces the package that the distribution's turtlesim has."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", profile)
    assert registry.interface_class("turtlesim/msg/Pose").SCHEMA.name == f"{package}/msg/Pose"  # type: ignore[attr-defined]
    assert f"{package}/srv/Spawn" == registry.interface_class("turtlesim/srv/Spawn").NAME  # type: ignore[attr-defined]


def test_other_names_are_the_same_everywhere() -> None:
    """Only turtlesim's package differs."""
    assert {wire_type("std_msgs/msg/String", p) for p in PROFILES} == {"std_msgs/msg/String"}


@pytest.mark.parametrize(
    ("peer", "told"),
    [
        (entity("std_msgs/msg/String"), ()),
        (entity("turtlesim/msg/Pose"), ("jazzy",)),
        (entity("turtlesim_msgs/msg/Pose"), ("kilted", "lyrical")),
        (entity(EVENT, OLD_EVENT), ("jazzy", "kilted")),
        (entity(EVENT, NEW_EVENT), ("lyrical",)),
        (entity("sensor_msgs/msg/Image", more="/backends:cpu:"), ("lyrical",)),
        (entity("std_msgs/msg/String", "TypeHashNotSupported"), ("humble",)),
    ],
)
def test_a_token_tells_who_can_have_written_it(peer: Entity, told: tuple[str, ...]) -> None:
    """Names, hashes and chunks that only some distributions have give them away."""
    assert speakers(peer) == told


def test_the_advice_says_what_to_type() -> None:
    """A peer of another profile is answered with the option to start with; one of the same with nothing."""
    peer = entity("turtlesim_msgs/msg/Pose")
    assert advice(peer, "jazzy") == (
        "it speaks the wire of ROS 2 Kilted or Lyrical, this process speaks Jazzy's: "
        "start with --wire kilted, or set GRAPHFLOW_WIRE=kilted"
    )
    assert advice(peer, "kilted") == ""
    assert "Humble" in advice(entity("std_msgs/msg/String", "TypeHashNotSupported"), "jazzy")
