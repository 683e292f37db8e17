"""Import hooks for message packages under ROS's names: `from geometry_msgs.msg import Twist`.

A package that Python finds without them is left to Python: a sourced ROS 2 takes precedence.
"""

from __future__ import annotations

import importlib.machinery
import os
import sys
from collections.abc import Sequence
from types import ModuleType

from graphflow.system import SITE

_HERE = os.path.dirname(os.path.abspath(__file__))
BUNDLED = os.path.join(os.path.dirname(os.path.dirname(_HERE)), "msgs")
KINDS = ("msg", "srv", "action")
KNOWN: dict[str, str] = {}
"""Folders of message packages that are not bundled, by package name."""


class MessagePackages:
    """Finder and loader in one. It must be nearly free: every import of the process consults it."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        package, _, rest = fullname.partition(".")
        if not rest:
            if not (is_package(package) or fullname == "rclpy"):
                return None
            if _is_elsewhere(fullname, path):
                _warn_of_shadowing(fullname)
                return None
            return self._spec(fullname) if fullname != "rclpy" else None
        kind, _, inner = rest.partition(".")
        is_beside = package in KNOWN and not _is_elsewhere(fullname, path)  # of a package that has code as well
        if kind not in KINDS or not (_is_ours(package) or is_beside):
            return None
        if inner and not inner.startswith("_"):
            return None
        return self._spec(fullname)

    def _spec(self, fullname: str) -> importlib.machinery.ModuleSpec:
        spec = importlib.machinery.ModuleSpec(fullname, self, is_package=True)  # type: ignore[arg-type]  # a loader by its methods
        if fullname in KNOWN:  # with whatever modules lie beside the definitions
            spec.submodule_search_locations = [KNOWN[fullname]]
        return spec

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        from pathlib import Path

        from graphflow.errors import InterfaceError, UnknownInterface
        from graphflow.msgs import registry
        from graphflow.rclpy.messages import classes

        package, *rest = module.__name__.split(".")
        module.__dict__["__graphflow__"] = True
        if not rest:
            module.__doc__ = f"The interfaces of the package {package}."
            return
        kind = rest[0]
        folder = KNOWN.get(package) or _folder(package)
        if folder is not None:
            registry.add_package(package, Path(folder))

        def make(name: str) -> type:
            if name.startswith("__"):
                raise AttributeError(name)
            try:
                cls = classes.interface_class(f"{package}/{kind}/{name}")
            except (UnknownInterface, InterfaceError) as error:
                if name in names:  # it is defined, and something in it is wrong, or not there
                    raise ImportError(f"{package}/{kind}/{name}: {error}", name=module.__name__) from None
                _show_next_steps()
                raise AttributeError(str(error)) from None
            setattr(module, name, cls)
            return cls

        names = registry.names_in(package, kind)
        if len(rest) > 1:  # rosidl's modules of one class: geometry_msgs.msg._twist
            names = [name for name in names if f"_{classes.snake(name)}" == rest[1]]
        if not names:
            _show_next_steps()
            raise ModuleNotFoundError(f"No module named {module.__name__!r}", name=module.__name__)
        module.__doc__ = f"The {kind} interfaces of the package {package}."
        module.__dict__["__all__"] = names
        module.__getattr__ = make  # type: ignore[method-assign]
        module.__dir__ = lambda: names  # type: ignore[method-assign]


def _show_next_steps() -> None:
    """Show the next step of an import's error, also in a program that has not imported rclpy yet."""
    from graphflow.rclpy.hints import tracebacks

    tracebacks.install()


class OwnPackages:
    """Finds graphflow's rclpy, tf2_ros and related packages even if a source tree of theirs is first on the path."""

    def __init__(self) -> None:
        self._names = frozenset(os.listdir(SITE))

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        is_own = path is None and fullname in self._names
        return importlib.machinery.PathFinder.find_spec(fullname, [SITE]) if is_own else None


_NEVER = ("sitecustomize", "usercustomize", "org")
"""Modules that Python imports at each start, and Jython's, which `pickle` tries: they rarely exist."""


class WorkspacePackages:
    """Finds otherwise missing packages in the workspace around the program, or else around the shell.

    For Python that is started directly, such as `python -m pytest`. It searches once.
    """

    def __init__(self) -> None:
        self._roots: list[str] | None = None
        self._is_looking = False

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if self._is_looking or fullname.partition(".")[0] in _NEVER:
            return None
        if self._roots is None:
            self._is_looking = True
            try:
                self._roots = _of_workspace()
            except (ImportError, AttributeError):  # what this needs is itself being imported right now
                return None
            except OSError:  # such as a folder that has been removed
                self._roots = []
            finally:
                self._is_looking = False
            # The finder of message packages was asked before this workspace was known.
            if is_package(fullname):
                return MessagePackages().find_spec(fullname, path, target)
        *above, _ = fullname.split(".")
        return importlib.machinery.PathFinder.find_spec(fullname, [os.path.join(root, *above) for root in self._roots])


def _of_workspace() -> list[str]:
    """Register the message packages of the surrounding workspace; return the folders to import from."""
    from pathlib import Path

    from graphflow.folders import home
    from graphflow.msgs import registry
    from graphflow.workspace.packages import workspace_around

    program = Path(sys.argv[0]) if sys.argv and sys.argv[0].endswith(".py") else Path.cwd()
    found = workspace_around(program) or workspace_around(Path.cwd())
    if found is None or found.root in (home(), Path(found.root.anchor)):  # whose src may hold anything
        return []
    for name, folder in found.interfaces.items():
        KNOWN[name] = str(folder)
        registry.add_package(name, folder)
    return [str(root) for root in found.import_roots]


def is_package(name: str) -> bool:
    """Whether definitions of a message package of that name exist."""
    folder = os.path.join(BUNDLED, name)
    return name in KNOWN or name == "turtlesim_msgs" or any(os.path.isdir(os.path.join(folder, k)) for k in KINDS)


def _is_elsewhere(fullname: str, path: Sequence[str] | None) -> bool:
    """Whether Python finds a package of that name that contains code."""
    found = importlib.machinery.PathFinder.find_spec(fullname, path)
    return found is not None and found.origin is not None


def _warn_of_shadowing(package: str) -> None:
    """Warn that a module shadows a package: importing from it fails, or silently yields something else."""
    found = importlib.machinery.PathFinder.find_spec(package)
    if found is not None and found.origin is not None and found.submodule_search_locations is None:
        from pathlib import Path

        from graphflow.analysis import hiding

        hiding.warn(Path(found.origin))


def _is_ours(package: str) -> bool:
    """Whether a package's modules are generated from definitions: graphflow's, or those in its folder."""
    parent = sys.modules.get(package)
    return parent is not None and (hasattr(parent, "__graphflow__") or _folder(package) is not None)


def _folder(package: str) -> str | None:
    """Return the folder of an imported package if it contains definitions."""
    for entry in getattr(sys.modules.get(package), "__path__", ()):
        for kind in KINDS:
            folder = os.path.join(entry, kind)
            if any(name.endswith(f".{kind}") for _, _, names in os.walk(folder) for name in names):
                return str(entry)
    return None


def install() -> None:
    """Install the hook for message packages."""
    if not any(isinstance(finder, MessagePackages) for finder in sys.meta_path):
        # Before Python's own finder, which takes a source folder such as my_msgs/ for a namespace package.
        sys.meta_path.insert(0, MessagePackages())


def prefer_own() -> None:
    """Install the hook that prefers graphflow's packages over others of their names."""
    if not any(isinstance(finder, OwnPackages) for finder in sys.meta_path):
        sys.meta_path.insert(0, OwnPackages())


def search_workspace() -> None:
    """Install the hook that searches the surrounding workspace."""
    if not any(isinstance(finder, WorkspacePackages) for finder in sys.meta_path):
        sys.meta_path.append(WorkspacePackages())
