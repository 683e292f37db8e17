"""Lets `import` see interface packages: `graphflow.msgs.<package>` and its `msg`, `srv` and `action` modules."""

from __future__ import annotations

import importlib.abc
import importlib.machinery
import sys
from collections.abc import Sequence
from types import ModuleType

from graphflow.errors import UnknownInterface
from graphflow.msgs import registry

_ROOT = "graphflow.msgs."


class _InterfaceFinder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if not fullname.startswith(_ROOT):
            return None
        package, _, kind = fullname.removeprefix(_ROOT).partition(".")
        if kind not in ("", *registry.KINDS) or not registry.package_folders(package):
            return None
        return importlib.machinery.ModuleSpec(fullname, self, is_package=not kind)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        package, _, kind = module.__name__.removeprefix(_ROOT).partition(".")
        if not kind:
            module.__doc__ = f"The interfaces of ROS 2's package {package}."
            return

        def make(name: str) -> type:
            if name.startswith("__"):
                raise AttributeError(name)
            try:
                cls = registry.interface_class(f"{package}/{kind}/{name}")
            except UnknownInterface as error:
                raise AttributeError(str(error)) from None
            setattr(module, name, cls)
            return cls

        module.__doc__ = f"The {kind} interfaces of ROS 2's package {package}."
        module.__getattr__ = make  # type: ignore[method-assign]
        module.__dir__ = lambda: registry.names_in(package, kind)  # type: ignore[method-assign]


def install() -> None:
    """Add the finder once."""
    if not any(isinstance(f, _InterfaceFinder) for f in sys.meta_path):
        sys.meta_path.insert(0, _InterfaceFinder())
