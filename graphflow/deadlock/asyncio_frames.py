"""What a suspended coroutine reveals of its wait: all that is read from asyncio's internals and CPython's frames.

asyncio says only which future a task awaits. What that future stands for (all of these tasks, any of them, a
lock, a deadline) is read here from the coroutines in between, which are known by their code, and from the local names
and private attributes that CPython 3.11 to 3.14 have in common. A test pins each of them, so that a new Python in which
one is missing is reported by that test and not by a search that has gone blind.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import gc
import queue
import sys
import threading
from asyncio import AbstractEventLoop
from collections.abc import Iterable, Iterator
from types import CodeType, FunctionType, MethodType
from typing import Any, Literal, NamedTuple

from graphflow.analysis.frames import Frame, awaited, code_of, suspended
from graphflow.analysis.user_code import is_users

FUTURE = ("set_result", "set_exception", "cancel")
"""Methods that end a future."""
BARRIER = ("wait", "abort", "reset")
"""Methods that let those go on who wait at a barrier."""
_WAITS: dict[CodeType, tuple[str, ...]] = {
    asyncio.Event.wait.__code__: ("set",),
    asyncio.Queue.get.__code__: ("put", "put_nowait"),
    asyncio.Queue.put.__code__: ("get", "get_nowait"),
    asyncio.Queue.join.__code__: ("task_done",),
    asyncio.Condition.wait.__code__: ("notify", "notify_all"),
    asyncio.Semaphore.acquire.__code__: ("release",),
    asyncio.Lock.acquire.__code__: ("release",),
    threading.Event.wait.__code__: ("set",),
    threading.Condition.wait.__code__: ("notify", "notify_all"),
    threading.Semaphore.acquire.__code__: ("release",),
    queue.Queue.get.__code__: ("put", "put_nowait"),
    queue.Queue.put.__code__: ("get", "get_nowait"),
    queue.Queue.join.__code__: ("task_done",),
    concurrent.futures.Future.result.__code__: FUTURE,
    asyncio.Barrier.wait.__code__: BARRIER,
}
"""Waits of asyncio and of threads, and the methods of the same object that end them."""
DEEDS = {
    FUTURE: "ends",
    ("set",): "sets",
    ("put", "put_nowait"): "fills",
    ("get", "get_nowait"): "empties",
    ("task_done",): "works off",
    ("notify", "notify_all"): "notifies",
    ("release",): "releases",
    BARRIER: "comes to",
}
"""What those methods do, in words, by the methods."""
ENDINGS = {"clear", *(name for names in _WAITS.values() for name in names)} - {"wait"}
_TASK_GROUP_EXITS = tuple(
    getattr(asyncio.TaskGroup, name).__code__ for name in ("__aexit__", "_aexit") if hasattr(asyncio.TaskGroup, name)
)
_WAIT = asyncio.tasks._wait.__code__  # type: ignore[attr-defined]
_WAIT_FOR = asyncio.wait_for.__code__
_CONDITION_WAIT = asyncio.Condition.wait.__code__
_ENTER = asyncio.Lock.__aenter__.__code__
_EXITS = ("__aexit__", "__exit__")


def coroutines(task: Any) -> Iterator[Any]:
    """The coroutine of a suspended task and those that it awaits, the outermost first."""
    return awaited(task.get_coro())


def frames_of(task: Any) -> list[Frame]:
    """The frames of a suspended task, the outermost first."""
    return [frame for frame in map(suspended, coroutines(task)) if frame is not None]


def entered(coroutine: Any) -> Iterator[Any]:
    """What a suspended coroutine has entered by `with`: CPython keeps the method that leaves it on the stack.

    Until 3.13 that is a bound method. Since 3.14 it is a function with its object above it.
    """
    below: Any = None
    for referent in gc.get_referents(coroutine):
        if isinstance(referent, MethodType) and referent.__name__ in _EXITS:
            yield referent.__self__
        elif isinstance(below, FunctionType) and below.__name__ in _EXITS and _is_method_of(below, referent):
            yield referent
        below = referent


def files_entered(coroutine: Any) -> Iterator[str]:
    """The source files of what a suspended coroutine has entered by `with`; empty for what is not known."""
    for context in entered(coroutine):
        generator = getattr(context, "gen", None)  # of contextlib's decorators
        code = code_of(generator)
        if code is not None:
            yield code.co_filename
        elif isinstance(context, (contextlib.ExitStack, contextlib.AsyncExitStack)):
            yield ""
        else:
            yield getattr(sys.modules.get(type(context).__module__), "__file__", None) or ""


def may_give_up(task: Any) -> bool:
    """Whether a suspended task has entered something of the user's by `with`, in which there may be a timeout."""
    return any(is_users(file) for coroutine in coroutines(task) for file in files_entered(coroutine))


def _is_method_of(function: FunctionType, thing: object) -> bool:
    return any(vars(cls).get(function.__name__) is function for cls in type(thing).__mro__)


def waiter_of(task: Any) -> Any:
    """The future that a task awaits; None when its next step is due."""
    return getattr(task, "_fut_waiter", None)


def is_done(future: Any) -> bool:
    """Whether a future or task is done; callable from any thread."""
    return bool(future.done())


class JointWait(NamedTuple):
    """A wait for several tasks together."""

    tasks: list[Any]
    wants: Literal["all", "any"]
    fails_early: bool
    """Whether an error in one of them ends the wait."""


def joint_wait(frame: Frame) -> JointWait | None:
    """The tasks that one of asyncio's primitives waits for, if this is the frame of one."""
    code, names = frame.f_code, frame.f_locals
    if code in _TASK_GROUP_EXITS:
        return JointWait(list(names["self"]._tasks), "all", True)
    if code is _WAIT:
        is_all = names["return_when"] == asyncio.ALL_COMPLETED
        return JointWait(list(names["fs"]), "all" if is_all else "any", False)
    if code is _WAIT_FOR and asyncio.isfuture(names.get("fut")):
        return JointWait([names["fut"]], "all", True)
    return None


def gathered(future: Any) -> JointWait | None:
    """What `asyncio.gather` waits for, if that made the future."""
    children = getattr(future, "_children", None)
    return None if children is None else JointWait(list(children), "all", not _returns_errors(children))


def _returns_errors(children: Iterable[Any]) -> bool:
    """Whether `asyncio.gather` was called with `return_exceptions`, by the callback that it adds to its parts."""
    for child in children:
        for callback in _callbacks(child):
            found = _enclosed(callback, "return_exceptions")
            if found is not None:
                return bool(found)
    return False


def shielded(outer: Any) -> Any:
    """What `asyncio.shield` protects, found by the callback that it adds to the outer future; None without a shield."""
    for callback in _callbacks(outer):
        if getattr(callback, "__name__", "") == "_outer_done_callback":
            return _enclosed(callback, "inner")  # since 3.14 the closure has whoever shields, too
    return None


def awaited_tasks(task: Any) -> Iterator[Any]:
    """The tasks whose end a suspended task waits for, one of them or all."""
    joint = (joint_wait(frame) for frame in frames_of(task))
    todo = [waiter_of(task), *(future for wait in joint if wait is not None for future in wait.tasks)]
    while todo:
        future = todo.pop()
        if hasattr(future, "get_coro"):
            if not future.done():
                yield future
        elif future is not None:
            together = gathered(future)
            todo += [shielded(future)] if together is None else together.tasks


def stands_for_others(future: Any) -> bool:
    """Whether a future ends as others do, which may have been made later: it is a task, or asyncio made it of some."""
    return hasattr(future, "get_coro") or gathered(future) is not None or shielded(future) is not None


def has_failed(future: Any) -> bool:
    """Whether a future that is done was cancelled or has an error."""
    return bool(future.cancelled() or future.exception() is not None)


def _enclosed(function: Any, name: str) -> Any:
    """The variable of that name in the closure of a function; None if it has none."""
    names = getattr(getattr(function, "__code__", None), "co_freevars", ())
    return function.__closure__[names.index(name)].cell_contents if name in names else None


def _callbacks(future: Any) -> Iterator[Any]:
    for entry in getattr(future, "_callbacks", None) or ():
        yield entry[0] if isinstance(entry, tuple) else entry


def deadlines(coroutine: Any) -> Iterator[float]:
    """When a suspended coroutine times out by asyncio's means, in seconds of its loop's clock."""
    frame = suspended(coroutine)
    if frame is not None and frame.f_code in (_WAIT, _WAIT_FOR):
        when = getattr(frame.f_locals.get("timeout_handle"), "when", None)  # uvloop's has one too
        if when is not None:
            yield when()
    for context in entered(coroutine):
        if isinstance(context, asyncio.Timeout) and (due := context.when()) is not None:
            yield due


def sent_to_loop(frame: Frame) -> Any:
    """The task of the coroutine that a thread has sent to a loop and waits for in this frame; None for no such wait."""
    if frame.f_code is not concurrent.futures.Future.result.__code__:
        return None
    found = (_enclosed(callback, "source") for callback in frame.f_locals["self"]._done_callbacks)
    return next((task for task in found if asyncio.isfuture(task)), None)


class ObjectWait(NamedTuple):
    """A wait for an event, a queue, a lock or the like."""

    thing: Any
    endings: tuple[str, ...]
    """The object's methods that end the wait."""
    is_bounded: bool
    """Whether a thread gives up the wait after some time."""


def object_wait(frame: Frame) -> ObjectWait | None:
    """What one of asyncio's or threading's primitives waits for, if this is the frame of one."""
    endings = _WAITS.get(frame.f_code)
    if endings is None:
        return None
    names = frame.f_locals
    return ObjectWait(names["self"], endings, names.get("timeout") is not None)


_OTHER_FUTURES: set[type] = set()


def know_futures(cls: type) -> None:
    """Have the instances of a class, not those of its subclasses, taken for futures that code may set."""
    _OTHER_FUTURES.add(cls)


def awaited_future(future: Any) -> ObjectWait | None:
    """A wait for a future that is not a task; a task would end by itself."""
    is_plain = isinstance(future, asyncio.Future) and not isinstance(future, asyncio.Task)
    is_plain |= type(future) in _OTHER_FUTURES
    return ObjectWait(future, FUTURE, False) if is_plain else None


def is_inside(thing: Any, lock: Any) -> bool:
    """Whether something is a given lock, or a condition that has it."""
    return lock is thing or lock is getattr(thing, "_lock", None)


def times_inside(task: Any, lock: Any) -> int:
    """How often a suspended task has entered a lock, or a condition that has it, by `with`, and is inside now."""
    chain = list(coroutines(task))
    entries = sum(is_inside(context, lock) for coroutine in chain for context in entered(coroutine))
    inside = [frame for frame in map(suspended, chain) if frame is not None]
    outside = [frame.f_locals["self"] for frame in inside if frame.f_code in (_CONDITION_WAIT, _ENTER)]
    return entries - sum(is_inside(context, lock) for context in outside)


def current_task(loop: AbstractEventLoop) -> Any:
    """What a loop is stepping just now; from any thread."""
    return asyncio.current_task(loop)
