"""Advice on errors that Python raises for wrong use of graphflow's API, as a table of patterns."""

from __future__ import annotations

import inspect
import linecache
import re
from asyncio import InvalidStateError
from types import FrameType
from typing import NamedTuple

from graphflow.analysis.hiding import hidden
from graphflow.analysis.user_code import is_users, parts_of, place_in
from graphflow.runtime.mistakes.errors.attribute_errors import named_in
from graphflow.runtime.mistakes.errors.name_errors import owner_of
from graphflow.runtime.mistakes.errors.text_numbers import text_for_number
from graphflow.runtime.mistakes.rclpy_words import EXAMPLES


class Remark(NamedTuple):
    """One row of the table.

    Attributes:
        text: A pattern of the error's text.
        line: A pattern of the user's line that raised it; ATTRIBUTE in it stands for the `attribute` of `text`.
        remark: The advice, a format string with the named groups of both patterns.
    """

    text: str
    line: str
    remark: str


_AWAITED = r"await\s+(?:[\w.]*\.)?(?P<name>\w+)"
_COROUTINE = r"^'coroutine' object |: 'coroutine' and |: '\w+' and 'coroutine'$"
_SEND = "write send instead of send_goal: async with client.send(goal) as sent:"
_SECONDS = "(int|float)"
_SPANS = "(Time|Duration)"
REMARKS = (
    # Python 3.14: "'NoneType' object can't be awaited"; before: "object NoneType can't be used in 'await' expression".
    Remark(
        r"NoneType\b.* '?await", r"await\s+(time\.)?sleep\((?P<pause>[^()]*)\)", "write await self.clock.sleep({pause})"
    ),
    Remark(r"NoneType\b.* '?await", _AWAITED + r"\(", "{name} returns at once: remove await"),
    Remark(
        "^no running event loop$",
        r"asyncio\.(create_task|ensure_future)\(\s*self\.(?P<name>\w+)\(",
        "no loop runs while a node is made: write @task above {name}, or self.spawn(self.{name}) in on_start",
    ),
    Remark(
        r"^'NoneType' object has no attribute '(?P<attribute>\w+)'",
        r"self\.(?P<name>\w+)\.ATTRIBUTE\b",
        "self.{name} is None until something sets it: write if self.{name} is None: return",
    ),
    Remark(
        r'can only concatenate str \(not "(int|float|bool)"\)', "", "convert it with str(value), or use an f-string"
    ),
    Remark(
        r'can only concatenate str \(not "(?P<kind>[A-Z]\w+)"\)',
        r"\+\s*(?P<name>[a-z][\w.]*)",
        "{name} is a {kind}, not a text: take a part of it, or write it into an f-string",
    ),
    Remark(
        r"\bTopicPublisher\.(_shorten\.<locals>\.)?publish\(\) got an unexpected keyword argument '(?P<name>\w+)'",
        "",
        "publish takes a message: publish(Type({name}=...)), of the publisher's type",
    ),
    Remark(
        "^Result is not (set|ready)",
        r"(?P<name>\b[\w.]+)\.result\(",
        "{name} is still at work: write await {name}, which returns its result",
    ),
    Remark(r"\b(method|function)\b.* '?await", _AWAITED, "call it: await {name}()"),
    Remark(
        r"\bTopicSubscription\b.* '?await",
        r"await\s+(?P<read>[\w.]+)",
        "iterate over the messages: async for message in {read}",
    ),
    Remark("'(async_generator|TopicSubscription)' object is not iterable", r"\bfor\b", "write async for"),
    Remark(
        "'(Handler)?Group' object does not support",
        r"\bwith self\.(?P<name>\w+)",
        "handlers name the group that they share: @timer(1.0, group={name})",
    ),
    Remark(
        "'(Handler)?Group' object has no attribute '(acquire|release|locked)'",
        r"self\.(?P<name>\w+)\.",
        "handlers name the group that they share: @timer(1.0, group={name})",
    ),
    Remark(
        "'async for' requires .* got Subscription$",
        r"\bin self\.(?P<name>\w+)",
        "a Subscription is declared in the body of the class: {name} = Subscription(...)",
    ),
    Remark(
        "'coroutine' object does not support the asynchronous context",
        r"\.send_goal\(",
        _SEND,
    ),
    Remark("'ClientGoalHandle' object does not support the asynchronous context", "", _SEND),
    Remark("object does not support the context manager", r"\bwith\b", "write async with"),
    Remark(r"^Transform\.of\(\) takes from", "", "the translation is one argument: (x, y, z)"),
    Remark(
        r"^Transform\.__init__\(\) got an unexpected keyword argument '(rpy|translation|rotation)'",
        "",
        "write Transform.of(parent, child, (x, y, z), rpy=(0.0, 0.0, yaw))",
    ),
    Remark(
        "ClientGoalHandle.*await",
        r"await\s+(?P<name>\w+)",
        "that is the goal at the server: write await {name}.result()",
    ),
    Remark(_COROUTINE, "", "that is a coroutine: write await before the call"),
    Remark(
        "a coroutine was expected, got <(bound method|function)",
        "",
        "call it, or let the node run it: self.spawn(self.work)",
    ),
    Remark(
        r"asyncio\.run\(\) cannot be called|event loop is already running",
        "",
        "nodes run on an event loop: make the method `async def`, and write await",
    ),
    Remark(
        r"^'(bool|int|float|str|bytes|list)' object has no attribute '(value|get_parameter_value)'",
        r"self\.\w+(\(.*\))?\.(value|get_parameter_value)",
        "a parameter reads as its value: remove .value",
    ),
    Remark(
        "'NodeLogger' object is not callable", "", 'a logger has a method for each level: write self.log.info("...")'
    ),
    Remark("'TopicPublisher' object is not callable", r"self\.(?P<name>\w+)\(", "write self.{name}.publish(message)"),
    Remark("'ServiceClient' object is not callable", r"self\.(?P<name>\w+)\(", "write await self.{name}.call(request)"),
    Remark(
        "'(bool|int|float|str)' object is not callable",
        r"self\.(?P<name>\w+)\(",
        "self.{name} is a value: remove the parentheses",
    ),
    Remark(r"^'Parameters' object has no attribute '(?P<name>\w+)'", "", 'parameters.get("{name}") returns a value'),
    Remark(
        r"-: 'float' and 'Time'",
        r"time\.time\(\)\s*-\s*(?P<name>[\w.]+)",
        "a time of ROS is compared with the node's clock: write (self.clock.now() - {name}).seconds",
    ),
    Remark(
        f"-: 'Time' and '{_SECONDS}'",
        r"(?P<now>[\w.]+\(\))\s*-\s*(?P<name>[\w.]+)\.(seconds|sec|nanosec|nanoseconds)\b",
        "a difference of two times has the seconds: write ({now} - {name}).seconds",
    ),
    Remark(
        f"-: 'Time' and '{_SECONDS}'",
        r"-\s*(?P<name>self\.\w+)",
        "{name} is a number: initialize it by {name} = self.clock.now(), or write a time span as Duration.of({name})",
    ),
    Remark(
        f"'{_SPANS}' and '{_SECONDS}'|'{_SECONDS}' and '{_SPANS}'",
        "",
        "write a time span as Duration.of(seconds); its .seconds is a number",
    ),
    Remark(
        "^'Transform' object has no attribute '(transform|header|child_frame_id)'",
        "",
        "a lookup returns the transform itself: .translation, .rotation, .yaw; .to_msg() makes the message",
    ),
    Remark("^'Time' object has no attribute 'to_msg'", "", "leave it out: a Time can be put into a message"),
    Remark("Clock' object has no attribute 'create_rate'", "", "write async for n in self.clock.every(hz=10.0):"),
    Remark("Clock' object has no attribute '(time|get_time)'", "", "write self.clock.now()"),
    Remark(
        "'async for' requires .* got method",
        r"\bin self\.(?P<name>\w+):",
        "messages are read from a Subscription(Type, topic) in the body of the class, not from their handler; an async "
        "generator is called: self.{name}(...)",
    ),
    Remark(
        r"'async for' requires .* got (builtin_function_or_)?(method|function)",
        r"\bin (?P<call>[\w.]+):",
        "call it: {call}(...)",
    ),
    Remark(r"\basync_generator\b.* '?await", _AWAITED, "iterate over it: async for item in ....{name}(...)"),
    Remark(
        "^'(function|method)' object has no attribute",
        r"\b(?P<goal>\w+)\.result\.",
        "wait for it first: result = await {goal}.result()",
    ),
    Remark(
        "^'(function|method)' object has no attribute 'cancel'",
        r"self\.(?P<name>\w+)\.cancel\(",
        "a method has no handle; a timer that is cancelled is made in on_start: self.timer = "
        "self.create_timer(period, self.{name}), and then self.timer.cancel()",
    ),
    Remark(
        "^'numpy.ndarray' object has no attribute '(append|extend|insert)'",
        "",
        "arrays cannot grow: fill a list, then assign it: message.data = numbers",
    ),
    Remark(
        r"^ServedGoal\.feedback\(\) got an unexpected keyword argument '(?P<field>\w+)'",
        r"(?P<goal>\w+)\.feedback\(",
        "it takes a message: write {goal}.feedback(ACTION.Feedback({field}=...))",
    ),
    Remark("argument 'feedback_callback'", "", "read feedback with async for feedback in sent.feedback():"),
    Remark(
        r"^a coroutine was expected, got (?!<)",
        "",
        "spawn takes an `async def`; call a `def` itself, or await self.offload(it)",
    ),
    Remark(r"^Node\.spawn\(\) got an unexpected keyword", "", "pass arguments by position: self.spawn(self.work, 3)"),
    Remark(
        "^'(?P<kind>Publisher|Subscription|Client|ActionClient|Group|Transforms)' object has no attribute",
        r"(?P<name>\w+)\.(?!\w+\.)(?:publish|call|send|lookup|get|transform|released|wait_|[a-z_]+\()",
        "a {kind} is declared in the body of the class: {name} = {kind}(...)",
    ),
    Remark("^descriptor '__init__' of 'super'", "", "write super().__init__(...), with parentheses after super"),
    Remark("expected string or bytes-like", r"super\(\)\.__init__\(self", "leave out self: super().__init__()"),
    Remark("has no attribute 'node_name'", r"Node\.__init__\(", "write super().__init__(...)"),
    Remark("'<' not supported between", r"throttle=['\"]", "throttle= is in seconds, without quotes"),
    Remark(
        "^'Param' object has no attribute 'setter'",
        "",
        "@rate.check goes above a method that may refuse a value, @rate.on_change above one that follows it",
    ),
    Remark(
        r"Param\.(?P<name>check|on_change)\(\) missing 1 .* 'fn'",
        "",
        "write it without parentheses: @rate.{name}",
    ),
    Remark(
        r"^Qos\.__init__\(\) got an unexpected keyword argument '(?P<name>deadline|lifespan)'",
        "",
        "write {name}_ns=, in nanoseconds",
    ),
    Remark(
        r"^Qos\.__init__\(\) got an unexpected keyword",
        "",
        "it takes depth, reliability, durability, history, deadline_ns, lifespan_ns, liveliness and lease_ns",
    ),
    Remark(
        r"^object (?!coroutine)\w+ can't be used in 'await'|^'\w+' object can't be awaited",
        _AWAITED + r"\(",
        "{name} is not an `async def` and returns at once: remove await",
    ),
    Remark(
        r"^'(?!NoneType)[A-Z]\w*' object is not subscriptable",
        r"\b(?P<name>\w+)\[['\"](?P<field>\w+)['\"]\]",
        "the fields of a message are attributes: write {name}.{field}",
    ),
    Remark(r"for \^=?: '(float' and '(float|int)|int' and 'float)'", "", "a power is written with **"),
    Remark(
        r"'TimerInfo'( and |$)|'\w+' and 'TimerInfo'|not 'TimerInfo'|not TimerInfo$",
        "",
        "the argument of a timer's handler is a TimerInfo: leave it out, and take other values from self or a Param",
    ),
    Remark(
        r"unsupported operand .*'Param'",
        "",
        "a Param has its value on a node: compute with it in a method, as self.rate, or pass it on: @timer(hz=rate)",
    ),
)
_CALL = re.compile(r"(?:(?P<owner>\w+)\.)?(?P<name>\w+)\(\) (got an unexpected|missing \d|takes )")
_CLASSES = (
    TypeError,
    AttributeError,
    NameError,
    UnboundLocalError,
    RuntimeError,
    ValueError,
    IndexError,
    InvalidStateError,
)
_OURS = ("ServiceClient", "GoalClient", "TopicPublisher")


OF_VALUES = (
    Remark(
        r"\b(assignment destination|array) is read-only",
        "",
        "arrays of a message that was received cannot be written to: change a copy, as in message.data.copy()",
    ),
    Remark(
        "^The truth value of an array with more than one element is ambiguous",
        r"(?P<array>[A-Za-z_][\w.]*)\s*(?P<sign>[=!]=)\s*None",
        "that compares every element: write {array} is None, or is not None",
    ),
    Remark(
        "^operands could not be broadcast together",
        r"(?P<array>[A-Za-z_][\w.]*)\s*(?P<sign>[=!]=)\s*\[\s*\]",
        "that compares every element: write len({array}) {sign} 0",
    ),
    Remark(
        "^The truth value of an array with more than one element is ambiguous",
        r"(?P<array>[A-Za-z_][\w.]*)\s*(?P<sign><=?|>=?)\s*(?P<other>[\d.]+)",
        "that compares every element: write min({array}) {sign} {other}, max(...), or an element, {array}[0]",
    ),
    Remark(
        "^The truth value of an array with more than one element is ambiguous",
        r"^\s*(if|elif|while|return)\b.*[<>]",
        "that compares every element: take the min(...) of the array, its max(...), or one element, [0]",
    ),
    Remark(
        "^The truth value of an array with more than one element is ambiguous",
        "",
        "test for elements with len(...) > 0",
    ),
)
"""The table for ValueErrors, which rarely concern a node."""


def _of_kind(error: BaseException, line: str) -> str:
    """Return advice that the error's own class, or a message class in place of a message, calls for."""
    if isinstance(error, NameError) and (way := owner_of(error)):
        return way
    if isinstance(error, TypeError) and (way := text_for_number(error, line)):
        return way
    is_used = re.search(_COROUTINE, str(error)) and "context manager" not in str(error)
    if is_used and not _is_in_coroutine(error):
        return "that is a coroutine: in a thread write call_sync(...) for call(...); else write async def, and await"
    from graphflow.runtime.mistakes.errors.class_errors import class_in_place  # most programs never need them
    from graphflow.runtime.mistakes.errors.indices import advise_on_index
    from graphflow.runtime.mistakes.errors.unawaited_calls import line_without_await

    if is_used and (frames := _frames(error)) and (way := line_without_await(frames[-1], line)):
        return way
    return class_in_place(error) or advise_on_index(error, line, lambda path: _named(error, path))


def _named(error: BaseException, path: str) -> object:
    """Return the object that a dotted name refers to in the user's line that raised an error."""
    return named_in(frames[-1], path) if (frames := _frames(error)) else None


def _frames(error: BaseException) -> list[FrameType]:
    """Return the user's own frames of an error."""
    return [part.tb_frame for part in parts_of(error.__traceback__) if is_users(part.tb_frame.f_code.co_filename)]


def _is_in_coroutine(error: BaseException) -> bool:
    """Whether a user's `async def` raised an error."""
    frames = [part.tb_frame for part in parts_of(error.__traceback__)]
    return not frames or bool(frames[-1].f_code.co_flags & inspect.CO_COROUTINE)


def remark_on(error: BaseException) -> str:
    """Return advice on the line that raised an error; "" if there is none."""
    if isinstance(error, TimeoutError) and not str(error):
        return "a time limit has passed; catch TimeoutError around the block that has it"
    if isinstance(error, EOFError):
        from graphflow.runtime.mistakes.errors.no_terminal import advise_on_input  # as below

        return advise_on_input(error, ", and read with await self.offload(input)")
    if type(error) not in _CLASSES:
        return ""
    if hides := hidden(error):
        return hides
    text = str(error)
    file, _, number = place_in(error).rpartition(":")
    line = linecache.getline(file, int(number)) if number else ""
    if way := _of_kind(error, line):
        return way
    for row in OF_VALUES if isinstance(error, ValueError) else REMARKS:
        found = re.search(row.text, text)
        if found is None:
            continue
        pattern = row.line.replace("ATTRIBUTE", found.groupdict().get("attribute") or "")
        if written := re.search(pattern, line):
            return row.remark.format(**{**found.groupdict(), **written.groupdict()})
    call = _CALL.match(text)
    if call and call["owner"] in _OURS and call["name"] in EXAMPLES:
        return f"write {EXAMPLES[call['name']]}"
    return ""
