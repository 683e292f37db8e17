# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from graphflow.msgs import base

class Gid(base.Message):
    data: npt.NDArray[np.uint8]
    def __init__(self, *, data: Sequence[int] | npt.NDArray[np.integer] = ...) -> None: ...

class NodeEntitiesInfo(base.Message):
    node_namespace: str
    node_name: str
    reader_gid_seq: list[Gid]
    writer_gid_seq: list[Gid]
    def __init__(
        self,
        *,
        node_namespace: str = ...,
        node_name: str = ...,
        reader_gid_seq: Sequence[Gid | Mapping[str, object]] = ...,
        writer_gid_seq: Sequence[Gid | Mapping[str, object]] = ...,
    ) -> None: ...

class ParticipantEntitiesInfo(base.Message):
    gid: Gid
    node_entities_info_seq: list[NodeEntitiesInfo]
    def __init__(
        self,
        *,
        gid: Gid | Mapping[str, object] = ...,
        node_entities_info_seq: Sequence[NodeEntitiesInfo | Mapping[str, object]] = ...,
    ) -> None: ...
