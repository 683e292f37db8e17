"""Images of messages as arrays of OpenCV, and back."""

from __future__ import annotations

from cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]
