"""Service clients."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from graphflow.errors import ServerLost
from graphflow.rclpy.messages import classes
from graphflow.rclpy.wake import Wake
from graphflow.runtime.endpoints.service_events import ServiceEvent
from rclpy._rclpy_pybind11 import RCLError
from rclpy.handle import Handle
from rclpy.impl.mistakes.inverted_waits import Successes
from rclpy.impl.reexports import passed_on
from rclpy.impl.service_end import ServiceEnd
from rclpy.task import Future

if TYPE_CHECKING:
    from graphflow.rclpy.context_state import ContextState
    from graphflow.runtime.endpoints.threaded import Answered, ThreadedClient
    from rclpy.callback_groups import CallbackGroup
    from rclpy.context import Context
    from rclpy.qos import QoSProfile


class Client(ServiceEnd):
    """A service client. Create it with `Node.create_client`."""

    turn = 3
    endpoint: ThreadedClient

    def __init__(
        self,
        context: Context,
        client_impl: ThreadedClient,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup,
        *,
        life: ContextState,
        handle: Handle,
        changed: dict[Wake, None],
    ) -> None:
        self.context, self.srv_type, self.srv_name, self.qos_profile = context, srv_type, srv_name, qos_profile
        self.callback_group = callback_group
        self.endpoint, self._life, self._handle = client_impl, life, handle
        self.pending_requests: dict[int, Future] = {}
        """The futures of calls that have no answer yet, by number. graphflow's own."""
        self._lock = threading.Lock()
        self.server_wakes = changed
        self._successes = Successes()
        """The wake-ups of threads that wait for a server. graphflow's own."""

    def call(self, request: object, timeout_sec: float | None = None) -> Any:
        """Send a request and block until the response; another thread must be spinning.

        Args:
            timeout_sec: Seconds to wait; None for no limit.

        Returns:
            The response; None on timeout.

        Raises:
            TypeError: Not a request of the service's type.
            CallError: A graphflow server answered with an error.
        """
        future = self.call_async(request)
        wake = Wake()
        future.when_done(wake.set)
        self._life.on_end(wake)
        try:
            wake.wait_until(
                lambda: future.done() or not self._life.is_ok,
                None if timeout_sec is None or timeout_sec < 0 else timeout_sec,
            )
        finally:
            self._life.forget(wake)
        if not future.done():
            # None as in Jazzy; later versions of rclpy raise TimeoutError.
            self.remove_pending_request(future)
            return None
        return future.result()

    def call_async(self, request: Any) -> Future:
        """Send a request; the future is done once a spinning thread has taken the response.

        A request without a server logs a warning and gets no answer: call `wait_for_service` first. Errors: see `call`.
        """
        if not isinstance(request, self.srv_type.Request):
            made = f"{self.srv_type.__name__}.Request()"
            raise TypeError(
                f"Expected {self.srv_type.Request}, got {classes.what_came(request)}: create a request with {made}"
            )
        # `_settle` takes the lock, too: an answer may come before the future is stored.
        with self._handle, self._lock:
            future: Future = Future()
            payload = classes.encode(request)
            sequence = self.endpoint.send(payload)
            self.pending_requests[sequence] = future
        self.endpoint.tell(ServiceEvent.REQUEST_SENT, sequence, payload)
        # Not in `_settle`: a program may also cancel the future, or set its result.
        future.when_done(partial(self.pending_requests.pop, sequence, None))
        return future

    def get_pending_request(self, sequence_number: int) -> Future:
        """Return the future of a pending call by its number. Raises KeyError if it is not pending."""
        return self.pending_requests[sequence_number]

    def remove_pending_request(self, future: Future) -> None:
        """Stop waiting for a response."""
        with self._lock:
            for sequence, waiting in list(self.pending_requests.items()):
                if waiting is future:
                    del self.pending_requests[sequence]

    def service_is_ready(self) -> bool:
        """Whether a server is available. Raises RCLError if the context was shut down."""
        with self._handle:
            if not self._life.is_ok:
                raise RCLError("failed to check service availability: rcl node's context is invalid")
            return self.endpoint.has_server

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Block until a server is available, at most `timeout_sec` seconds; return whether one is. Errors as above."""
        wake = Wake()
        self.server_wakes[wake] = None
        # Registered before the first look, so that a server that comes between look and wait wakes the thread.
        self._life.on_end(wake)
        limit = None if timeout_sec is None or timeout_sec < 0 else timeout_sec
        try:
            wake.wait_until(lambda: not self._life.is_ok or self.service_is_ready(), limit)
        finally:
            self._life.forget(wake)
            self.server_wakes.pop(wake, None)
        is_there = self.service_is_ready()
        if is_there:
            self._successes.note(sys._getframe(1))
        return is_there

    def has_work(self) -> bool:
        return bool(self.endpoint.inbox.items)

    def take_work(self) -> Callable[[], object] | None:
        answered = self.endpoint.take()
        return None if answered is None else partial(self._settle, answered)

    def _settle(self, answered: Answered) -> None:
        with self._lock:
            future = self.pending_requests.get(answered.sequence)
        if future is None:
            return
        future.run_callbacks_here()
        if answered.error is None:
            response = classes.decode(self.srv_type.Response, answered.payload)
            self.endpoint.tell(ServiceEvent.RESPONSE_RECEIVED, answered.sequence, answered.payload)
            future.set_result(response)
        elif not isinstance(answered.error, ServerLost):  # ROS 2 leaves such a future pending
            future.set_exception(answered.error)


def __getattr__(name: str) -> Any:
    return passed_on(__name__, name)
