"""A worker: one process of the graph, with one node or the nodes that share a `process:`."""

from __future__ import annotations

import asyncio
import faulthandler
import json
import os
import signal
import sys
from importlib import import_module
from typing import Any

from graphflow.errors import GraphflowError, Problem
from graphflow.graph.check import resolver
from graphflow.graph.plan import PlannedNode, node_from_json
from graphflow.runtime.context import Context
from graphflow.runtime.node import Node
from graphflow.runtime.rosout import setup_console
from graphflow.runtime.run import catch_signals, serve

EXIT_ERROR = 70
"""A node failed while it ran."""
EXIT_CONFIGURATION = 78
"""A node could not be made: starting it again would not help."""


def add_root(root: str) -> None:
    """Let modules of the project at `root` be imported.

    Before the installed packages, so that a project's own `nodes` is never shadowed; after the standard library, so
    that a file that happens to be called `queue.py` breaks nothing.
    """
    if root not in sys.path:
        installed = (i for i, entry in enumerate(sys.path) if entry.endswith(("site-packages", "dist-packages")))
        sys.path.insert(next(installed, len(sys.path)), root)


def import_class(class_path: str) -> type[Node]:
    """The node class at `package.module:Class`.

    Raises:
        GraphflowError: There is none, or importing it failed; the text says where.
    """
    module_name, _, class_name = class_path.partition(":")
    try:
        found = getattr(import_module(module_name), class_name, None)
    except Exception as error:
        raise GraphflowError(f"cannot import {module_name}: {_where(error, module_name)}") from error
    if found is None:
        raise GraphflowError(f"module {module_name} has no class {class_name!r}{_classes(module_name, class_name)}")
    if not (isinstance(found, type) and issubclass(found, Node)):
        raise GraphflowError(f"{class_path} is no node class: it does not derive from graphflow.Node")
    return found


def _classes(module_name: str, wanted: str) -> str:
    from graphflow.names import did_you_mean

    values = vars(sys.modules[module_name])
    return did_you_mean(wanted, [k for k, v in values.items() if isinstance(v, type) and issubclass(v, Node)])


def _where(error: BaseException, module_name: str) -> str:
    """The error in one line, with the place in the user's code it came from."""
    if isinstance(error, SyntaxError):
        return f"{error.filename}:{error.lineno}: {error.msg}"
    if isinstance(error, ModuleNotFoundError) and error.name and module_name.startswith(error.name):
        return f"there is no module {error.name!r}"
    frame, place = error.__traceback__, ""
    while frame is not None:
        file = frame.tb_frame.f_code.co_filename
        if not file.startswith("<frozen") and file != __file__ and not file.endswith("importlib/__init__.py"):
            place = f"{file}:{frame.tb_lineno}: "
        frame = frame.tb_next
    text = str(error)
    # A declaration's error names its own place, which is nearer to the mistake than the frame it was raised in.
    return text if text.startswith("/") else f"{place}{type(error).__name__}: {text}"


def make_node(planned: PlannedNode) -> Node:
    """The node that a plan wants.

    Raises:
        GraphflowError: Its class cannot be imported, or refuses what the plan gives it.
    """
    cls = import_class(planned.class_path)
    names = resolver(planned)
    overrides = {name: (setting.value, str(setting.place)) for name, setting in planned.params.items()}
    node = cls(names.name, namespace=names.namespace, remap=[r.remap() for r in planned.remaps], overrides=overrides)
    if not isinstance(node, Node):
        raise GraphflowError(f"{planned.class_path} made a {type(node).__name__}, not a node")
    return node


def interfaces(class_paths: list[str]) -> dict[str, Any]:
    """Interfaces as JSON by class path; for a class that cannot be imported, `{"problem": text}`."""
    found: dict[str, Any] = {}
    for path in class_paths:
        try:
            cls = import_class(path)
            found[path] = cls.interface().to_json()
        except GraphflowError as error:
            found[path] = {"problem": str(error)}
    return found


def read_interfaces(data: dict[str, Any]) -> dict[str, Any]:
    """What `interfaces` gave, as Interfaces and Problems."""
    from graphflow.errors import Place
    from graphflow.interface import Interface

    return {
        path: Problem(Place(""), value["problem"]) if "problem" in value else Interface.from_json(value)
        for path, value in data.items()
    }


def tell(status: int, **event: Any) -> None:
    """Write an event to the supervisor, in one piece."""
    line = json.dumps(event)
    if len(line) > 4000:
        line = json.dumps({**event, "error": str(event.get("error", ""))[:3000]})
    os.write(status, line.encode() + b"\n")


def main(job: dict[str, Any], status: int) -> None:
    """Run a worker to its end; does not return.

    Args:
        job: `nodes` (as of Plan.to_json), `root`, `process`, `domain`, `mode`.
        status: The pipe to the supervisor.
    """
    faulthandler.enable()
    setup_console()
    code = 0
    try:
        add_root(job["root"])
        nodes = [make_node(node_from_json(data)) for data in job["nodes"]]
    except Exception as error:
        _log_failure(error)
        tell(status, event="failed", process=job["process"], error=_one_line(error))
        code = EXIT_CONFIGURATION
    else:
        code = asyncio.run(_run(nodes, job, status))
    sys.stdout.flush()
    sys.stderr.flush()
    # Zenoh's threads can keep an interpreter from ending.
    os._exit(code)


async def _run(nodes: list[Node], job: dict[str, Any], status: int) -> int:
    stop = asyncio.Event()
    catch_signals(stop)
    ready: list[Node] = []

    def is_ready(node: Node) -> None:
        ready.append(node)
        tell(status, event="ready", process=job["process"], node=node.full_name)

    context = None
    try:
        context = await Context.open(job["domain"], mode=job["mode"], checked=True)
        await serve(nodes, context, stop, is_ready)
    except Exception as error:
        at_start = len(ready) < len(nodes)
        if at_start:
            _log_failure(error)
        tell(status, event="failed", process=job["process"], error=_one_line(error))
        return EXIT_CONFIGURATION if at_start and isinstance(error, GraphflowError) else EXIT_ERROR
    finally:
        if context is not None:
            await context.close()
    return 0


def _log_failure(error: Exception) -> None:
    import logging

    expected = isinstance(error, GraphflowError)
    logging.getLogger("graphflow").error("%s", error, exc_info=None if expected else error)


def _one_line(error: Exception) -> str:
    return str(error) if isinstance(error, GraphflowError) else f"{type(error).__name__}: {error}"


def become(log: str, env: dict[str, str]) -> None:
    """Turn a fresh child into a worker's process: session, signals, stdin, log file, environment."""
    os.setsid()
    die_with_parent()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGCHLD, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL if number != signal.SIGPIPE else signal.SIG_IGN)
    signal.set_wakeup_fd(-1)
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    os.close(null)
    out = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
    os.dup2(out, 1)
    os.dup2(out, 2)
    os.close(out)
    os.environ.update(env)
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(line_buffering=True)  # type: ignore[union-attr]


def die_with_parent() -> None:
    """Have the kernel kill this process when its parent dies (Linux)."""
    import ctypes

    if sys.platform != "linux":
        return
    parent = os.getppid()
    pr_set_pdeathsig = 1
    ctypes.CDLL(None, use_errno=True).prctl(pr_set_pdeathsig, signal.SIGKILL)
    if os.getppid() != parent:  # it died before the call
        os._exit(EXIT_ERROR)


if __name__ == "__main__":
    main(json.loads(sys.argv[1]), int(sys.argv[2]))
