"""Conversion between image messages and OpenCV arrays."""

from __future__ import annotations

from cv_bridge.core import CvBridge, CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]
