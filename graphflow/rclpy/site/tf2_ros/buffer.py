"""The transform buffer that a node fills and queries."""

from __future__ import annotations

import threading
import time as clocks
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import TransformStamped
from tf2_msgs.srv import FrameGraph
from tf2_py import BufferCore, LookupException

from rclpy.duration import Duration
from rclpy.impl.deadlock.buffers import know_buffer
from rclpy.impl.watches.unfilled import Unfilled, warn_of_new
from rclpy.task import Future
from tf2_ros.buffer_interface import AT_ONCE, BufferInterface

if TYPE_CHECKING:
    from rclpy.node import Node


class Buffer(BufferCore, BufferInterface):
    """A buffer of transforms between frames; look them up here.

    Args:
        cache_time: The duration for which they are kept; 10 seconds by default.
        node: The node that serves `tf2_frames`, and whose shutdown ends all waits.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._graphflow_changed = threading.Condition()
        self._graphflow_waiting: dict[Future, Callable[[], tuple[bool, str]]] = {}
        self._graphflow_node = node
        self._graphflow = Unfilled()
        warn_of_new()
        if node is not None:
            self.srv = node.create_service(FrameGraph, "tf2_frames", self._graphflow_serve_frames)

    def _graphflow_serve_frames(self, request: object, response: FrameGraph.Response) -> object:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def set_transform(self, transform: TransformStamped, authority: str = "default_authority") -> None:
        self._graphflow.is_filled = True
        super().set_transform(transform, authority)
        self._graphflow_wake()

    def set_transform_static(self, transform: TransformStamped, authority: str = "default_authority") -> None:
        self._graphflow.is_filled = True
        super().set_transform_static(transform, authority)
        self._graphflow_wake()

    def _graphflow_wake(self) -> None:
        """Wake the waiting threads to check again."""
        with self._graphflow_changed:
            self._graphflow_changed.notify_all()
            ready = [future for future, can in self._graphflow_waiting.items() if can()[0]]
            for future in ready:
                del self._graphflow_waiting[future]
        for future in ready:
            future.set_result(True)

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: object, timeout: Duration = AT_ONCE
    ) -> TransformStamped:
        """Return the transform that takes coordinates in `source_frame` to those in `target_frame`.

        Args:
            time: 0 for the latest.
            timeout: The duration to wait for it. Another thread must spin the listener's node meanwhile.

        Raises:
            TransformException: There is none; the subclass gives the reason.
        """
        self.can_transform(target_frame, source_frame, time, timeout)
        try:
            return self.lookup_transform_core(target_frame, source_frame, time)
        except LookupException as error:
            if self._graphflow.remark:
                error.__notes__ = [f"note: {self._graphflow.remark}"]
            raise

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
    ) -> TransformStamped:
        """Return the transform between two times; `fixed_frame` does not move between them."""
        self.can_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        return self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: object,
        timeout: Duration = AT_ONCE,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Whether a transform is available, waiting for it; with `return_debug_tuple` also the reason if not."""
        answer = self._graphflow_wait(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return answer if return_debug_tuple else answer[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: object,
        source_frame: str,
        source_time: object,
        fixed_frame: str,
        timeout: Duration = AT_ONCE,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Whether a transform between two times is available, waiting for it."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        answer = self._graphflow_wait(lambda: self.can_transform_full_core(*asked), timeout)
        return answer if return_debug_tuple else answer[0]

    def _graphflow_wait(self, can: Callable[[], tuple[bool, str]], timeout: Duration) -> tuple[bool, str]:
        if not hasattr(timeout, "nanoseconds"):
            raise TypeError(f"timeout takes a Duration, not {timeout!r}: write timeout=Duration(seconds={timeout!r})")
        until = clocks.monotonic() + timeout.nanoseconds / 1e9
        with self._graphflow_changed:
            while True:
                answer = can()
                left = until - clocks.monotonic()
                is_over = self._graphflow_node is not None and not self._graphflow_node.context.ok()
                if answer[0] or left <= 0 or is_over:
                    break
                self._graphflow_changed.wait(min(left, 0.1))  # the end of a context wakes nobody
        if not answer[0]:
            self._graphflow.lookup_failed(self)
        return answer

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: object) -> Future[bool]:
        """Return a future that is done as soon as a transform is available."""
        return self._graphflow_when(lambda: self.can_transform_core(target_frame, source_frame, time))

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: object, source_frame: str, source_time: object, fixed_frame: str
    ) -> Future[bool]:
        """Return a future that is done as soon as a transform between two times is available."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._graphflow_when(lambda: self.can_transform_full_core(*asked))

    def _graphflow_when(self, can: Callable[[], tuple[bool, str]]) -> Future[bool]:
        future: Future[bool] = Future()
        with self._graphflow_changed:
            is_ready = can()[0]
            if not is_ready:
                self._graphflow_waiting[future] = can
        if is_ready:
            future.set_result(True)
        else:
            future.add_done_callback(lambda done: self._graphflow_waiting.pop(done, None))
        return future

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: object) -> TransformStamped:
        """Wait for a transform in a coroutine callback. Raises TransformException."""
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: object, source_frame: str, source_time: object, fixed_frame: str
    ) -> TransformStamped:
        """Wait for a transform between two times in a coroutine callback. Raises TransformException."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        await self.wait_for_transform_full_async(*asked)
        return self.lookup_transform_full_core(*asked)


know_buffer(Buffer._graphflow_wait, "set_transform", "set_transform_static")
