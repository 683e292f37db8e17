"""Importing interfaces."""

from __future__ import annotations

import importlib
import subprocess
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import pytest

from graphflow.errors import InterfaceError, UnknownInterface
from graphflow.msgs import finder, registry

if TYPE_CHECKING:
    from pathlib import Path

    from .conftest import Save


def module(name: str) -> Any:
    return importlib.import_module(f"graphflow.msgs.{name}")


def test_a_class_is_imported_from_its_package() -> None:
    """The class that an import gives is the registry's, for each kind of interface and its parts."""
    from graphflow.msgs.example_interfaces.action import Fibonacci
    from graphflow.msgs.geometry_msgs.msg import Twist
    from graphflow.msgs.turtlesim.srv import Spawn, Spawn_Request

    assert Twist is registry.interface_class("geometry_msgs/msg/Twist")
    assert Spawn.Request is Spawn_Request
    assert Fibonacci is registry.interface_class("example_interfaces/action/Fibonacci")


def test_packages_are_modules() -> None:
    """A package and its kinds are modules that say what they hold."""
    assert module("std_msgs").__doc__ == "The interfaces of ROS 2's package std_msgs."
    assert module("std_msgs.msg").__doc__ == "The msg interfaces of ROS 2's package std_msgs."
    assert "String" in dir(module("std_msgs.msg"))
    assert dir(module("std_srvs.srv")) == ["Empty", "SetBool", "Trigger"]


def test_a_definition_imports_as_soon_as_it_is_saved(save: Save) -> None:
    """A file saved into a project's interfaces folder is imported at once, without a build step."""
    save("find_project/msg/Battery", "float32 charge 1.0\nstd_msgs/Header header\n")
    battery = module("find_project.msg").Battery(charge=0.5)
    assert type(battery).from_bytes(battery.to_bytes()) == battery
    assert module("find_project.msg").Battery().charge == 1.0


def test_a_later_definition_is_found_in_an_imported_package(save: Save) -> None:
    """A second file saved after the package was imported is imported too, of the same and of another kind."""
    save("find_later/msg/First", "int8 x")
    assert module("find_later.msg").First().x == 0
    save("find_later/msg/Second", "First[] firsts")
    save("find_later/srv/Ask", "First first\n---\nbool ok")
    assert module("find_later.msg").Second(firsts=[{"x": 1}]).firsts[0].x == 1
    assert module("find_later.srv").Ask.Response().ok is False
    assert dir(module("find_later.msg")) == ["First", "Second"]


def test_a_definition_imports_after_it_was_missed(save: Save) -> None:
    """An import that failed for want of a definition works once the file is there."""
    with pytest.raises(ModuleNotFoundError):
        module("find_missed.msg")
    save("find_missed/msg/First", "int8 x")
    with pytest.raises(AttributeError, match="package 'find_missed' has no interface 'Second'; there is First"):
        _ = module("find_missed.msg").Second
    save("find_missed/msg/Second", "int8 x")
    assert module("find_missed.msg").Second().x == 0


def test_a_misspelt_class_is_helped() -> None:
    """Importing what is not there is an ImportError; asking for it tells the nearest name."""
    with pytest.raises(ImportError):
        from graphflow.msgs.std_msgs.msg import Strin  # type: ignore[attr-defined]  # noqa: F401
    with pytest.raises(AttributeError, match="has no interface 'Strin'; did you mean 'String'"):
        _ = module("std_msgs.msg").Strin


def test_a_class_without_its_kind() -> None:
    """The import to write is told, of whichever kind it is."""
    with pytest.raises(ImportError, match=r"^write from graphflow\.msgs\.std_msgs\.msg import String$"):
        from graphflow.msgs.std_msgs import String  # type: ignore[attr-defined]  # noqa: F401
    with pytest.raises(ImportError, match=r"^write from graphflow\.msgs\.std_srvs\.srv import SetBool$"):
        from graphflow.msgs.std_srvs import SetBool  # type: ignore[attr-defined]  # noqa: F401


def test_a_wrong_definition_is_told_on_import(save: Save) -> None:
    """Importing a definition with a mistake tells file, line and rule."""
    file = save("find_wrong/msg/Thing", "float64 X")
    with pytest.raises(InterfaceError, match=f"^{file}: find_wrong/msg/Thing line 1: field name 'X'") as caught:
        _ = module("find_wrong.msg").Thing
    assert [entry.name for entry in caught.traceback[1:]] == ["make"]  # the frames below it tell a user nothing


def test_a_field_of_a_type_that_is_not_there(save: Save) -> None:
    """Is told with the definition that has it, also by `from ... import`."""
    save("find_field/msg/Greeting", "string text")
    save("find_field/msg/Thing", "float64 x\nGreting y")
    text = "find_field/msg/Thing has a field of an unknown type: .*did you mean 'Greeting'"
    with pytest.raises(UnknownInterface, match=text):
        exec("from graphflow.msgs.find_field.msg import Thing")


def test_the_interfaces_of_a_script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`python nodes/talker.py` knows those of its own project."""
    (tmp_path / "interfaces" / "find_script" / "msg").mkdir(parents=True)
    (tmp_path / "interfaces" / "find_script" / "msg" / "Thing.msg").write_text("float64 x\n")
    (tmp_path / "nodes").mkdir()
    monkeypatch.setattr(sys.modules["__main__"], "__file__", str(tmp_path / "nodes" / "talker.py"), raising=False)
    assert module("find_script.msg").Thing(x=1.0).x == 1.0


@pytest.mark.parametrize("name", ["nothing_like_it", "std_msgs.idl", "std_msgs.msg.String"])
def test_other_modules_are_not_found(name: str) -> None:
    """A name that is neither a package nor a kind is a ModuleNotFoundError."""
    with pytest.raises(ModuleNotFoundError):
        module(name)


def test_real_modules_are_left_alone() -> None:
    """The package's own modules are Python's as ever."""
    spec = find_spec("graphflow.msgs.registry")
    assert spec is not None
    assert spec.origin == registry.__file__


def test_dunder_names_are_never_interfaces() -> None:
    """Python's own attributes are not looked up as interfaces."""
    assert not hasattr(module("std_msgs.msg"), "__wrapped__")


def test_all_names_of_a_package(save: Save) -> None:
    """`from ... import *` gives them, and they are listed without building the classes."""
    save("find_all/msg/Sound", "float64 x")
    save("find_all/msg/Wrong", "float64 X")
    assert module("find_all.msg").__all__ == ["Sound", "Wrong"]
    space: dict[str, Any] = {}
    exec("from graphflow.msgs.std_msgs.msg import *", space)
    assert space["Int16"] is registry.interface_class("std_msgs/msg/Int16")


def test_the_finder_is_installed_once() -> None:
    """Installing it again changes nothing."""
    before = list(sys.meta_path)
    finder.install()
    assert sys.meta_path == before


def test_a_script_finds_the_interfaces_beside_it(tmp_path: Path) -> None:
    """A project's interfaces are looked for beside its script, and numpy stays out until it is needed."""
    folder = tmp_path / "interfaces" / "beside" / "msg"
    folder.mkdir(parents=True)
    (folder / "Thing.msg").write_text("string name 'it'\n", encoding="utf-8")
    script = tmp_path / "script.py"
    script.write_text(
        f"import sys\nsys.path.append({str(registry.BUNDLED.parent.parent)!r})\n"
        "from graphflow.msgs.beside.msg import Thing\n"
        "assert Thing.from_bytes(Thing().to_bytes()).name == 'it'\n"
        "print('numpy' in sys.modules)\n",
        encoding="utf-8",
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=False, cwd="/")
    assert (done.stdout, done.stderr) == ("False\n", "")
