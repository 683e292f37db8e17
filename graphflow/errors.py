"""The errors of graphflow; the type names the cause, and the text gives the next step.

GraphflowError
|-- DeclarationError          a node class has a wrong declaration (raised when it is imported)
|-- InvalidName                a topic, service or node name, or a remap rule, is not legal
|-- InterfaceError            a .msg, .srv or .action definition is missing or wrong
|   `-- UnknownInterface      no interface has the name; the text gives the nearest
|-- EncodeError               a message has a value that its type cannot carry
|-- DecodeError               bytes from the network do not fit their type (the peer's mistake)
|-- ParameterError            a parameter is unknown, of another type, out of range or read-only
|-- GraphFileError            a graph file has mistakes; carries all problems with their places
|-- TransportError            the network refused: port taken, silent rendezvous, another user's
|-- BagError                  a bag cannot be read or written
|-- MapFileError              a map's picture cannot be read, or a map cannot be written
|-- NoCamera                  the machine cannot draw the images of simulated cameras
|-- ClosedError               a node, session or endpoint is used after it was closed
|-- WrongThread               a thread other than the event loop's uses a node
|-- TooManyErrors             a node's handlers have failed too often, and the node ends
|-- SupervisorError           a graph could not be started, or is not running
|-- NoClass                   the module of a node class has no such class
|-- NoModule                  the module of a node class does not exist
|-- UsageFault                the command line is wrong
|   `-- RunsWhenImported      a module that is imported for its classes runs nodes
|-- Abort                     raised by an action's handler to abort its goal
|-- GoalError                 a goal ended without success
|   |-- GoalRejected          the server did not accept it
|   |-- GoalAborted           the server aborted it; carries its result
|   |-- GoalCanceled          a client cancelled it; carries its partial result
|   `-- GoalLost              the server disappeared; the outcome is unknown
|-- TransitionRefused         raised by a lifecycle hook to keep the node in its state
|-- TransitionFailed          a lifecycle transition was refused, failed, or is not possible now
|-- LoopBlockedError          a blocking call was made on the event loop
|-- TransformError            a transform between two frames is not available
|   |-- UnknownFrame          nobody has placed a frame of that name
|   |-- UnconnectedFrames     the frames are in two trees
|   |-- FrameLoop             the frames above one of them form a loop
|   `-- ExtrapolationError    the time is before or after the known transforms
`-- CallError                 a call ended without a response
    |-- ServiceUnavailable    no node offers that name
    |-- ServerLost            the server disappeared during the call
    |-- CallTimeout           the deadline passed
    |-- ServerBusy            the server's queue is full
    |-- ServerInactive        the server is a lifecycle node that is not active
    |-- RemoteError           the handler raised; carries the remote type and message
    `-- DeadlockError         the call can never be answered
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple
from unicodedata import category


class GraphflowError(Exception):
    """The base class of graphflow's errors."""


class DeclarationError(GraphflowError):
    """A node class declares something that cannot work; raised when the class is created."""


class InvalidName(GraphflowError, ValueError):
    """A name or remap rule breaks ROS 2's naming rules."""


class InterfaceError(GraphflowError):
    """An interface definition is missing or malformed."""


class UnknownInterface(InterfaceError, LookupError):
    """No interface of that name is bundled or found in the project."""


class EncodeError(GraphflowError, ValueError):
    """A field has a value that its type cannot carry. The text starts with the field's path."""


class DecodeError(GraphflowError, ValueError):
    """A payload ends early or does not fit its type; the only error of decoding."""


class ParameterError(GraphflowError, ValueError):
    """A parameter was refused and keeps its value."""


class TransportError(GraphflowError):
    """The network failed or refused: a port is taken, the rendezvous does not answer, or it is another user's."""


class BagError(GraphflowError):
    """A bag cannot be read or written."""


class MapFileError(GraphflowError):
    """A map's picture cannot be read, or a map cannot be written."""


class NoCamera(GraphflowError):
    """The machine cannot draw the images of simulated cameras off screen; the text says what is missing."""


class ClosedError(GraphflowError):
    """The node, session or endpoint was closed before this use."""


class WrongThread(GraphflowError, RuntimeError):
    """An object of a node's event loop was used from another thread."""


class TooManyErrors(GraphflowError):
    """A node's error budget is spent."""


class SupervisorError(GraphflowError):
    """A graph could not be started, reached or stopped.

    Attributes:
        exit_code: The exit code of the command line: 1 failed, 2 usage, 3 nothing running, 4 timeout.
    """

    def __init__(self, message: str, exit_code: int = 1) -> None:
        super().__init__(message)
        self.exit_code = exit_code


class NoClass(GraphflowError):
    """The module of a node class exists, and the class does not."""


class NoModule(GraphflowError):
    """The module of a node class does not exist.

    Attributes:
        module: The first part of its path that was not found.
    """

    def __init__(self, message: str, module: str) -> None:
        super().__init__(message)
        self.module = module


class UsageFault(GraphflowError):
    """The command line is wrong."""


class RunsWhenImported(UsageFault):
    """A module that is imported for its classes runs nodes: it is a program."""


class Place(NamedTuple):
    """A position in a text file; line and column count from 1, and 0 is unknown."""

    file: str
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        return ":".join([self.file, *(str(n) for n in (self.line, self.column) if n)])


NOWHERE = Place("")
"""The unknown place."""


class Problem(NamedTuple):
    """A mistake in a graph file, or in a file or class that it names."""

    place: Place
    message: str

    def __str__(self) -> str:
        return f"{self.place}: {self.message}"


class GraphFileError(GraphflowError):
    """A graph file has mistakes; `problems` are all that were found, in the order of the file."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(sorted(problems))
        super().__init__("\n".join(str(p) for p in self.problems))


LONGEST_TEXT = 4_000
"""Length limit in characters of another process's text in an error."""


_COLOUR = re.compile(r"\x1b\[[0-9;]*m")


def printable(text: str) -> str:
    """Return a text from another process as an error can contain it: of bounded length, and harmless."""
    return harmless(text[:LONGEST_TEXT])


def harmless(text: str) -> str:
    """Escape the control characters of a text, which a terminal would obey, except line breaks and tabs."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() or c in "\n\t" or category(c) == "Zs" else repr(c)[1:-1] for c in text)


def uncoloured(text: str) -> str:
    """Return a line of a log, `harmless` and without colours."""
    return harmless(_COLOUR.sub("", text) if "\x1b" in text else text)


class Abort(GraphflowError):
    """Raised by the handler of an action: `raise Abort(result)`, `raise Abort("the way is blocked")`.

    The goal ends as aborted, with `result` or else with `goal.partial`.
    """

    def __init__(self, result: object = None, reason: str = "") -> None:
        is_reason = isinstance(result, str)
        super().__init__(result if is_reason else reason)
        self.result = None if is_reason else result


class GoalError(GraphflowError):
    """A goal ended without success.

    Attributes:
        result: The result that the server sent; None if it sent none.
    """

    def __init__(self, message: str, result: object = None) -> None:
        super().__init__(message)
        self.result = result


class GoalRejected(GoalError):
    """The server did not accept the goal: it is busy, or its accept hook refused."""


class GoalAborted(GoalError):
    """The server aborted the goal."""


class GoalCanceled(GoalError):
    """The goal was cancelled, by this client or another."""


class GoalLost(GoalError):
    """The server disappeared; the outcome of the goal is unknown."""


class TransitionRefused(GraphflowError):
    """Raised by a hook of a `LifecycleNode` that cannot make the transition: the node keeps its state."""


class TransitionFailed(GraphflowError):
    """A requested lifecycle transition was refused, failed, or is not possible now."""


class LoopBlockedError(GraphflowError):
    """A blocking call was made on the event loop, which would stop the whole process; await it instead."""


class TransformError(GraphflowError):
    """A transform between two frames is not available.

    Attributes:
        target, source: The frames that were looked up.
        frame: The frame that is missing or too old; "" if it is not one.
    """

    def __init__(self, message: str, target: str, source: str, frame: str = "") -> None:
        super().__init__(message)
        self.target, self.source, self.frame = target, source, frame


class UnknownFrame(TransformError):
    """No transform has named the frame."""


class UnconnectedFrames(TransformError):
    """Two frames are in separate trees."""


class FrameLoop(TransformError):
    """The parents of a frame lead back to it."""


class ExtrapolationError(TransformError):
    """A time is before or after the known transforms of a frame.

    Attributes:
        parent: The parent of `frame`.
        requested_ns, oldest_ns, newest_ns: The requested time, and the times between which transforms are known.
    """

    def __init__(
        self, message: str, target: str, source: str, frame: str, parent: str, times: tuple[int, int, int]
    ) -> None:
        super().__init__(message, target, source, frame)
        self.parent = parent
        self.requested_ns, self.oldest_ns, self.newest_ns = times


class CallError(GraphflowError):
    """A service call ended without a response."""


class ServiceUnavailable(CallError):
    """No server offers the service."""


class ServerLost(CallError):
    """The server disappeared while the call was waiting."""


class CallTimeout(CallError, TimeoutError):
    """No response came before the call's deadline."""


class ServerBusy(CallError):
    """The server refused the request because its queue is full."""


class ServerInactive(CallError):
    """The server belongs to a lifecycle node that is not active."""


class RemoteError(CallError):
    """The service handler raised.

    Attributes:
        type: The name of the remote exception's class.
        message: Its text.
    """

    def __init__(self, type: str, message: str, service: str = "") -> None:  # noqa: A002 - the word on the wire
        super().__init__(f"the handler of {service} raised {type}: {message}" if service else f"{type}: {message}")
        self.type = type
        self.message = message

    def to_payload(self) -> bytes:
        """Return the error as the payload of a reply: JSON with `type` and `message`."""
        import json

        return json.dumps({"type": self.type, "message": self.message}).encode()

    @classmethod
    def from_payload(cls, payload: bytes, service: str) -> RemoteError:
        """Read an error reply; a payload of another form becomes the message."""
        import json

        try:
            data = json.loads(payload)
            return cls(printable(str(data["type"])), printable(str(data["message"])), service)
        except (ValueError, KeyError, TypeError):
            return cls("Error", printable(payload[:200].decode(errors="replace")), service)


class DeadlockError(CallError):
    """The call waits, directly or through others, for the caller itself."""
