"""The parser of .msg, .srv and .action files.

Every broken rule is an `InterfaceError` with the line and the rule: students write these files by hand.

Source: ROS 2 interface definition article, "Field names", "Constants", "Default values".
"""

from __future__ import annotations

import re
from keyword import iskeyword

from graphflow.errors import InterfaceError
from graphflow.names import did_you_mean
from graphflow.wire.schema import (
    INTEGER_RANGES,
    PRIMITIVES,
    STRINGS,
    Action,
    Constant,
    Field,
    FieldType,
    Interface,
    Message,
    Service,
    Value,
    string_length,
)

KINDS = ("msg", "srv", "action")
"""Endings of the files, and the folders in which they lie."""
_TYPE = re.compile(r"(?P<base>[A-Za-z0-9_/]+)(?:<=(?P<bound>\d{1,18}))?(?:\[(?P<array><=\d{1,18}|\d{0,18})\])?\Z")
_FIELD_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*\Z")
_CONSTANT_NAME = re.compile(r"[A-Z](?:_?[A-Z0-9])*\Z")
_TYPE_NAME = re.compile(r"[A-Z][A-Za-z0-9]*\Z")
_PACKAGE_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*\Z")
_NEAR_SEPARATOR = re.compile(r"\s*[-_=\u2013\u2014]+\s*(#.*)?\Z")
"""A line that is probably meant to separate two sections."""
_STRING = re.compile(r"""(?P<q>["'])(?P<body>(?:\\.|(?!(?P=q))[^\\])*)(?P=q)\Z""")
_ALIASES = {"Header": "std_msgs/msg/Header"}
_ELSEWHERE = {"double": "float64", "float": "float32", "int": "int32", "uint": "uint32", "short": "int16"} | {
    "long": "int64",
    "boolean": "bool",
    "str": "string",
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
}
"""Types of C++, Python, Java and ROS 1, with their replacements."""
_SLIPS = (
    (re.compile(r"(?:vector|list|List|std::vector|sequence)[<\[]([\w/]+)[>\]]"), r"\1[]"),
    (re.compile(r"(string|wstring)[<(](\d+)[>)]?"), r"\1<=\2"),
    (re.compile(r"([\w/<=]+)\[(<?=?\d*)"), r"\1[\2]"),
    (re.compile(r"([\w/<=]+)\((\d*)\)"), r"\1[\2]"),
    (re.compile(r"([a-z]\w*)(?:\.msg)?\.([A-Z]\w*)(\[.*\])?"), r"\1/\2\3"),
    (re.compile(r"([a-z]\w*)::(?:msg::)?([A-Z]\w*)(\[.*\])?"), r"\1/\2\3"),
)
"""Common misspellings of types, with their corrections."""
_SEPARATOR = "---"
_COMMENTS = ("//", "/*")
"""Prefixes of comments in other languages."""


def is_type_name(text: str) -> bool:
    """Return whether an interface may have this name."""
    return _TYPE_NAME.match(text) is not None


def check_interface_name(package: str, name: str) -> None:
    """Check a package or type name by ROS 2's rules.

    Raises:
        InterfaceError: It breaks a rule, which the text gives.
    """
    if not _PACKAGE_NAME.match(package):
        raise InterfaceError(f"package {package!r}: lower-case letters, digits and single _, beginning with a letter")
    if not is_type_name(name):
        raise InterfaceError(f"type name {name!r}: letters and digits only, beginning with a capital (CamelCase)")


def parse(full_name: str, text: str) -> Interface:
    """Parse the definition of `package/msg/Name`, `package/srv/Name` or `package/action/Name`.

    Raises:
        InterfaceError: The first mistake, with its line in `text`.
    """
    package, kind, name = full_name.split("/")
    check_interface_name(package, name)
    sections = _sections(full_name, text, {"msg": 1, "srv": 2, "action": 3}[kind])
    if kind == "msg":
        return _message(full_name, package, sections[0])
    if kind == "srv":
        request, response = sections
        return Service(
            full_name,
            _message(f"{full_name}_Request", package, request),
            _message(f"{full_name}_Response", package, response),
        )
    goal, result, feedback = sections
    return Action(
        full_name,
        _message(f"{full_name}_Goal", package, goal),
        _message(f"{full_name}_Result", package, result),
        _message(f"{full_name}_Feedback", package, feedback),
    )


_Line = tuple[int, str]


def _sections(full_name: str, text: str, expected: int) -> list[list[_Line]]:
    sections: list[list[_Line]] = [[]]
    for number, line in enumerate(text.splitlines(), 1):
        if line.strip() == _SEPARATOR:
            sections.append([])
        else:
            bare = without_comment(line).strip()
            if bare:
                sections[-1].append((number, bare))
    if len(sections) != expected:
        for number, line in enumerate(text.splitlines(), 1):
            if _NEAR_SEPARATOR.match(line) and line.strip() != _SEPARATOR:
                raise InterfaceError(f"{full_name} line {number}: {line.strip()!r}: write {_SEPARATOR}")
        names = {1: "one message", 2: "request --- response", 3: "goal --- result --- feedback"}[expected]
        raise InterfaceError(f"{full_name}: expected {names}; lines with --- found: {len(sections) - 1}")
    return sections


def without_comment(line: str) -> str:
    """Strip the comment of a line; a `#` inside a string does not start one."""
    quote, escaped = "", False
    for i, c in enumerate(line):
        if escaped:
            escaped = False
        elif quote:
            escaped = c == "\\"
            if c == quote:
                quote = ""
        elif c in "\"'":
            quote = c
        elif c == "#":
            return line[:i]
    return line


def _message(name: str, package: str, lines: list[_Line]) -> Message:
    fields: list[Field] = []
    constants: list[Constant] = []
    seen: set[str] = set()
    for number, line in lines:
        try:
            member = _member(package, line)
            if member.name in seen:
                raise InterfaceError(f"{member.name!r} is defined twice")
        except InterfaceError as error:
            raise InterfaceError(f"{name} line {number}: {error}") from None
        seen.add(member.name)
        if isinstance(member, Field):
            fields.append(member)
        else:
            constants.append(member)
    return Message(name, tuple(fields), tuple(constants))


def _member(package: str, line: str) -> Field | Constant:
    if line.startswith(_COMMENTS):
        raise InterfaceError(f"{line!r}: a comment begins with #")
    type_text, *more = line.split(None, 1)
    if not more:
        raise InterfaceError(f"{line!r}: write TYPE NAME, perhaps with a default")
    rest = more[0]
    try:
        type_ = parse_type(type_text, package)
    except InterfaceError as error:
        if "did you mean" in str(error) or not (turned := _turned(type_text, rest, package)):
            raise
        raise InterfaceError(f"{type_text!r} is not a type; the type comes first: {turned}") from None
    constant = re.match(r"(\w+)\s*=(?!=)\s*(.*)\Z", rest)
    if constant:
        return _constant(type_, constant.group(1), constant.group(2))
    _check_order(line, type_text, rest)
    name, *more = rest.split(None, 1)
    if more and more[0].startswith(_COMMENTS) and type_.base not in STRINGS:
        raise InterfaceError(f"{more[0]!r}: a comment begins with #")
    if name.endswith(";") and _FIELD_NAME.match(name[:-1]):
        raise InterfaceError(f"{line!r}: leave out the semicolon")
    if "/" in name and (turned := _turned(type_text.lower(), rest, package)):
        raise InterfaceError(f"field name {name!r}: the type comes first: {turned}")
    _check_field_name(name)
    return Field(name, type_, _literal(type_, more[0]) if more else None)


def _check_order(line: str, type_text: str, rest: str) -> None:
    """Refuse brackets behind a name, as in C, and a constant without its sign."""
    space = "" if type_text.endswith("]") else r"\s*"  # after an array, a list with a space before it is the default
    misplaced = re.match(rf"(\w+){space}(\[\s*(?:<=)?\d*\s*\])", rest)
    if misplaced is not None and not type_text.startswith(tuple(STRINGS)):
        of_one, brackets = type_text.partition("[")[0], misplaced[2].replace(" ", "")
        raise InterfaceError(f"{line!r}: the brackets belong to the type: {of_one}{brackets} {misplaced[1]}")
    if (value := re.fullmatch(r"([A-Z][A-Z0-9_]*)\s+(-?[\d.]+);?\s*(?:#.*)?", rest)) is not None:
        raise InterfaceError(f"{line!r}: a constant has a =: {type_text} {value[1]}={value[2]}")


def _check_field_name(name: str) -> None:
    if not _FIELD_NAME.match(name):
        rule = "lower-case letters, digits and single _, beginning with a letter, not ending with _"
        near = re.sub(r"_+", "_", re.sub(r"(?<=[a-z\d])(?=[A-Z])|-", "_", name).lower()).strip("_")
        hint = f"; did you mean {near!r}?" if _FIELD_NAME.match(near) else ""
        raise InterfaceError(f"field name {name!r}: {rule}{hint}")
    if iskeyword(name):
        raise InterfaceError(f"field name {name!r}: it is a Python keyword, so no attribute can have that name")


def _turned(name: str, rest: str, package: str) -> str:
    """Return a field that was written name first in the right order; empty if that is not the mistake."""
    name, type_text = name.rstrip(":"), rest.split()[0].rstrip(",;")
    try:
        parse_type(type_text, package)
    except InterfaceError:
        return ""
    return f"{type_text} {name}" if _FIELD_NAME.match(name) else ""


def parse_type(text: str, package: str) -> FieldType:
    """Parse a type such as `float64[3]`, `string<=8`, `Point` or `geometry_msgs/Point[]`; bare names are of `package`.

    Raises:
        InterfaceError: `text` is none of these.
    """
    m = _TYPE.match(text)
    if not m:
        meant = next((right for slip, with_ in _SLIPS if (right := _put_right(slip, with_, text))), "")
        way = f"write {meant}" if meant else "write for example float64, string<=8, Point or float64[<=3]"
        raise InterfaceError(f"{text!r} is not a type; {way}")
    base, bound = m["base"], m["bound"]
    if base not in PRIMITIVES:
        base = _type_name(base, package)
    if bound is not None and base not in STRINGS:
        raise InterfaceError(f"{text!r}: only string and wstring take <=N; an array's bound goes inside its brackets")
    if bound is not None and int(bound) == 0:
        raise InterfaceError(f"{text!r}: a string needs a bound of at least 1")
    array = m["array"]
    if array is None:
        return FieldType(base, int(bound or 0))
    if array == "":
        return FieldType(base, int(bound or 0), "unbounded")
    if array.startswith("<="):
        return FieldType(base, int(bound or 0), "bounded", _size(array[2:], text))
    return FieldType(base, int(bound or 0), "fixed", _size(array, text))


def _put_right(slip: re.Pattern[str], with_: str, text: str) -> str:
    """Return the correction of a misspelt type; empty if there is none."""
    found = slip.fullmatch(text)
    meant = found.expand(with_) if found is not None else ""
    return meant if _TYPE.match(meant) else ""


def _size(digits: str, text: str) -> int:
    size = int(digits)
    if size == 0:
        raise InterfaceError(f"{text!r}: an array needs at least 1 element")
    return size


def _type_name(text: str, package: str) -> str:
    parts = text.split("/")
    if len(parts) == 1:
        if text in _ALIASES:
            return _ALIASES[text]
        if not is_type_name(text):
            near = f"; did you mean {_ELSEWHERE[text]!r}?" if text in _ELSEWHERE else did_you_mean(text, PRIMITIVES)
            raise InterfaceError(f"{text!r} is not a type{near}")
        return f"{package}/msg/{text}"
    if len(parts) == 2 or (len(parts) == 3 and parts[1] == "msg"):
        check_interface_name(parts[0], parts[-1])
        return f"{parts[0]}/msg/{parts[-1]}"
    raise InterfaceError(f"{text!r} is not a type; write package/Name")


def _constant(type_: FieldType, name: str, text: str) -> Constant:
    if type_.array or not type_.is_primitive or type_.base == "wstring":
        default = f"; a default has no =: {type_} {name} {text}" if _FIELD_NAME.match(name) else ""
        raise InterfaceError(f"constant {name!r}: only numbers, bool and string can be constants, not {type_}{default}")
    if not _CONSTANT_NAME.match(name):
        text = text.rstrip(" ;")
        ways = f"; a constant: {type_} {name.upper()}={text}; a default of a field: {type_} {name} {text}"
        is_field = text and _FIELD_NAME.match(name)
        raise InterfaceError(f"constant name {name!r}: capitals, digits and single _ only{ways if is_field else ''}")
    if type_.base == "string" and not _STRING.match(text):
        return Constant(name, "string", text.strip())
    value = _literal(type_, text)
    assert not isinstance(value, list)
    return Constant(name, type_.base, value)


def _literal(type_: FieldType, text: str) -> Value:
    if not type_.is_primitive:
        raise InterfaceError(f"{text!r}: only primitive types have defaults, not {type_}")
    if not type_.array:
        return _scalar(type_, text)
    if not (text.startswith("[") and text.endswith("]")):
        raise InterfaceError(f"default {text!r}: an array's default is written [a, b, c]")
    items: list[Value] = [_scalar(type_, item) for item in _split_items(text[1:-1])]
    if type_.array == "fixed" and len(items) != type_.size:
        raise InterfaceError(f"default {text!r}: {type_} takes {type_.size} values, not {len(items)}")
    if type_.array == "bounded" and len(items) > type_.size:
        raise InterfaceError(f"default {text!r}: {type_} takes at most {type_.size} values, not {len(items)}")
    return items


def _split_items(text: str) -> list[str]:
    return [
        item.strip() for item in re.findall(r"""(?:"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,])+""", text) if item.strip()
    ]


def _scalar(type_: FieldType, text: str) -> Value:
    base = type_.base
    if base in STRINGS:
        m = _STRING.match(text)
        value = re.sub(r"\\(.)", r"\1", m["body"]) if m else text
        if type_.string_bound and string_length(base, value) > type_.string_bound:
            raise InterfaceError(f"{text!r} is longer than {type_}")
        return value
    try:
        if base == "bool":
            return {"true": True, "1": True, "false": False, "0": False}[text.lower()]
        if base in INTEGER_RANGES:
            low, high = INTEGER_RANGES[base]
            number = int(text, 0)
            if not low <= number <= high:
                raise InterfaceError(f"{text} does not fit {base}: {low} to {high}")
            return number
        return float(text)
    except (KeyError, ValueError) as error:
        if isinstance(error, InterfaceError):
            raise
        raise InterfaceError(f"{text!r} is not a value of {base}") from None
