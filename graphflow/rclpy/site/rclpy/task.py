"""Futures, and the executor's tasks that complete them."""

from __future__ import annotations

import asyncio
import inspect
import threading
import warnings
import weakref
from collections.abc import Callable, Generator
from typing import TYPE_CHECKING, Any, Generic, Protocol

from rclpy.impl.callers import caller
from rclpy.impl.mistakes import early_results

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    T = TypeVar("T", default=Any)  # as in ROS 2; at run time, Python 3.11 knows no defaults
else:
    from typing import TypeVar

    T = TypeVar("T")


class Runs(Protocol):
    """A runner of tasks: an executor."""

    def create_task(self, callback: Any, *args: Any) -> Any: ...


class _Stepping(threading.local):
    """The task that the current thread is stepping."""

    task: Task | None = None


_stepping = _Stepping()


class Future(Generic[T]):
    """A result that will be set later. Awaitable in an executor's tasks and callbacks, and in asyncio's tasks.

    Args:
        executor: Runs the done callbacks; without one they run in the thread that completes the future.
    """

    def __init__(self, *, executor: Runs | None = None) -> None:
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._is_done = self._is_cancelled = self._was_raised = False
        self._callbacks: list[Callable[..., object]] = []
        self._lock = threading.RLock()
        self.runner: Callable[[], Runs | None] = _none
        """The executor that runs the done callbacks. graphflow's own."""
        self._set_executor(executor)

    def __del__(self) -> None:
        # A subclass's `__init__` may not have called this one, and Python calls `__del__` all the same.
        error = getattr(self, "_exception", None)
        if error is not None and not self._was_raised:
            warnings.warn(f"The following exception was never retrieved: {error}", stacklevel=1)

    def run_callbacks_here(self) -> None:
        """Run the done callbacks as tasks of the executor whose work completes the future. graphflow's own."""
        task = _stepping.task
        if task is not None:
            self._set_executor(task.runner())

    def _set_executor(self, executor: Runs | None) -> None:
        self.runner = _none if executor is None else weakref.ref(executor)

    def __await__(self) -> Generator[object, None, T]:
        # Outside an executor's task, asyncio is awaiting: it accepts only futures of its own loop.
        if not (self._is_done or self._is_cancelled) and _stepping.task is None and asyncio._get_running_loop():
            yield from self._of_asyncio().__await__()
        while not (self._is_done or self._is_cancelled):
            yield self
        return self.result()  # type: ignore[return-value]

    def _of_asyncio(self) -> asyncio.Future[None]:
        """Return a future of the running event loop that is done when this one is."""
        loop = asyncio.get_running_loop()
        twin: asyncio.Future[None] = loop.create_future()

        def settle() -> None:
            if not twin.done():
                twin.set_result(None)

        self.when_done(lambda: loop.call_soon_threadsafe(settle))
        return twin

    def when_done(self, callback: Callable[[], Any]) -> None:
        """Register an immediate callback, run by the thread that completes or cancels the future. graphflow's own."""
        wanted = _AtOnce(callback)
        with self._lock:
            if not (self._is_done or self._is_cancelled):
                if wanted not in self._callbacks:
                    self._callbacks.append(wanted)
                return
        callback()

    def done_callbacks(self) -> list[Callable[..., object]]:
        """Return the registered callbacks. graphflow's own."""
        return list(self._callbacks)

    def cancel(self) -> None:
        """Cancel the future; a result set later is ignored. No effect when it is done."""
        with self._lock:
            if self._is_done:
                return
            self._is_cancelled = True
        self._call_back()

    def cancelled(self) -> bool:
        return self._is_cancelled

    def done(self) -> bool:
        return self._is_done

    def result(self) -> T | None:
        """Return the result; None until it is set. Raises the exception, if that was set."""
        if not (self._is_done or self._is_cancelled):
            early_results.check(caller(1))
        error = self.exception()
        if error is not None:
            raise error
        return self._result

    def exception(self) -> BaseException | None:
        """Return the exception, if one was set."""
        self._was_raised = True
        return self._exception

    def set_result(self, result: T) -> None:
        with self._lock:
            self._result = result
            self._is_done, self._is_cancelled = True, False
        self._call_back()

    def set_exception(self, exception: BaseException) -> None:
        with self._lock:
            self._exception = exception
            self._was_raised = False
            self._is_done, self._is_cancelled = True, False
        self._call_back()

    def _call_back(self) -> None:
        with self._lock:
            # Taken under the lock, called outside of it: a callback may wait for another thread that uses the future.
            callbacks, self._callbacks = self._callbacks, []
        executor = self.runner()
        for callback in callbacks:
            # Not by the executor: it may be what waits for this future.
            if isinstance(callback, _AtOnce):
                callback(self)
            elif executor is not None:
                executor.create_task(callback, self)
            else:
                try:
                    callback(self)
                except Exception as error:  # a user's callback may raise anything; it is not the setter's fault
                    warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)

    def add_done_callback(self, callback: Callable[[Any], Any]) -> None:
        """Call `callback(future)` when done: as a task of the executor, or else in the completing thread."""
        with self._lock:
            if not (self._is_done or self._is_cancelled):
                self._callbacks.append(callback)
                return
            executor = self.runner()
        if executor is not None:
            executor.create_task(callback, self)
        else:
            callback(self)


class _AtOnce:
    """A callback that is not a user's and runs without an executor."""

    def __init__(self, callback: Callable[[], Any]) -> None:
        self.callback = callback

    def __call__(self, future: object) -> None:
        self.callback()

    # So that a loop of spins registers the wake-up of its executor only once.
    def __eq__(self, other: object) -> bool:
        return isinstance(other, _AtOnce) and self.callback == other.callback

    def __hash__(self) -> int:
        return hash(self.callback)


def _none() -> None:
    """Return no executor."""


class Task(Future[T]):
    """A function or coroutine that an executor runs, one step per call.

    Args:
        handler: A function, a coroutine function, or a coroutine.
    """

    def __init__(
        self,
        handler: Any,
        args: tuple[Any, ...] | None = None,
        kwargs: dict[str, object] | None = None,
        executor: Runs | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._args, self._kwargs = args or (), kwargs or {}
        self._coroutine: Any = None
        self._handler: Any = None
        if inspect.iscoroutinefunction(handler):
            self._coroutine = handler(*self._args, **self._kwargs)
        elif inspect.iscoroutine(handler):
            self._coroutine = handler
        else:
            self._handler = handler
        self._step_lock = threading.Lock()
        self.awaits: Future | None = None
        """The future that the coroutine awaits, if known."""

    def __call__(self) -> None:
        """Run the function, or one step of the coroutine. No effect when done, or while another thread runs it."""
        # As in rclpy: a second thread leaves at once, and does not wait for the step of the first.
        if self._is_done or self._is_cancelled or not self._step_lock.acquire(blocking=False):
            return
        try:
            if not (self._is_done or self._is_cancelled):
                self._step()
        finally:
            self._step_lock.release()
            self._stepped()

    def _stepped(self) -> None:
        """Note the end of a step, so that another thread may run the next."""

    def executing(self) -> bool:
        """Whether a thread is running it right now."""
        return self._step_lock.locked()

    def _step(self) -> None:
        # A callback may spin, and thereby step another task inside this one.
        around, _stepping.task = _stepping.task, self
        try:
            if self._coroutine is None:
                handler, self._handler = self._handler, None
                args = self._args  # errors are explained by it
                result = handler(*args, **self._kwargs)
                if not self._suspends(result):
                    self._end(result, None)
                    return
                self._coroutine = result
            self.awaits = None
            awaited = self._coroutine.send(None)
            self.awaits = awaited if isinstance(awaited, Future) else None
        except StopIteration as stop:
            self._end(stop.value, None)
        except (KeyboardInterrupt, SystemExit) as leaving:
            self._end(None, leaving)
            # It leaves the thread now, so `__del__` must not report it again.
            self._was_raised = True
            raise
        except BaseException as error:  # whatever it is, it becomes the task's result
            self._end(None, error)
        finally:
            _stepping.task = around

    def _suspends(self, result: Any) -> bool:
        """Whether a function's result is to be stepped."""
        return False

    def _end(self, result: Any, error: BaseException | None) -> None:
        self._args, self._kwargs, self._coroutine, self._handler = (), {}, None, None
        if error is not None:
            self.set_exception(error)
        else:
            self.set_result(result)

    def cancel(self) -> None:
        super().cancel()
        coroutine = self._coroutine
        # `close` of a running coroutine raises ValueError.
        if coroutine is not None and not self.executing() and not self._is_done:
            coroutine.close()
