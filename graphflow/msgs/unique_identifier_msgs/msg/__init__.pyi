# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base

class UUID(base.Message):
    uuid: npt.NDArray[np.uint8]
    def __init__(self, *, uuid: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...
