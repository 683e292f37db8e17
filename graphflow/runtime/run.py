"""Entry points that run nodes: `run` is a whole program, `running` a block inside one."""

from __future__ import annotations

import asyncio
import linecache
import logging
import re
import sys
from collections.abc import AsyncGenerator, Mapping, Sequence
from contextlib import AbstractAsyncContextManager, AsyncExitStack, asynccontextmanager
from types import FrameType, TracebackType
from typing import Never

from graphflow.analysis.one_by_one import one_by_one
from graphflow.analysis.user_code import place_in, users_frame
from graphflow.errors import DeclarationError, GraphflowError, TooManyErrors, UsageFault
from graphflow.runtime.args import RosArgs, parse_ros_args
from graphflow.runtime.call_site import here
from graphflow.runtime.context import Context
from graphflow.runtime.declarations.declared import handlers
from graphflow.runtime.ending import StopRequest, catch_signals
from graphflow.runtime.failures import log_with_traceback
from graphflow.runtime.importing import refuse_to_run
from graphflow.runtime.logs.logger import node_logger
from graphflow.runtime.logs.rosout import log_level, setup_console
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.mistakes.errors.kept_errors import report_kept_errors
from graphflow.runtime.mistakes.errors.lost_errors import log_lost_errors
from graphflow.runtime.mistakes.errors.python_errors import remark_on
from graphflow.runtime.mistakes.other_threads import report_foreign_calls
from graphflow.runtime.mistakes.unentered import Unentered
from graphflow.runtime.mistakes.unread import unread
from graphflow.runtime.node import Node
from graphflow.runtime.node_arguments import refuse_keywords
from graphflow.runtime.node_core import NodeCore, core_of
from graphflow.runtime.node_options import NodeOptions, make_within
from graphflow.runtime.process_nodes import Company
from graphflow.runtime.stop_limit import Interrupted
from graphflow.transport.event_loop import loop

logger = logging.getLogger("graphflow")


def running(*nodes: Node, context: Context | None = None) -> AbstractAsyncContextManager[Context]:
    """Run nodes for the length of the block; if a node fails, the block is cancelled and the error raised from it.

    A single error is raised as it is; simultaneous errors are raised as an ExceptionGroup.

    Args:
        context: The context to use; by default a new one over Zenoh, closed with the block.
    """
    return _Running(nodes, context)


class _Running(Unentered[Context]):
    """The context manager that `running` returns."""

    def __init__(self, nodes: tuple[Node, ...], context: Context | None) -> None:
        for node in nodes:
            core_of(node)
        super().__init__(f"async with graphflow.running({_names(nodes)}): ...")
        self._nodes = nodes
        self._block: AbstractAsyncContextManager[Context] = _block(nodes, context)
        self._has_waited = False

    async def __aenter__(self) -> Context:
        self._is_known = True
        entered = await self._block.__aenter__()
        entered.loop.call_soon(self._note_wait)
        return entered

    def _note_wait(self) -> None:
        self._has_waited = True

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool | None:
        idle = [node.name for node in self._nodes if handlers(type(node))]
        if idle and kind is None and not self._has_waited:
            text = "awaits nothing, so that no handler of %s runs"
            way = "await asyncio.sleep(5.0) in it for a time, or await asyncio.Event().wait() until Ctrl-C"
            logger.warning(f"%s: this block {text}; {way}", self._place, ", ".join(idle))
        if error is not None and (advice := remark_on(error)):
            error.add_note(advice)
        return await self._block.__aexit__(kind, error, trace)


@asynccontextmanager
async def _block(nodes: Sequence[Node], context: Context | None) -> AsyncGenerator[Context, None]:
    refuse_to_run("graphflow.running")
    failure: BaseException | None = None
    async with AsyncExitStack() as stack:
        if own := context is None:
            context = await Context.open()
            stack.push_async_callback(context.close)
        log_lost_errors(context.loop)
        report_kept_errors(context)
        report_foreign_calls(context.loop)
        for node in nodes:
            core = core_of(node)
            await core.start(context)
            stack.push_async_callback(core.stop)
        if own:
            # Pushed last, so called first: before the nodes stop.
            stack.callback(context.session.leave)
        try:
            async with asyncio.TaskGroup() as group:
                entered = asyncio.current_task()
                watchers = [group.create_task(_watch(core_of(node), entered)) for node in nodes]
                try:
                    yield context
                finally:
                    for watcher in watchers:
                        watcher.cancel()
        except BaseExceptionGroup as errors:  # of the block or of nodes; a single error is unwrapped
            failure = errors.exceptions[0] if len(errors.exceptions) == 1 else errors
            explain(failure)
        if failure is not None:  # raised here, where the group does not become its context
            raise failure


async def _watch(core: NodeCore, entered: asyncio.Task[object] | None) -> None:
    """Wait until a node ends.

    Args:
        entered: The task that has entered the block. In a notebook it is that of a cell, which may have ended: then
            nothing can be cancelled, and the node's error is logged.
    """
    try:
        await core.wait_ended()
    except Exception as error:  # the node's own, of any type
        if entered is None or not entered.done():
            raise
        core.log.error("%s", error)
        await core.stop()


async def serve(nodes: Sequence[Node], context: Context, stop: StopRequest) -> None:
    """Run nodes until `stop` is set, one fails, or all have ended themselves. The caller then closes the context.

    Raises:
        Exception: The error that ended a node.
    """
    await Company(context, stop).run(nodes)


def run(*nodes: Node | type[Node], args: Sequence[str] | None = None, **strange: Never) -> None:
    """Run nodes until Ctrl-C or SIGTERM, then stop them in order.

    Args:
        nodes: Nodes, or node classes, which are made with the command line's names and parameters.
        args: The arguments, by default the command line's: `--ros-args -r from:=to -p name:=value`. They apply to
            classes only: an existing node has its names and values.
        **strange: None are accepted: names and parameters are arguments of the node class.

    Raises:
        RuntimeError: An event loop is running in this thread, as in a notebook.
        SystemExit: Status 1 with a message if a node failed, 2 if the arguments are invalid.
    """
    refuse_to_run("graphflow.run")
    _refuse_running_loop(nodes)
    setup_console()
    if not nodes:
        logger.warning("%s: graphflow.run was called without a node; write graphflow.run(Talker)", here())
    ros = _configure(strange, nodes, args)
    made = _make_all(nodes, ros)
    caller = users_frame(sys._getframe(1))
    if text := one_by_one(caller) or _within_asyncio_run(caller):
        logger.warning("%s", text)
    try:
        loop.run(_run(made))
    except Interrupted as interrupted:
        if interrupted.status:
            raise SystemExit(interrupted.status) from None
    except KeyboardInterrupt:
        return
    except Exception as error:  # a node's, of any type
        status = _exit_status(error, made)
        if status is None:
            raise
        raise SystemExit(status) from None


def _within_asyncio_run(caller: FrameType | None) -> str:
    """Return a remark on a line such as `asyncio.run(graphflow.run(Talker))`; "" for others."""
    line = "" if caller is None else linecache.getline(caller.f_code.co_filename, caller.f_lineno)
    if not re.search(r"\basyncio\.run\(\s*(graphflow\.)?run\(", line):
        return ""
    return f"{here()}: graphflow.run runs its own event loop, until the nodes end: leave out asyncio.run"


def _configure(
    strange: Mapping[str, object], nodes: Sequence[Node | type[Node]], args: Sequence[str] | None
) -> RosArgs:
    """Parse the arguments and apply those for logging; exits with status 2 if they are invalid."""
    try:
        refuse_keywords(strange, nodes)
        ros = parse_ros_args(sys.argv[1:] if args is None else args)
        _refuse_unused(ros, nodes)
        if args is None:
            _refuse_unread(ros, nodes)
        setup_console(log_level(ros.log_level), is_quiet=not ros.has_stdout)
        for name, level in ros.log_levels.items():
            node_logger(f"/{name.replace('.', '/')}").setLevel(log_level(level))
    except GraphflowError as error:
        print_error(error)
        raise SystemExit(2) from None
    return ros


def _make_all(nodes: Sequence[Node | type[Node]], ros: RosArgs) -> list[Node]:
    """Make nodes of the classes among `nodes`; exits with status 2, or 1 for an error in a constructor."""
    try:
        for node in nodes:
            if not isinstance(node, type):
                core_of(node)
            elif not issubclass(node, Node):
                way = f"write class {node.__name__}(Node)"
                raise DeclarationError(f"{node.__name__} is not a class of nodes, which derive from Node: {way}")
        made = [n if isinstance(n, Node) else make(n, ros) for n in nodes]
        for node in made:
            core_of(node).refuses_unused = len(made) == 1  # with several nodes a rule need not match in each
    except GraphflowError as error:
        print_error(error)
        raise SystemExit(2) from None
    except Exception as error:  # raised by a user's constructor
        log_with_traceback(logger, "", error)
        raise SystemExit(1) from None
    return made


def _exit_status(error: Exception, made: Sequence[Node]) -> int | None:
    """Report an error that ended the nodes; returns the exit status, or None for an error to propagate."""
    is_logged = any(core_of(node).failure is error for node in made)
    if is_logged and not isinstance(error, TooManyErrors):  # the node has logged each of these, but not their sum
        return 1
    if not isinstance(error, GraphflowError):
        explain(error)
        return None
    print_error(error)
    return 2 if isinstance(error, UsageFault) else 1


def _refuse_running_loop(nodes: Sequence[Node | type[Node]]) -> None:
    """Refuse to run inside a running event loop.

    Raises:
        RuntimeError: A loop is running in this thread; the text has the correct form.
    """
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return
    way = f"async with graphflow.running({_names(nodes)}): ..."
    if "_pytest" in sys.modules:
        way = f"await graph.start({_names(nodes)}), with graph as an argument of the test"
    raise RuntimeError(f"{here()}: graphflow.run starts an event loop, but one is already running here; write {way}")


def _names(nodes: Sequence[Node | type[Node]]) -> str:
    """Return nodes as they are written in a call."""
    return ", ".join(f"{(node if isinstance(node, type) else type(node)).__name__}()" for node in nodes)


def _refuse_unused(ros: RosArgs, nodes: Sequence[Node | type[Node]]) -> None:
    """Refuse remaps and parameters of the command line that do not reach every node.

    Raises:
        GraphflowError: A node exists already, so that they cannot apply to it.
    """
    made = [node for node in nodes if isinstance(node, Node)]
    if made and (ros.remaps or ros.params or ros.params_files):
        name = type(made[0]).__name__
        raise GraphflowError(
            f"-r and -p cannot change {name}(), which has already been created; pass the class: graphflow.run({name})"
        )


def _refuse_unread(ros: RosArgs, nodes: Sequence[Node | type[Node]]) -> None:
    """Refuse arguments that are not ROS 2's and that the program does not read.

    Raises:
        GraphflowError: The program does not seem to read its arguments.
    """
    classes = [node if isinstance(node, type) else type(node) for node in nodes]
    if text := unread(ros.rest, classes, is_own_program=True):
        raise GraphflowError(text)


def print_error(error: GraphflowError) -> None:
    """Print an error and the line of user code that caused it to stderr."""
    place = place_in(error)
    sys.stderr.write(f"error: {error}{f' ({place})' if place and place not in str(error) else ''}\n")


def make(cls: type[Node], ros: RosArgs) -> Node:
    """Make a node of a class from the command line's arguments.

    Raises:
        GraphflowError: A parameter does not exist, or its value does not fit.
    """
    interface = cls.interface()
    given = NodeOptions(remaps=ros.remaps, overrides=ros.params_for(interface), rosout=ros.has_rosout)
    node = make_within(cls, given, interface.node_name)
    core_of(node).ensure_made()
    return node


async def _run(nodes: Sequence[Node]) -> None:
    context = await Context.open()
    stop = StopRequest()
    restore = catch_signals(stop, is_limited=True)
    try:
        await serve(nodes, context, stop)
    finally:
        await context.close()
        # After the close, which a second signal can still cut short.
        restore()
