"""Make `import rclpy` work, in this process or permanently in a virtual environment.

A sourced ROS 2 takes precedence: graphflow's packages then stay out of the way.
"""

from __future__ import annotations

# Only light modules: Python imports this one at each start once rclpy is enabled.
import importlib.machinery
import os
import sys

from graphflow.system import SITE

FILE = "graphflow-rclpy.pth"
"""The `.pth` file that `enable` writes into site-packages; Python runs its line at every start."""
TYPINGS = "graphflow-rclpy"
"""The folder beside it with the message stubs for editors."""
# `find_spec` first: the file may outlive graphflow, and each start of Python would report an error.
LINES = f"""{SITE}
{TYPINGS}
import importlib.util as u; u.find_spec("graphflow") and __import__("graphflow.rclpy.site_hook")
"""


def elsewhere() -> str | None:
    """Return the file of an rclpy that is not graphflow's; None if there is none.

    A source tree of rclpy does not count: it cannot be imported before it is built.
    """
    paths = [entry for entry in sys.path if os.path.abspath(entry or ".") != SITE and not _is_source_tree(entry)]
    found = importlib.machinery.PathFinder.find_spec("rclpy", paths)
    return found.origin if found is not None and found.origin is not None else None


def _is_source_tree(entry: str) -> bool:
    return os.path.isfile(os.path.join(entry, "rclpy", "__init__.py")) and os.path.isfile(
        os.path.join(entry, "package.xml")
    )


def here() -> bool:
    """Make rclpy, and messages under ROS's names, importable in this process; return whether rclpy is graphflow's."""
    if elsewhere() is not None:
        sys.path[:] = [entry for entry in sys.path if entry not in (SITE, typings())]
        return False
    if SITE not in sys.path:
        # Last: the user's own modules of these names have precedence.
        sys.path.append(SITE)
    from graphflow.rclpy.messages.finder import install, prefer_own

    install()
    if any(map(_is_source_tree, sys.path)):
        prefer_own()
    return True


def file() -> str:
    """Return the path of the file that `enable` writes."""
    import sysconfig

    return os.path.join(sysconfig.get_path("purelib"), FILE)


def typings() -> str:
    """Return the folder of stubs that `enable` writes for editors."""
    return os.path.join(os.path.dirname(file()), TYPINGS)


def is_enabled() -> bool:
    """Whether Python imports rclpy on its own."""
    return os.path.isfile(file())


def enable() -> str:
    """Make this Python import rclpy from now on; return the file that does it. Raises OSError on failure."""
    from pathlib import Path

    from graphflow.msgs import registry
    from graphflow.msgs.stubs import write
    from graphflow.rclpy.messages.stubs import stubs

    path = file()
    with open(path, "w", encoding="utf-8") as opened:
        opened.write(LINES)
    write(stubs(registry.packages(), Path(typings())))
    return path


def disable() -> bool:
    """Undo `enable`; return whether it was enabled. Raises OSError on failure."""
    import shutil

    was_enabled = is_enabled()
    if was_enabled:
        os.remove(file())
    if os.path.isdir(typings()):
        shutil.rmtree(typings())
    return was_enabled
