# Written by `python -m graphflow.msgs.stubs`; do not edit.

from collections.abc import Mapping, Sequence

from graphflow.msgs import base

class MessagesLostEvent(base.Message):
    node_name: str
    messages_lost_statistics: list[MessagesLostEventTopicStat]
    def __init__(
        self,
        *,
        node_name: str = ...,
        messages_lost_statistics: Sequence[MessagesLostEventTopicStat | Mapping[str, object]] = ...,
    ) -> None: ...

class MessagesLostEventTopicStat(base.Message):
    topic_name: str
    messages_lost_in_transport: int
    messages_lost_in_recorder: int
    def __init__(
        self,
        *,
        topic_name: str = ...,
        messages_lost_in_transport: int = ...,
        messages_lost_in_recorder: int = ...,
    ) -> None: ...

class ReadSplitEvent(base.Message):
    closed_file: str
    opened_file: str
    node_name: str
    def __init__(self, *, closed_file: str = ..., opened_file: str = ..., node_name: str = ...) -> None: ...

class WriteSplitEvent(base.Message):
    closed_file: str
    opened_file: str
    node_name: str
    def __init__(self, *, closed_file: str = ..., opened_file: str = ..., node_name: str = ...) -> None: ...
