"""A recording in Rerun: everything at its time, with a layout that opens ready."""

from __future__ import annotations

from pathlib import Path

import rerun as rr
import rerun.blueprint as rrb

from graphflow.errors import UsageFault
from graphflow.msgs.base import Message
from graphflow.msgs.std_msgs.msg import Header
from graphflow.msgs.tf2_msgs.msg import TFMessage
from graphflow.viewer.rerun.archetypes import shown

FIXED = ("map", "odom", "world")
"""Frames that count as fixed, the best first."""
RECEIVED, STAMPED = "received", "stamp"
"""The timelines: by the clock of this machine, and by the messages' own stamps."""


class Recording:
    """Messages, as they are logged to Rerun.

    Args:
        title: The name of the recording in the viewer.
    """

    def __init__(self, title: str) -> None:
        self.stream = rr.RecordingStream("graphflow", recording_id=None, send_properties=True)
        self._title = title
        self._frames: dict[str, str] = {}
        """The frame of each entity, which is logged once."""
        self._fixed = ""
        self.stream.send_recording_name(title)
        self.stream.send_blueprint(layout(""))

    def open(self, file: Path | None) -> None:
        """Open the viewer, or begin to write a file that it opens.

        Raises:
            UsageFault: The file cannot be written, or the viewer cannot be started.
        """
        try:
            if file is not None:
                self.stream.save(file)
            else:
                self.stream.spawn()
        except (OSError, RuntimeError) as error:
            what = f"cannot write {file}" if file is not None else "cannot start Rerun"
            raise UsageFault(f"{what}: {error}; --save FILE.rrd writes a file without the viewer") from None

    def close(self) -> None:
        """Write what is left."""
        self.stream.flush()

    def add(self, topic: str, type_name: str, message: Message, received_ns: int) -> None:
        """Log a message that was received at some time, nanoseconds since 1970."""
        stream = self.stream
        stream.set_time(RECEIVED, timestamp=received_ns / 1e9)
        header = getattr(message, "header", None)  # most types have one
        seconds = header.stamp.sec + header.stamp.nanosec / 1e9 if isinstance(header, Header) else 0.0
        if seconds:
            stream.set_time(STAMPED, duration=seconds)
        else:
            stream.disable_timeline(STAMPED)
        for path, frame, archetype in shown(topic, type_name, message):
            if frame and self._frames.get(path) != frame:
                self._frames[path] = frame
                stream.log(path, rr.CoordinateFrame(frame), static=True)
            stream.log(path, archetype)
        if isinstance(message, TFMessage):
            self._look_for_fixed(message)

    def _look_for_fixed(self, message: TFMessage) -> None:
        """Show everything in the best fixed frame that is known."""
        parents = {one.header.frame_id.lstrip("/") for one in message.transforms}
        known = FIXED[: FIXED.index(self._fixed)] if self._fixed else FIXED
        best = next((frame for frame in known if frame in parents), "")
        if best:
            self._fixed = best
            self.stream.send_blueprint(layout(best))


def layout(fixed: str) -> rrb.Blueprint:
    """Return the layout: space on the left, images, plots and log on the right.

    Args:
        fixed: The frame in which everything is shown; "" where none is known.
    """
    about = rrb.SpatialInformation(target_frame=fixed, show_axes=True) if fixed else None
    space = rrb.Spatial3DView(
        origin="/", name=fixed or "space", contents=["/**", "- /plots/**", "- /log/**"], spatial_information=about
    )
    images = rrb.Spatial2DView(origin="/camera", name="camera")
    plots = rrb.TimeSeriesView(origin="/plots", name="plots")
    log = rrb.TextLogView(origin="/log", name="log")
    right = rrb.Vertical(images, plots, log)
    return rrb.Blueprint(rrb.Horizontal(space, right, column_shares=[2, 1]), collapse_panels=True)
