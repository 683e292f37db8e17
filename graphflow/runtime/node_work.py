"""The work of a node: in which group and thread its handlers run, and how its runs and tasks end."""

from __future__ import annotations

import asyncio
import inspect
import logging
from collections.abc import Callable, Coroutine, Iterable
from typing import Any

from graphflow.executor.groups import Groups, HandlerGroup
from graphflow.executor.runner import Runner
from graphflow.runtime.callables import name_of
from graphflow.runtime.declarations.declare import Group
from graphflow.runtime.part import Host

STOP_LIMIT = 2.0
"""Seconds that cancelled handlers and tasks have for cleanup."""


def placed(
    host: Host,
    groups: Groups,
    callback: Callable[..., object] | None,
    otherwise: str,
    group: Group | HandlerGroup | None,
    thread: bool,
) -> tuple[str, Any, HandlerGroup | None]:
    """Return a handler's label, the function to call, and the group whose slots its runs take.

    Args:
        callback: None for a subscription that is iterated.
        otherwise: The label of a handler without a name, such as a lambda.
    """
    name = name_of(callback, otherwise)
    label = otherwise if name == "<lambda>" else name
    if callback is None:
        return label, None, None
    place = groups.place(label, group)
    is_threaded = thread or (place.is_threaded and not inspect.iscoroutinefunction(callback))
    return label, _in_thread(host, callback) if is_threaded else callback, place.group


def _in_thread(host: Host, fn: Callable[..., object]) -> Callable[..., Coroutine[object, object, object]]:
    if inspect.iscoroutinefunction(fn):
        raise ValueError(f"{fn.__qualname__}: thread=True is for `def`, an `async def` runs on the loop")

    async def run(*args: object) -> object:
        # A thread cannot be cancelled: the run, and with it the slot, lasts until the thread has ended.
        return await host.context.in_thread(fn, *args, stays=True)

    return run


async def end_work(
    log: logging.Logger, runners: Iterable[Runner | None], tasks: Iterable[asyncio.Task[object]]
) -> None:
    """Cancel runs and tasks of a node, and give them `STOP_LIMIT` seconds to clean up."""
    cancelled = [runner for runner in runners if runner is not None]
    ending: dict[asyncio.Future[Any], str] = {runner.cancel(): runner.name for runner in cancelled}
    for task in {*tasks} - {asyncio.current_task()}:
        task.cancel()
        ending[task] = task.get_name()
    if ending:
        _, stuck = await asyncio.wait(ending, timeout=STOP_LIMIT)
        if stuck:
            from graphflow.runtime.mistakes.unended import unended  # most programs never need it

            names = unended(stuck, ending, cancelled)
            log.warning("still running %.0f s after it was cancelled: %s", STOP_LIMIT, names)


async def limited(host: Host, what: str, work: Callable[[], Coroutine[object, object, object]]) -> None:
    """Run one step of stopping; its failure or timeout does not prevent the next ones."""
    try:
        async with asyncio.timeout(STOP_LIMIT):
            await work()
    except TimeoutError:
        host.log.warning("%s took more than %.0f s and was cancelled", what, STOP_LIMIT)
    except Exception as error:  # of a hook or context manager: the next steps run all the same
        host.report_error(what, error)
