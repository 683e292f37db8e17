"""rclpy without ROS: its API implemented with graphflow, on the wire of rmw_zenoh.

rclpy.init()
node = MyNode()
rclpy.spin(node)
rclpy.shutdown()
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from graphflow.rclpy.hints import tracebacks
from rclpy.context import Context
from rclpy.impl.mistakes.spin_arguments import check_executor, check_future, check_node, warn_of_unused
from rclpy.impl.mistakes.swallowed_errors import Spin
from rclpy.parameter import Parameter
from rclpy.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
    watch,
)
from rclpy.task import Future
from rclpy.utilities import get_default_context, get_rmw_implementation_identifier, ok, try_shutdown
from rclpy.utilities import shutdown as _shutdown

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.node import Node

__all__ = [
    "Context",
    "Future",
    "Parameter",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
]

tracebacks.advise_at_exit()
_global_executor: Executor | None = None


def __getattr__(name: str) -> Any:
    """Import a submodule on first access, for programs that only `import rclpy`."""
    if not name.startswith("_") and find_spec(f"rclpy.{name}") is not None:
        return import_module(f"rclpy.{name}")
    raise AttributeError(f"module 'rclpy' has no attribute {name!r}")


class InitContextManager:
    """The result of `init`: a context manager that shuts the context down on exit."""

    def __init__(self, context: Context) -> None:
        self.context = context

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try_shutdown(context=None if self.context is get_default_context() else self.context)
        if self.context is get_default_context():
            uninstall_signal_handlers()


def init(
    *,
    args: Sequence[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Initialize a context: read the command line, and handle signals.

    Args:
        args: The command line; None for the program's own.
        context: The context to initialize; None for the default one.
        domain_id: None for the environment's.
        signal_handler_options: The signals that shut it down; by default all, for the default context.

    Raises:
        RuntimeError: It is already initialized, or an argument is wrong.
    """
    # As in rclpy, only the default context handles signals unless told to: others belong to a part of a program.
    chosen = get_default_context() if context is None else context
    if signal_handler_options is None:
        signal_handler_options = SignalHandlerOptions.ALL if context is None else SignalHandlerOptions.NO
    install_signal_handlers(signal_handler_options)
    tracebacks.install()
    try:
        chosen.init(args, domain_id=domain_id)
    except BaseException:  # Ctrl-C included: restore the signal handlers
        if context is None:
            uninstall_signal_handlers()
        raise
    watch(chosen)
    return InitContextManager(chosen)


def get_global_executor() -> Executor:
    """Return the executor that is used where none is named."""
    global _global_executor
    # `try_shutdown` and leaving `with rclpy.init()` replace the default context and leave this executor behind.
    if _global_executor is None or _global_executor.context is not get_default_context():
        from rclpy.executors import SingleThreadedExecutor

        executor = _global_executor = SingleThreadedExecutor()
        get_default_context().on_shutdown(executor.wake)
    return _global_executor


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down, and leave the network.

    Args:
        context: The context to shut down; None for the default one.
        uninstall_handlers: Whether to restore the signals' former handlers; by default for the default context.

    Raises:
        RuntimeError: It was not initialized, or is already shut down.
    """
    global _global_executor
    if context is None and _global_executor is not None:
        _global_executor.shutdown()
        _global_executor = None
    _shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and context is None):
        uninstall_signal_handlers()


def create_node(
    node_name: str,
    *,
    context: Context | None = None,
    cli_args: list[str] | None = None,
    namespace: str | None = None,
    use_global_arguments: bool = True,
    enable_rosout: bool = True,
    start_parameter_services: bool = True,
    parameter_overrides: list[Parameter] | None = None,
    allow_undeclared_parameters: bool = False,
    automatically_declare_parameters_from_overrides: bool = False,
    enable_logger_service: bool = False,
) -> Node:
    """Create a node; arguments and errors as for `rclpy.node.Node`."""
    from rclpy.node import Node

    return Node(
        node_name,
        context=context,
        cli_args=cli_args,
        namespace=namespace,
        use_global_arguments=use_global_arguments,
        enable_rosout=enable_rosout,
        start_parameter_services=start_parameter_services,
        parameter_overrides=parameter_overrides,
        allow_undeclared_parameters=allow_undeclared_parameters,
        automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
        enable_logger_service=enable_logger_service,
    )


def spin_once(node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None) -> None:
    """Run one callback of a node, waiting at most `timeout_sec` seconds for one to become ready."""
    check_node(node, "spin_once")
    check_executor(executor, "spin_once")
    executor = get_global_executor() if executor is None else executor
    former, is_added = node.executor, False
    try:
        is_added = executor.add_node(node)
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        # A nested spin must not take the node from the executor that runs the callback it is called in.
        if is_added:
            _take_out(node, executor, former, "rclpy.spin_once")


def spin(node: Node, executor: Executor | None = None) -> None:
    """Run the callbacks of a node until the context is shut down."""
    check_node(node, "spin")
    check_executor(executor, "spin")
    if executor is None:
        executor = get_global_executor()
        warn_of_unused(node, executor)
    former, is_added = node.executor, False
    try:
        is_added = executor.add_node(node)
        # As in rclpy, only the end of the context ends it: not the executor's own shutdown, as for `executor.spin`.
        with Spin(executor.context):
            while executor.context.ok():
                executor.spin_once()
    finally:
        if is_added:
            _take_out(node, executor, former, "rclpy.spin")


def spin_until_future_complete(
    node: Node, future: Future, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Run the callbacks of a node until a future is done, at most `timeout_sec` seconds."""
    check_node(node, "spin_until_future_complete")
    check_future(future, "spin_until_future_complete")
    check_executor(executor, "spin_until_future_complete")
    executor = get_global_executor() if executor is None else executor
    former, is_added = node.executor, False
    try:
        is_added = executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        if is_added:
            _take_out(node, executor, former, "rclpy.spin_until_future_complete")


def _take_out(node: Node, executor: Executor, former: Executor | None, what: str) -> None:
    """Remove from its executor a node that was added for `what`."""
    executor.remove_node(node)
    if former is not None and former is not executor:
        from rclpy.impl.watches.orphans import watch

        watch(node, former, what)
