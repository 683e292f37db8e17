"""Running nodes: `graphflow.run(Talker())` is a whole program; `async with graphflow.running(...)` is for your own."""

from __future__ import annotations

import asyncio
import logging
import sys
from collections.abc import AsyncGenerator, Sequence
from contextlib import AbstractAsyncContextManager, AsyncExitStack, asynccontextmanager
from types import TracebackType
from typing import Never

from graphflow.analysis.one_by_one import one_by_one
from graphflow.analysis.user_code import place_in, users_frame
from graphflow.errors import GraphflowError, TooManyErrors, UsageFault
from graphflow.runtime.args import RosArgs, parse_ros_args
from graphflow.runtime.call_site import here
from graphflow.runtime.context import Context
from graphflow.runtime.ending import StopRequest, catch_signals
from graphflow.runtime.failures import log_with_traceback
from graphflow.runtime.importing import refuse_to_run
from graphflow.runtime.logs.logger import node_logger
from graphflow.runtime.logs.rosout import log_level, setup_console
from graphflow.runtime.mistakes.errors.attribute_errors import explain
from graphflow.runtime.mistakes.errors.lost_errors import tell_lost_errors
from graphflow.runtime.mistakes.other_threads import tell_strangers
from graphflow.runtime.mistakes.unentered import Unentered
from graphflow.runtime.mistakes.unread import unread
from graphflow.runtime.node import Node
from graphflow.runtime.node_arguments import refuse_keywords
from graphflow.runtime.node_core import core_of
from graphflow.runtime.node_options import NodeOptions, make_within
from graphflow.runtime.process_nodes import Company
from graphflow.transport.event_loop import loop

logger = logging.getLogger("graphflow")


def running(*nodes: Node, context: Context | None = None) -> AbstractAsyncContextManager[Context]:
    """Run nodes for the length of the block; a node that fails cancels the block and its error is raised from it.

    Errors are raised as they are, and only if several happen at once as an ExceptionGroup.

    Args:
        context: Where to run them; without one, a new one over Zenoh, closed at the end.
    """
    return _Running(nodes, context)


class _Running(Unentered[Context]):
    """The block of `running`."""

    def __init__(self, nodes: tuple[Node, ...], context: Context | None) -> None:
        for node in nodes:
            core_of(node)
        super().__init__(f"async with graphflow.running({_names(nodes)}): ...")
        self._block: AbstractAsyncContextManager[Context] = _block(nodes, context)

    async def __aenter__(self) -> Context:
        self._is_known = True
        return await self._block.__aenter__()

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool | None:
        return await self._block.__aexit__(kind, error, trace)


@asynccontextmanager
async def _block(nodes: Sequence[Node], context: Context | None) -> AsyncGenerator[Context, None]:
    refuse_to_run("graphflow.running")
    failure: BaseException | None = None
    async with AsyncExitStack() as stack:
        if own := context is None:
            context = await Context.open()
            stack.push_async_callback(context.close)
        tell_lost_errors(context.loop)
        tell_strangers(context.loop)
        for node in nodes:
            core = core_of(node)
            await core.start(context)
            stack.push_async_callback(core.stop)
        if own:
            stack.callback(context.session.leave)
        try:
            async with asyncio.TaskGroup() as group:
                watchers = [group.create_task(core_of(node).wait_ended()) for node in nodes]
                try:
                    yield context
                finally:
                    for watcher in watchers:
                        watcher.cancel()
        except BaseExceptionGroup as errors:
            failure = errors.exceptions[0] if len(errors.exceptions) == 1 else errors
            explain(failure)
        if failure is not None:  # raised here, where the group does not become its context
            raise failure


async def serve(nodes: Sequence[Node], context: Context, stop: StopRequest) -> None:
    """Run nodes until `stop` is set, one fails, or all have ended themselves. The caller then closes the context.

    Raises:
        Exception: What ended a node.
    """
    await Company(context, stop).run(nodes)


def run(*nodes: Node | type[Node], args: Sequence[str] | None = None, **strange: Never) -> None:
    """Run nodes until Ctrl-C or SIGTERM, then stop them in order.

    Args:
        nodes: Nodes, or node classes, which are then made with what the command line says.
        args: Instead of the command line's words; `--ros-args -r from:=to -p name:=value` are understood. They are for
            classes: a node that has been made has its names and values.
        **strange: None: the names of a node and its parameters are arguments of its class.

    Raises:
        RuntimeError: An event loop is running here, as in a notebook.
        SystemExit: With 1 and a message when a node failed, with 2 when the arguments are wrong.
    """
    refuse_to_run("graphflow.run")
    _refuse_running_loop(nodes)
    setup_console()
    if not nodes:
        logger.warning("%s: graphflow.run was given no node, so it runs none; write graphflow.run(Talker)", here())
    try:
        refuse_keywords(strange, nodes)
        ros = parse_ros_args(sys.argv[1:] if args is None else args)
        _refuse_unused(ros, nodes)
        if args is None:
            _refuse_unread(ros, nodes)
        setup_console(log_level(ros.log_level), is_quiet=not ros.has_stdout)
        for name, word in ros.log_levels.items():
            node_logger(f"/{name.replace('.', '/')}").setLevel(log_level(word))
    except GraphflowError as error:
        print_error(error)
        raise SystemExit(2) from None
    made: list[Node] = []
    try:
        for node in nodes:
            if not isinstance(node, type):
                core_of(node)
        made += [n if isinstance(n, Node) else make(n, ros) for n in nodes]
        for node in made:
            core_of(node).refuses_unused = len(made) == 1  # of several, each may be meant by some
    except GraphflowError as error:
        print_error(error)
        raise SystemExit(2) from None
    except Exception as error:
        log_with_traceback(logger, "", error)
        raise SystemExit(1) from None
    if text := one_by_one(users_frame(sys._getframe(1))):
        logger.warning("%s", text)
    try:
        loop.run(_run(made))
    except KeyboardInterrupt:
        return
    except Exception as error:
        is_logged = any(core_of(node).failure is error for node in made)
        if is_logged and not isinstance(error, TooManyErrors):  # of these the node has logged each, and not the sum
            raise SystemExit(1) from None
        if not isinstance(error, GraphflowError):
            explain(error)
            raise
        print_error(error)
        raise SystemExit(2 if isinstance(error, UsageFault) else 1) from None


def _refuse_running_loop(nodes: Sequence[Node | type[Node]]) -> None:
    """See that no event loop runs in this thread.

    Raises:
        RuntimeError: One does; the text says what to write there.
    """
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return
    way = f"async with graphflow.running({_names(nodes)}): ..."
    if "_pytest" in sys.modules:
        way = f"await graph.start({_names(nodes)}), with graph as an argument of the test"
    raise RuntimeError(f"{here()}: graphflow.run starts an event loop, and one runs here already; write {way}")


def _names(nodes: Sequence[Node | type[Node]]) -> str:
    """Nodes as a call has them."""
    return ", ".join(f"{node.__name__}()" if isinstance(node, type) else node.name for node in nodes)


def _refuse_unused(ros: RosArgs, nodes: Sequence[Node | type[Node]]) -> None:
    """See that remaps and parameters of the command line reach every node.

    Raises:
        GraphflowError: One has been made already.
    """
    made = [node for node in nodes if isinstance(node, Node)]
    if made and (ros.remaps or ros.params or ros.params_files):
        name = type(made[0]).__name__
        raise GraphflowError(
            f"-r and -p cannot change {name}(), which has been made already; give the class: graphflow.run({name})"
        )


def _refuse_unread(ros: RosArgs, nodes: Sequence[Node | type[Node]]) -> None:
    """See that the program may read the words that are not for ROS.

    Raises:
        GraphflowError: Nothing reads them.
    """
    classes = [node if isinstance(node, type) else type(node) for node in nodes]
    if text := unread(ros.rest, classes, is_own_program=True):
        raise GraphflowError(text)


def print_error(error: GraphflowError) -> None:
    """Tell the user at the terminal, with the line of the user's own in which it happened."""
    place = place_in(error)
    sys.stderr.write(f"error: {error}{f' ({place})' if place and place not in str(error) else ''}\n")


def make(cls: type[Node], ros: RosArgs) -> Node:
    """A node as the command line wants it.

    Raises:
        GraphflowError: A parameter does not exist or fit.
    """
    interface = cls.interface()
    given = NodeOptions(remaps=ros.remaps, overrides=ros.params_for(interface), rosout=ros.has_rosout)
    node = make_within(cls, given, interface.node_name)
    core_of(node).ensure_made()
    return node


async def _run(nodes: Sequence[Node]) -> None:
    context = await Context.open()
    stop = StopRequest()
    restore = catch_signals(stop)
    try:
        await serve(nodes, context, stop)
    finally:
        await context.close()
        restore()
