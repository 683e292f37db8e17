"""A lifecycle node whose device is missing."""

from graphflow import LifecycleNode, TransitionRefused


class Camera(LifecycleNode):
    """Refuses to be configured."""

    async def on_configure(self) -> None:
        raise TransitionRefused("no camera")
