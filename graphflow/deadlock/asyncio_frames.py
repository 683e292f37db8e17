"""Inspection of suspended coroutines: the only module that reads asyncio's internals and CPython's frames.

asyncio reveals only which future a task awaits. Its meaning (all of several tasks, any of them, a lock, a deadline) is
in the coroutines between the task and the future. These are recognized by their code objects, and read through local
names and private attributes that CPython 3.11 to 3.14 have in common. A test pins each of them, so that a Python
release without one fails that test rather than blinds the search.
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
from operator import attrgetter
from types import CodeType, FunctionType, MethodType
from typing import Literal, NamedTuple, Protocol, TypeAlias, runtime_checkable

from graphflow.analysis.frames import Frame, awaited, code_of, suspended
from graphflow.analysis.user_code import is_users

AnyFuture: TypeAlias = "asyncio.Future[object]"
"""A future, or a task as a future."""


@runtime_checkable
class TaskLike(Protocol):
    """The driver of a coroutine: an `asyncio.Task`, or an `Activity` of graphflow's executor."""

    def get_coro(self) -> object: ...

    def done(self) -> bool: ...


FUTURE = ("set_result", "set_exception", "cancel")
"""Methods that end a future."""
BARRIER = ("wait", "abort", "reset")
"""Methods that release the waiters of a barrier."""
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
"""The waits of asyncio's and threading's primitives, by code, and the methods of the same object that end them."""
VERBS = {
    FUTURE: "ends",
    ("set",): "sets",
    ("put", "put_nowait"): "fills",
    ("get", "get_nowait"): "empties",
    ("task_done",): "works off",
    ("notify", "notify_all"): "notifies",
    ("release",): "releases",
    BARRIER: "comes to",
}
"""Verbs for reports, by those methods."""
ENDINGS = {"clear", *(name for names in _WAITS.values() for name in names)} - {"wait"}
"""Methods of primitives that change whether a wait ends."""
_TASK_GROUP_EXITS = tuple(
    getattr(asyncio.TaskGroup, name).__code__ for name in ("__aexit__", "_aexit") if hasattr(asyncio.TaskGroup, name)
)
# A coroutine that `asyncio.wait` awaits; as all underscored names of this file, it has no public counterpart.
_WAIT = asyncio.tasks._wait.__code__  # type: ignore[attr-defined]
_WAIT_FOR = asyncio.wait_for.__code__
_CONDITION_WAIT = asyncio.Condition.wait.__code__
_ENTER = asyncio.Lock.__aenter__.__code__
_UNREAD = attrgetter("_log_traceback", "_exception")
_EXITS = ("__aexit__", "__exit__")


def coroutines(task: TaskLike) -> Iterator[object]:
    """Yield the coroutine of a suspended task and those that it awaits, the outermost first."""
    return awaited(task.get_coro())


def frames_of(task: TaskLike) -> list[Frame]:
    """Return the frames of a suspended task, the outermost first."""
    return [frame for frame in map(suspended, coroutines(task)) if frame is not None]


def entered(coroutine: object) -> Iterator[object]:
    """Yield the context managers that a suspended coroutine is inside of.

    For each `with`, CPython keeps the exit method on the value stack, which the garbage collector can see. Until 3.13
    it is a bound method; since 3.14 it is a function with its object above it.
    """
    below: object = None
    for referent in gc.get_referents(coroutine):
        if isinstance(referent, MethodType) and referent.__name__ in _EXITS:
            yield referent.__self__
        elif isinstance(below, FunctionType) and below.__name__ in _EXITS and _is_method_of(below, referent):
            yield referent
        below = referent


def files_entered(coroutine: object) -> Iterator[str]:
    """Yield the source file of each context manager that a suspended coroutine is inside of; empty if unknown."""
    for context in entered(coroutine):
        generator = getattr(context, "gen", None)  # of `contextmanager` and `asynccontextmanager`
        code = code_of(generator)
        if code is not None:
            yield code.co_filename
        elif isinstance(context, (contextlib.ExitStack, contextlib.AsyncExitStack)):
            yield ""
        else:
            yield getattr(sys.modules.get(type(context).__module__), "__file__", None) or ""


def may_give_up(task: TaskLike) -> bool:
    """Whether a suspended task is inside a context manager of the user's, which may contain a timeout."""
    return any(is_users(file) for coroutine in coroutines(task) for file in files_entered(coroutine))


def _is_method_of(function: FunctionType, thing: object) -> bool:
    return any(vars(cls).get(function.__name__) is function for cls in type(thing).__mro__)


def waiter_of(task: object) -> AnyFuture | None:
    """Return the future that a task awaits; None if its next step is due."""
    waiter: AnyFuture | None = getattr(task, "_fut_waiter", None)
    return waiter


def is_done(future: AnyFuture | TaskLike) -> bool:
    """Whether a future or task is done; callable from any thread."""
    return bool(future.done())


class JointWait(NamedTuple):
    """A wait for several futures together."""

    tasks: list[AnyFuture]
    wants: Literal["all", "any"]
    fails_early: bool
    """Whether an error in one of them ends the wait."""


def joint_wait(frame: Frame) -> JointWait | None:
    """Return the futures that one of asyncio's functions waits for; None for a frame of any other function."""
    code, names = frame.f_code, frame.f_locals
    if code in _TASK_GROUP_EXITS:
        return JointWait(list(names["self"]._tasks), "all", True)
    if code is _WAIT:
        is_all = names["return_when"] == asyncio.ALL_COMPLETED
        return JointWait(list(names["fs"]), "all" if is_all else "any", False)
    # Since 3.12 `fut` may be a coroutine, which is awaited in place and found as the next frame.
    if code is _WAIT_FOR and asyncio.isfuture(names.get("fut")):
        return JointWait([names["fut"]], "all", True)
    return None


def gathered(future: object) -> JointWait | None:
    """Return the parts of an `asyncio.gather`; None for a future that it did not make."""
    children: Iterable[AnyFuture] | None = getattr(future, "_children", None)
    return None if children is None else JointWait(list(children), "all", not _returns_errors(children))


def _returns_errors(children: Iterable[AnyFuture]) -> bool:
    """Whether `asyncio.gather` was called with `return_exceptions`, by the callback that it adds to its parts."""
    for child in children:
        for callback in _callbacks(child):
            found = _enclosed(callback, "return_exceptions")
            if found is not None:
                return bool(found)
    return False


def shielded(outer: object) -> AnyFuture | None:
    """Return the future that `asyncio.shield` protects; None if it did not make the outer one.

    The inner future is only in the closure of the callback that `shield` adds to the outer one.
    """
    for callback in _callbacks(outer):
        if isinstance(callback, FunctionType) and callback.__name__ == "_outer_done_callback":
            inner = _enclosed(callback, "inner")  # since 3.14 the closure has the outer future, too
            return inner if asyncio.isfuture(inner) else None
    return None


def awaited_tasks(task: TaskLike) -> Iterator[TaskLike]:
    """Yield the tasks whose end a suspended task waits for, be it one of them or all."""
    joint = (joint_wait(frame) for frame in frames_of(task))
    todo = [waiter_of(task), *(future for wait in joint if wait is not None for future in wait.tasks)]
    while todo:
        future = todo.pop()
        if isinstance(future, TaskLike):
            if not future.done():
                yield future
        elif future is not None:
            together = gathered(future)
            todo += [shielded(future)] if together is None else together.tasks


def stands_for_others(future: object) -> bool:
    """Whether the end of a future depends on others, which may be younger: it is a task, a `gather` or a `shield`."""
    return isinstance(future, TaskLike) or gathered(future) is not None or shielded(future) is not None


def has_failed(future: AnyFuture) -> bool:
    """Whether a future that is done was cancelled or has an error."""
    return bool(future.cancelled() or future.exception() is not None)


def _enclosed(function: object, name: str) -> object:
    """Return the variable of that name in the closure of a function; None if it has none."""
    if not isinstance(function, FunctionType) or name not in function.__code__.co_freevars:
        return None
    cells = function.__closure__ or ()
    return cells[function.__code__.co_freevars.index(name)].cell_contents


def _callbacks(future: object) -> Iterator[object]:
    # asyncio stores pairs of a callback and its context; other futures may store the callback alone.
    for entry in getattr(future, "_callbacks", None) or ():
        yield entry[0] if isinstance(entry, tuple) else entry


def deadlines(coroutine: object) -> Iterator[float]:
    """Yield the times at which asyncio ends the wait of a suspended coroutine, in seconds of its loop's clock."""
    frame = suspended(coroutine)
    if frame is not None and frame.f_code in (_WAIT, _WAIT_FOR):
        # By attribute: uvloop's handle has the method, too, but is no `asyncio.TimerHandle`.
        when = getattr(frame.f_locals.get("timeout_handle"), "when", None)
        if when is not None:
            yield when()
    for context in entered(coroutine):
        if isinstance(context, asyncio.Timeout) and (due := context.when()) is not None:
            yield due


def sent_to_loop(frame: Frame) -> AnyFuture | None:
    """Return the task that a thread waits for after `run_coroutine_threadsafe`; None for a frame of another wait."""
    if frame.f_code is not concurrent.futures.Future.result.__code__:
        return None
    # The concurrent future knows its task only through the callback by which asyncio chains the two.
    found = (_enclosed(callback, "source") for callback in frame.f_locals["self"]._done_callbacks)
    return next((task for task in found if asyncio.isfuture(task)), None)


class ObjectWait(NamedTuple):
    """A wait at a synchronization primitive: an event, a queue, a lock, a future."""

    thing: object
    """The primitive."""
    endings: tuple[str, ...]
    """Its methods that end the wait."""
    is_bounded: bool
    """Whether a thread waits with a timeout."""


def object_wait(frame: Frame) -> ObjectWait | None:
    """Return the wait of a frame that is in a primitive of asyncio or threading; None for any other frame."""
    endings = _WAITS.get(frame.f_code)
    if endings is None:
        return None
    names = frame.f_locals
    return ObjectWait(names["self"], endings, names.get("timeout") is not None)


_OTHER_FUTURES: set[type] = set()


def know_futures(cls: type) -> None:
    """Treat the instances of a class, but not of its subclasses, as futures that code may set."""
    _OTHER_FUTURES.add(cls)


def awaited_future(future: object) -> ObjectWait | None:
    """Return the wait for a future that some code must set; None for a task, which ends by itself."""
    is_plain = isinstance(future, asyncio.Future) and not isinstance(future, asyncio.Task)
    is_plain |= type(future) in _OTHER_FUTURES
    return ObjectWait(future, FUTURE, False) if is_plain else None


def is_inside(thing: object, lock: object) -> bool:
    """Whether an object is a given lock, or a condition that uses it."""
    return lock is thing or lock is getattr(thing, "_lock", None)


def times_inside(task: TaskLike, lock: object) -> int:
    """Count the `with` blocks of a suspended task that hold a lock, or a condition that uses it, right now.

    A task that waits in `Condition.wait`, or still in `Lock.__aenter__`, is in the block but does not hold the lock.
    """
    chain = list(coroutines(task))
    blocks = sum(is_inside(context, lock) for coroutine in chain for context in entered(coroutine))
    frames = [frame for frame in map(suspended, chain) if frame is not None]
    outside = [frame.f_locals["self"] for frame in frames if frame.f_code in (_CONDITION_WAIT, _ENTER)]
    return blocks - sum(is_inside(context, lock) for context in outside)


def unread_error(task: asyncio.Task[object]) -> BaseException | None:
    """Return the error of a task that has failed, as long as nothing has read it; `task.exception()` would do so."""
    if not task.done() or task.cancelled():
        return None
    is_unread, error = _UNREAD(task)
    return error if is_unread else None


def tasks_alive(loop: AbstractEventLoop) -> set[asyncio.Task[object]]:
    """Return the tasks of a loop that still exist; from Python 3.14 on, only those that run.

    Raises:
        RuntimeError: Another thread has made a task meanwhile.
    """
    names = vars(asyncio.tasks)
    known = [*names.get("_scheduled_tasks", names.get("_all_tasks", ()))]
    return {task for task in known if task.get_loop() is loop} | asyncio.all_tasks(loop)


def current_task(loop: AbstractEventLoop) -> object:
    """Return the task or activity that a loop steps right now; None if there is none. Callable from any thread."""
    return asyncio.current_task(loop)
