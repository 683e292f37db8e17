"""Import of interface packages: `graphflow.msgs.<package>` with its `msg`, `srv` and `action` modules."""

from __future__ import annotations

import importlib.machinery
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

from graphflow.errors import InterfaceError, UnknownInterface
from graphflow.msgs import registry
from graphflow.names import did_you_mean

_ROOT = "graphflow.msgs."


class _InterfaceFinder:
    """Finder and loader in one, without `importlib.abc`, which takes longer to import than a package of messages."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if not fullname.startswith(_ROOT):
            return None
        package, *rest = fullname.removeprefix(_ROOT).split(".")
        if (registry.BUNDLED / f"{package}.py").is_file():  # a module of graphflow.msgs
            return None
        if not registry.package_folders(package) and not (
            _add_those_of_the_script() and registry.package_folders(package)
        ):
            own = f" (one of your own goes in interfaces/{package}/msg/*.msg)"
            hint = registry.no_kinds(package) or did_you_mean(package, registry.packages()) + own
            raise ModuleNotFoundError(f"there is no interface package {package!r}{hint}", name=fullname)
        if len(rest) == 2 and rest[0] in registry.KINDS and not rest[1].startswith("_"):
            # `from package.msg import Nam` looks for a submodule after the attribute: list the existing names.
            known = registry.names_in(package, rest[0])
            if rest[1] in known:
                return None
            others = [kind for kind in registry.KINDS if rest[1] in registry.names_in(package, kind)]
            elsewhere = f"; there is graphflow.msgs.{package}.{others[0]}.{rest[1]}" if others else ""
            hint = elsewhere or registry.misplaced(package, rest[1]) or did_you_mean(rest[1], known)
            raise ImportError(f"package {package!r} has no {rest[0]} {rest[1]!r}{hint}", name=fullname)
        if len(rest) == 1 and rest[0] not in registry.KINDS:  # `from package import Name`, without the kind
            kinds = [kind for kind in registry.KINDS if rest[0] in registry.names_in(package, kind)]
            if kinds:
                raise ImportError(f"write from {_ROOT}{package}.{kinds[0]} import {rest[0]}", name=fullname)
        if rest and (len(rest) > 1 or rest[0] not in registry.KINDS):
            return None
        return importlib.machinery.ModuleSpec(fullname, self, is_package=True)  # type: ignore[arg-type]  # a loader by its methods

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        package, _, kind = module.__name__.removeprefix(_ROOT).partition(".")
        if not kind:
            module.__doc__ = f"The interfaces of ROS 2's package {package}."
            return

        def make(name: str) -> type | list[str]:
            if name == "__all__":  # asked for by `from ... import *` only
                return registry.names_in(package, kind)
            if name.startswith("__"):
                raise AttributeError(name)
            try:
                cls = registry.interface_class(f"{package}/{kind}/{name}")
            except UnknownInterface as error:
                if name in registry.names_in(package, kind):  # otherwise the unknown name is that of a field's type
                    text = f"{package}/{kind}/{name} has a field of an unknown type: {error}"
                    raise UnknownInterface(text) from None
                raise AttributeError(str(error)) from None
            except InterfaceError as error:
                raise error.with_traceback(None) from None  # the file and line are in its text
            setattr(module, name, cls)
            return cls

        module.__doc__ = f"The {kind} interfaces of ROS 2's package {package}."
        module.__getattr__ = make  # type: ignore[method-assign]
        module.__dir__ = lambda: registry.names_in(package, kind)  # type: ignore[method-assign]


def _add_those_of_the_script() -> bool:
    """Add the interfaces of the project whose file is run, as in `python nodes/talker.py`."""
    file = getattr(sys.modules.get("__main__"), "__file__", None)
    for folder in Path(file).resolve().parents if file else ():
        if (folder / "interfaces").is_dir() and any((folder / mark).exists() for mark in ("pyproject.toml", "nodes")):
            registry.add_root(folder / "interfaces")
            return True
    return False


def install() -> None:
    """Add the finder to `sys.meta_path`, once."""
    if not any(isinstance(f, _InterfaceFinder) for f in sys.meta_path):
        sys.meta_path.insert(0, _InterfaceFinder())
