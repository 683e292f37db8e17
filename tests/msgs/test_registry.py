"""Finding definitions by name, and what is remembered of them."""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest

from graphflow.errors import InterfaceError, UnknownInterface
from graphflow.msgs import registry
from graphflow.wire.described import verified
from graphflow.wire.schema import Action, Message, Service
from graphflow.wire.typehash import type_hash
from tests.cases import sample

if TYPE_CHECKING:
    from pathlib import Path

    from .conftest import Save

BUNDLED = sorted(
    f"{f.parent.parent.name}/{f.parent.name}/{f.stem}"
    for kind in registry.KINDS
    for f in registry.BUNDLED.glob(f"*/{kind}/*.{kind}")
)


def sent_parts(found: Service | Action) -> list[str]:
    """The messages that are sent; those that describe a service or action as a whole are not."""
    services = (found,) if isinstance(found, Service) else found.services
    wholes = {found.name, *(service.name for service in services)}
    return [m.name for m in found.messages if m.name not in wholes]


@pytest.mark.parametrize("name", sample(BUNDLED))
def test_every_bundled_interface_is_whole(name: str) -> None:
    """Each bundled definition is read, has a class and a hash, and its default messages come back from their bytes."""
    found = registry.interface(name)
    assert registry.hash_of(name).startswith("RIHS01_")
    assert registry.interface_class(name).__name__ == found.name.rpartition("/")[2]
    for part in [name] if isinstance(found, Message) else sent_parts(found):
        data = registry.example(part).to_bytes()
        assert registry.codec(part).decode(data).to_bytes() == data  # as bytes: a float32 rounds a default such as 0.3


@pytest.mark.parametrize("name", sample(BUNDLED))
def test_bundled_definitions_are_bare_facts(name: str) -> None:
    """Definitions are written without comments."""
    assert "#" not in registry.definition_file(name).read_text(encoding="utf-8")


def test_packages_are_listed() -> None:
    """Bundled packages, those of added roots, and turtlesim's newer name are all listed, in order."""
    found = registry.packages()
    assert {"std_msgs", "turtlesim", "turtlesim_msgs", "test_msgs"} <= set(found)
    assert found == sorted(set(found))
    assert not {"__pycache__", "base"} & set(found)


def test_names_of_a_package_are_listed() -> None:
    """A package's interfaces are listed by kind."""
    assert registry.names_in("std_srvs", "srv") == ["Empty", "SetBool", "Trigger"]
    assert registry.names_in("std_srvs", "msg") == []
    assert registry.names_in("nothing_like_it", "msg") == []


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("std_msgs/msg/String", "std_msgs/msg/String"),
        ("std_msgs/String", "std_msgs/msg/String"),
        ("std_msgs.msg.String", "std_msgs/msg/String"),
        ("std_srvs/SetBool", "std_srvs/srv/SetBool"),
        ("example_interfaces/Fibonacci", "example_interfaces/action/Fibonacci"),
        ("example_interfaces.action.Fibonacci", "example_interfaces/action/Fibonacci"),
    ],
)
def test_short_names_become_full_ones(text: str, name: str) -> None:
    """An interface is found by its full name, its short one, and Python's spelling."""
    assert registry.full_name(text) == name


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("Quaternion", "'Quaternion' is not an interface name; did you mean 'geometry_msgs/msg/Quaternion'?"),
        ("Nothing", "'Nothing' is not an interface name; write package/msg/Name"),
        ("AddTwoInt", "did you mean 'example_interfaces/srv/AddTwoInts'?"),
        (
            "AddTwoInts.srv",
            "'AddTwoInts.srv' is not an interface name; did you mean 'example_interfaces/srv/AddTwoInts'?",
        ),
        ("std_srvs/SetBool.srv", "did you mean 'std_srvs/srv/SetBool'?"),
        ("std_srvs/srv/SetBool.srv", "did you mean 'std_srvs/srv/SetBool'?"),
        ("./srv/SetBool.srv", "did you mean 'example_interfaces/srv/SetBool' or 'std_srvs/srv/SetBool'?"),
        ("srv/AddTwoInts", "did you mean 'example_interfaces/srv/AddTwoInts'?"),
        ("my_pkg/srv/X.srv", "'my_pkg/srv/X.srv' is not an interface name; write package/srv/X"),
        ("srv", "'srv' is not an interface name; write package/msg/Name"),
        ("std_msgs.msg", "package 'std_msgs' has no interface 'msg'"),
        ("/turtle1/pose", "'/turtle1/pose' is not an interface name; write package/msg/Name"),
        ("turtlesim/msg/Spawn", "there is no turtlesim/msg/Spawn; Spawn is a service: turtlesim/srv/Spawn"),
        ("turtlesim/srv/RotateAbsolute", "RotateAbsolute is an action: turtlesim/action/RotateAbsolute"),
        ("geometry_msgs/msgs/Twist", "there is no geometry_msgs/msgs/Twist; write geometry_msgs/msg/Twist"),
        ("std_srvs/msg/Quaternion", "no interface 'Quaternion'; did you mean geometry_msgs/msg/Quaternion?"),
        ("std_srvs/msg/Float32", "did you mean float32 (of a field) or example_interfaces/msg/Float32 or std_msgs/msg"),
        ("a/b/c/D", "is not an interface name"),
        ("", "is not an interface name"),
        ("std_msg/String", "there is no interface package 'std_msg'; did you mean 'std_msgs'"),
        ("std_msgs/Strin", "package 'std_msgs' has no interface 'Strin'; did you mean 'String'"),
        ("std_msgs/msg/Strin", "package 'std_msgs' has no interface 'Strin'; did you mean 'String'"),
        ("std_msgs/srv/String", "there is no std_msgs/srv/String; String is a message: std_msgs/msg/String"),
        ("std_msgs/idl/String", "there is no std_msgs/idl/String; write std_msgs/msg/String"),
        ("std_msgs/msg/../String", "is not an interface name"),
        ("../msg/String", "is not an interface name"),
        ("odd_shapes/SameName", "is a msg and a srv; write odd_shapes/msg/SameName"),
    ],
)
def test_unknown_names_are_helped(text: str, problem: str) -> None:
    """A name that nothing or too much has is an UnknownInterface that says what to write."""
    with pytest.raises(UnknownInterface) as caught:
        registry.full_name(text)
    assert problem in str(caught.value)


def test_a_kind_of_interface_is_a_kind_of_schema() -> None:
    """A .msg is a Message, a .srv a Service, an .action an Action."""
    assert isinstance(registry.interface("std_msgs/msg/String"), Message)
    assert isinstance(registry.interface("std_srvs/srv/Empty"), Service)
    assert isinstance(registry.interface("turtlesim/action/RotateAbsolute"), Action)


def test_what_was_read_is_kept() -> None:
    """Schemas, classes and codecs are the same objects every time."""
    for get in (registry.interface, registry.message_schema, registry.interface_class, registry.codec):
        made: Any = get
        assert made("std_msgs/msg/String") is made("std_msgs/msg/String")


@pytest.mark.parametrize(
    "name",
    [
        "turtlesim/srv/Spawn_Request",
        "turtlesim/srv/Spawn_Event",
        "turtlesim/action/RotateAbsolute_Goal",
        "turtlesim/action/RotateAbsolute_FeedbackMessage",
        "turtlesim/action/RotateAbsolute_SendGoal_Request",
        "turtlesim/action/RotateAbsolute_GetResult_Event",
    ],
)
def test_derived_messages_have_schemas_and_classes(name: str) -> None:
    """The messages made from services and actions are found by their names."""
    assert registry.message_schema(name).name == name
    assert registry.example(name).SCHEMA.name == name


@pytest.mark.parametrize(
    "name", ["turtlesim/srv/Spawn_Goal", "turtlesim/action/RotateAbsolute_Send", "turtlesim/srv/No_Request"]
)
def test_unknown_parts_are_told(name: str) -> None:
    """A part that no service or action has is an UnknownInterface."""
    with pytest.raises(UnknownInterface):
        registry.message_schema(name)


def test_services_of_services_and_actions() -> None:
    """A service is found by its name, an action's two by theirs, and nothing else is one."""
    assert registry.service_schema("std_srvs/srv/Empty").name == "std_srvs/srv/Empty"
    for part in ("SendGoal", "GetResult"):
        name = f"example_interfaces/action/Fibonacci_{part}"
        assert registry.service_schema(name).name == name
    for name in ("std_msgs/msg/String", "example_interfaces/action/Fibonacci"):
        with pytest.raises(UnknownInterface, match=f"{name} is not a service"):
            registry.service_schema(name)


def test_turtlesims_two_names_are_two_types() -> None:
    """Both packages have the same fields, and their own names and hashes on the wire."""
    old, new = (registry.message_schema(f"{package}/msg/Pose") for package in ("turtlesim", "turtlesim_msgs"))
    assert old.fields == new.fields
    assert (old.name, new.name) == ("turtlesim/msg/Pose", "turtlesim_msgs/msg/Pose")
    assert registry.hash_of(old.name) != registry.hash_of(new.name)
    assert registry.interface_class(new.name).__module__ == "graphflow.msgs.turtlesim_msgs.msg"


def test_a_wrong_definition_is_told_with_its_file(save: Save) -> None:
    """A mistake in a definition is told with file, line and rule, again at every use until it is mended."""
    file = save("reg_wrong/msg/Thing", "float64 x\nflat64 y\n")
    for _ in range(2):
        with pytest.raises(InterfaceError) as caught:
            registry.interface_class("reg_wrong/msg/Thing")
        assert str(caught.value).startswith(f"{file}: reg_wrong/msg/Thing line 2: 'flat64' is not a type")
    file.write_text("float64 x\nfloat64 y\n", encoding="utf-8")
    assert registry.example("reg_wrong/msg/Thing").y == 0.0


def test_a_definition_that_is_no_text(save: Save) -> None:
    """A file that is not UTF-8 is an InterfaceError with the file."""
    file = save("reg_binary/msg/Thing", "")
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(InterfaceError, match=str(file)):
        registry.interface("reg_binary/msg/Thing")


def test_a_missing_nested_type_is_told(save: Save) -> None:
    """A field of a type that is nowhere is told with the nearest name."""
    save("reg_missing/msg/Thing", "geometry_msgs/Pont p")
    with pytest.raises(UnknownInterface, match="has no interface 'Pont'; did you mean 'Point'"):
        registry.interface_class("reg_missing/msg/Thing")


def test_a_project_can_add_to_a_bundled_package(save: Save) -> None:
    """A project's folder of a bundled package's name adds to it, and does not hide what is there."""
    save("std_srvs/srv/RegAdded", "int8 x\n---\n")
    assert {"Trigger", "RegAdded"} <= set(registry.names_in("std_srvs", "srv"))
    save("std_srvs/srv/Trigger", "int8 x\n---\n")
    assert registry.definition_file("std_srvs/srv/Trigger").is_relative_to(registry.BUNDLED)


def test_a_root_is_added_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Adding a folder again changes nothing, and it comes after the bundled definitions."""
    monkeypatch.setattr(registry, "_roots", [])
    registry.add_root(tmp_path)
    registry.add_root(tmp_path)
    assert list(registry.roots())[:2] == [registry.BUNDLED, tmp_path]
    assert list(registry.roots()).count(tmp_path) == 1


def test_forget_reads_anew(save: Save, monkeypatch: pytest.MonkeyPatch) -> None:
    """After `forget` a changed definition counts, and its hash and codec with it."""
    for name in ("interface", "_part", "message_schema", "hash_of", "interface_class", "codec"):
        memory: Any = getattr(registry, name)
        monkeypatch.setattr(registry, name, cache(memory.__wrapped__))  # so that other tests keep their classes
    save("reg_forget/msg/Thing", "int8 x")
    old = registry.hash_of("reg_forget/msg/Thing")
    save("reg_forget/msg/Thing", "int16 x")
    assert registry.hash_of("reg_forget/msg/Thing") == old
    registry.forget()
    assert registry.hash_of("reg_forget/msg/Thing") != old
    assert len(registry.example("reg_forget/msg/Thing").to_bytes()) == 6


def test_adopting(monkeypatch: pytest.MonkeyPatch) -> None:
    """An unknown type becomes known, with its nested types only; known types take precedence."""
    monkeypatch.setattr(registry, "_foreign", {})
    sources = {
        "adopted_msgs/msg/A": "B b\nstd_msgs/String s",
        "adopted_msgs/msg/B": "int32 x",
        "std_msgs/msg/String": "string data",
        "adopted_msgs/msg/Planted": "int32 y",
    }
    registry.adopt("adopted_msgs/msg/A", "", sources)
    assert set(registry._foreign) == {"adopted_msgs/msg/A", "adopted_msgs/msg/B"}
    assert registry.interface_class("adopted_msgs/msg/A")().b.x == 0
    assert registry.definition("adopted_msgs/msg/B") == "int32 x"


def test_what_does_not_go_with_what_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leaves nothing behind, so that it is not taken for known later."""
    monkeypatch.setattr(registry, "_foreign", {})
    sources = {"clashing_msgs/msg/A": "std_msgs/String s", "std_msgs/msg/String": "string data\nint32 more"}
    whole = verified("clashing_msgs/msg/A", "", sources)
    messages = {name: message for name, message in whole.items() if isinstance(message, Message)}
    digest = type_hash(messages["clashing_msgs/msg/A"], messages.__getitem__)
    for _ in range(2):
        with pytest.raises(InterfaceError, match="its nested types have other definitions here"):
            registry.adopt("clashing_msgs/msg/A", digest, sources)
        assert registry._foreign == {}
        with pytest.raises(UnknownInterface):
            registry.full_name("clashing_msgs/msg/A")


@pytest.mark.timeout(20)
def test_a_definition_that_is_no_file(save: Save) -> None:
    """Is refused with its name; nobody waits for it."""
    file = save("fifo_msgs/msg/Thing", "int32 x")
    file.unlink()
    os.mkfifo(file)
    with pytest.raises(InterfaceError, match=r"Thing\.msg: it is not a regular file"):
        registry.definition("fifo_msgs/msg/Thing")


@pytest.mark.parametrize(
    ("name", "has_them"),
    [
        ("sensor_msgs/msg/Image", True),
        ("nav_msgs/msg/OccupancyGrid", True),
        ("map_msgs/msg/ProjectedMap", True),
        ("geometry_msgs/msg/PoseWithCovariance", False),
        ("std_msgs/msg/String", False),
        ("rcl_interfaces/msg/ParameterEvent", False),
    ],
)
def test_lists_of_numbers(name: str, has_them: bool) -> None:
    """In the message or in one that it has; neither of fixed size, nor in the elements of a list."""
    assert registry.has_number_lists(name) is has_them


def test_a_definition_that_differs_elsewhere(save: Save) -> None:
    """A file of the user's may have been changed since; those of the package are not."""
    file = save("changed_msgs/msg/Thing", "int32 x")
    told = f"; if {file} was changed after the node had started, start the node again"
    assert registry.why_different("changed_msgs/msg/Thing") == told
    assert registry.why_different("std_msgs/msg/String") == ""
    assert registry.why_different("gone_msgs/msg/Thing") == ""


def test_a_package_is_no_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Names come from other processes: none leads out of the folders with definitions."""
    monkeypatch.setattr(registry, "_roots", [tmp_path / "interfaces"])
    (tmp_path / "interfaces" / "inner" / "msg").mkdir(parents=True)
    (tmp_path / "msg").mkdir()
    assert registry.package_folders("inner")
    for name in ("..", str(tmp_path), "inner/../.."):
        assert registry.package_folders(name) == []


def test_how_much_a_message_of_a_foreign_type_may_have(monkeypatch: pytest.MonkeyPatch) -> None:
    """Less than one of an installed type: somebody else has chosen its fields. So has the answer with a definition."""
    monkeypatch.setattr(registry, "VALUES_BOUND", 7)
    monkeypatch.setattr(registry, "_foreign", {"p/msg/A": ""})
    for name in ("p/msg/A", "type_description_interfaces/srv/GetTypeDescription_Response"):
        assert registry._types_for(name, "list").values == 7
    assert registry._types_for("std_msgs/msg/String", "list").values != 7
