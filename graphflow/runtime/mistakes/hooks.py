"""Methods that a node itself calls, and names that are meant for one."""

from __future__ import annotations

from graphflow.names import nearest

_HOOKS = {
    "on_start": ("init", "begin", "startup", "ready", "open", "run"),
    "on_shutdown": ("stop", "end", "exit", "close", "destroy", "finish", "cleanup"),
}
"""The methods of every node, and other names for them."""
_OF_LIFECYCLES = ("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_error")


def hook_meant(cls: type, name: str) -> str:
    """Return the node method (of lifecycle nodes, too) that a name seems to mean; "" if none."""
    hooks = [attribute for attribute in dir(cls) if attribute.startswith("on_") and attribute != name]
    near = nearest(name, [hook for hook in hooks if hook in _HOOKS or hook in _OF_LIFECYCLES], cutoff=0.75)
    meant = near or next((hook for hook, others in _HOOKS.items() if name.removeprefix("on_") in others), None)
    if name not in _OF_LIFECYCLES:
        return f"did you mean {meant}?" if meant else ""
    return f"derive {cls.__name__} from LifecycleNode, whose nodes are configured and activated, or write on_start"
