"""A module that takes long to be imported."""

from __future__ import annotations

import time

from graphflow import Node

time.sleep(3)


class Late(Node):
    pass
