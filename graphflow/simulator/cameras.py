"""Images of cameras, drawn off screen by MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from graphflow.errors import NoCamera

FARTHEST = 49.0
"""Metres from which a depth is that of the sky: the drawing ends at 50."""


class Cameras:
    """The drawing of images in one model; its parts are made when the first image is wanted."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model, self._data = model, data
        self._renderers: dict[tuple[int, int], mujoco.Renderer] = {}

    def image(self, camera: str, width: int, height: int) -> NDArray[np.uint8]:
        """Draw what a camera sees: red, green and blue, of shape (height, width, 3).

        Raises:
            NoCamera: This machine cannot draw off screen.
        """
        renderer = self._renderer(width, height)
        renderer.disable_depth_rendering()
        renderer.update_scene(self._data, camera)
        image: NDArray[np.uint8] = renderer.render()
        return image

    def depth(self, camera: str, width: int, height: int) -> NDArray[np.float32]:
        """Measure depths: metres along the camera's axis, of shape (height, width); infinite where nothing is seen.

        Raises:
            NoCamera: As for `image`.
        """
        renderer = self._renderer(width, height)
        renderer.enable_depth_rendering()
        renderer.update_scene(self._data, camera)
        depth: NDArray[np.float32] = renderer.render()
        return np.where(depth < FARTHEST, depth, np.float32(np.inf))

    def _renderer(self, width: int, height: int) -> mujoco.Renderer:
        found = self._renderers.get((width, height))
        if found is None:
            try:
                found = self._renderers[width, height] = mujoco.Renderer(self._model, height, width)
            except Exception as error:  # which error depends on the driver
                text = f"this machine cannot draw images off screen ({error}); "
                text += "install EGL (apt install libegl1), or set MUJOCO_GL to glfw with a display, or to osmesa"
                raise NoCamera(text) from None
        return found

    def close(self) -> None:
        """Free the parts of the graphics card."""
        for renderer in self._renderers.values():
            renderer.close()
        self._renderers.clear()
