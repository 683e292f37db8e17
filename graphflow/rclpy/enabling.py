"""Makes `import rclpy` work where somebody has asked for it: in this process, or in a virtual environment for good.

A ROS 2 that is sourced comes before: then nothing of graphflow's stands in for it.
"""

from __future__ import annotations

import importlib.machinery
import os
import sys

from graphflow.system import SITE

FILE = "graphflow-rclpy.pth"
"""What `enable` writes where Python looks for installed packages; Python runs the line each time that it starts."""
TYPINGS = "graphflow-rclpy"
"""The folder beside it with what editors read of messages."""
LINES = f"""{SITE}
{TYPINGS}
import importlib.util as u; u.find_spec("graphflow") and __import__("graphflow.rclpy.site_hook")
"""


def elsewhere() -> str | None:
    """The file of an rclpy that is not graphflow's; None if Python would find none.

    A source tree of it does not count: it cannot be imported before it has been built.
    """
    paths = [entry for entry in sys.path if os.path.abspath(entry or ".") != SITE and not _is_source_tree(entry)]
    found = importlib.machinery.PathFinder.find_spec("rclpy", paths)
    return found.origin if found is not None and found.origin is not None else None


def _is_source_tree(entry: str) -> bool:
    return os.path.isfile(os.path.join(entry, "rclpy", "__init__.py")) and os.path.isfile(
        os.path.join(entry, "package.xml")
    )


def here() -> bool:
    """Let this process import rclpy, and messages under ROS's names; whether it is graphflow's that it imports."""
    if elsewhere() is not None:
        sys.path[:] = [entry for entry in sys.path if entry not in (SITE, typings())]
        return False
    if SITE not in sys.path:
        sys.path.append(SITE)
    from graphflow.rclpy.messages.finder import install, prefer_own

    install()
    if any(map(_is_source_tree, sys.path)):
        prefer_own()
    return True


def file() -> str:
    """The file that `enable` writes."""
    import sysconfig

    return os.path.join(sysconfig.get_path("purelib"), FILE)


def typings() -> str:
    """The folder that `enable` writes for editors."""
    return os.path.join(os.path.dirname(file()), TYPINGS)


def is_enabled() -> bool:
    """Whether Python itself imports rclpy."""
    return os.path.isfile(file())


def enable() -> str:
    """Let this Python import rclpy from now on; returns the file that does it. Raises OSError if that fails."""
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
    """Take that back; whether there was anything to take back. Raises OSError if that is not possible."""
    import shutil

    was_enabled = is_enabled()
    if was_enabled:
        os.remove(file())
    if os.path.isdir(typings()):
        shutil.rmtree(typings())
    return was_enabled
