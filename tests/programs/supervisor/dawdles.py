"""A module that greets and is then imported for ever."""

from __future__ import annotations

import os
import time

from graphflow import Node

print(os.environ["GREETING"], flush=True)
time.sleep(600)


class Dawdles(Node):
    pass
