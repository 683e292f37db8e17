"""Reading .msg, .srv and .action text."""

from __future__ import annotations

import pytest

from graphflow.errors import InterfaceError
from graphflow.wire import idl
from graphflow.wire.schema import Action, Constant, Field, FieldType, Message, Service, Value


def message(text: str) -> Message:
    found = idl.parse("pkg/msg/Thing", text)
    assert isinstance(found, Message)
    return found


def default(line: str) -> Value | None:
    return message(line).fields[0].default


def constant(line: str) -> Constant:
    return message(line).constants[0]


def test_a_message_is_its_fields_in_order() -> None:
    """Fields keep their order, bare names are of the same package, constants stand apart."""
    assert message("float64 x\nPoint[] path\nint32 LIMIT=3\nother_pkg/Name n\n") == Message(
        "pkg/msg/Thing",
        (
            Field("x", FieldType("float64")),
            Field("path", FieldType("pkg/msg/Point", 0, "unbounded")),
            Field("n", FieldType("other_pkg/msg/Name")),
        ),
        (Constant("LIMIT", "int32", 3),),
    )


@pytest.mark.parametrize("text", ["", "\n\n", "# nothing\n   # at all\n"])
def test_a_message_can_be_empty(text: str) -> None:
    """A definition without fields is a message without fields."""
    assert message(text) == Message("pkg/msg/Thing")


@pytest.mark.parametrize(
    "line", ["float64\tx", "float64 \t x  ", "\tfloat64 x\t# metres", "float64 x#metres", "float64 x\r"]
)
def test_white_space_and_comments_are_free(line: str) -> None:
    """Tabs, spaces, comments and Windows line ends change nothing."""
    assert message(line).fields == (Field("x", FieldType("float64")),)


def test_a_service_has_two_sections() -> None:
    """The request is above the dashes, the response below; either may be empty."""
    assert idl.parse("pkg/srv/Get", "---\nbool ok") == Service(
        "pkg/srv/Get",
        Message("pkg/srv/Get_Request"),
        Message("pkg/srv/Get_Response", (Field("ok", FieldType("bool")),)),
    )


def test_an_action_has_three_sections() -> None:
    """Goal, result and feedback come in this order."""
    found = idl.parse("pkg/action/Go", "int8 a\n---\nint16 b\n---\nint32 c\n")
    assert isinstance(found, Action)
    parts = [(m.name, str(m.fields[0].type)) for m in (found.goal, found.result, found.feedback)]
    assert parts == [
        ("pkg/action/Go_Goal", "int8"),
        ("pkg/action/Go_Result", "int16"),
        ("pkg/action/Go_Feedback", "int32"),
    ]


def test_sections_may_repeat_names() -> None:
    """Request and response are different messages, so a name may stand in both."""
    found = idl.parse("pkg/srv/Echo", "int8 a\n---\nint8 a")
    assert isinstance(found, Service)
    assert found.request.fields == found.response.fields


def test_header_is_an_alias() -> None:
    """`Header` alone is the one of std_msgs."""
    assert message("Header header").fields[0].type.base == "std_msgs/msg/Header"


@pytest.mark.parametrize("text", ["other/Name", "other/msg/Name"])
def test_a_type_of_another_package_has_two_spellings(text: str) -> None:
    """`package/Name` and `package/msg/Name` are the same type."""
    assert idl.parse_type(text, "pkg") == FieldType("other/msg/Name")


@pytest.mark.parametrize(
    ("line", "value"),
    [
        ("int32 x 5", 5),
        ("int32 x -5", -5),
        ("uint8 x 0xff", 255),
        ("bool x true", True),
        ("bool x False", False),
        ("bool x 1", True),
        ("float64 x 1", 1.0),
        ("float32 x -1.5e3", -1500.0),
        ("string s plain words # and a comment", "plain words"),
        ('string s "a # b"  # comment with "quotes"', "a # b"),
        ("string s 'a # b'  # it's a comment", "a # b"),
        (r'string s "say \"hi\" # now"', 'say "hi" # now'),
        (r'string s "one \" # in" # out', 'one " # in'),
        (r"string s 'it\'s'", "it's"),
        ('string s "it\'s"', "it's"),
        (r'string s "ends in a backslash \\" # it\'s', "ends in a backslash \\"),
        ('string s ""', ""),
        ('string s "a=b"', "a=b"),
        ('wstring w "ハロー"', "ハロー"),
        ("string<=3 s abc", "abc"),
        ("wstring<=1 s €", "€"),
        ("int32[] a [1, 2, 3]", [1, 2, 3]),
        ("int32[3] a [1,2,3]", [1, 2, 3]),
        ("int32[<=3] a []", []),
        ("bool[2] a [true, 0]", [True, False]),
        ("float64[2] a [1, -2.5]", [1.0, -2.5]),
        ("string[] a [\"x, y\", 'z', w]", ["x, y", "z", "w"]),
        ('string[] a ["", "#"] # two', ["", "#"]),
        (r'string[2] a ["q\"q", "back\\"]', ['q"q', "back\\"]),
        ("uint64[2] a [0, 18446744073709551615]", [0, 2**64 - 1]),
    ],
)
def test_defaults_are_read(line: str, value: Value) -> None:
    """A default is of the field's type; quotes protect commas and hashes."""
    found = default(line)
    assert found == value
    assert type(found) is type(value)


def test_a_field_without_a_default_has_none() -> None:
    """No default is not the same as a zero."""
    assert default("int32 x") is None


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("int32 X=1", Constant("X", "int32", 1)),
        ("int32 X = 1", Constant("X", "int32", 1)),
        ("uint8 A_2B=0x10 # sixteen", Constant("A_2B", "uint8", 16)),
        ("bool ON=true", Constant("ON", "bool", True)),
        ("float64 PI=3.14", Constant("PI", "float64", 3.14)),
        ("byte B=255", Constant("B", "byte", 255)),
        ("string S=hello world", Constant("S", "string", "hello world")),
        ('string S="a = b # c"', Constant("S", "string", "a = b # c")),
        ("string S='x'  # it's x", Constant("S", "string", "x")),
        ("string S=", Constant("S", "string", "")),
    ],
)
def test_constants_are_read(line: str, expected: Constant) -> None:
    """A constant is a name in capitals with a value of its type."""
    found = constant(line)
    assert found == expected
    assert type(found.value) is type(expected.value)


BROKEN = [
    ("geometry_msgs/Point position // where", r"'// where': a comment begins with #$"),
    ("float64 x /* metres */", r"a comment begins with #$"),
    ("// where to go", r"'// where to go': a comment begins with #$"),
    ("float32 ranges[]", r"'float32 ranges\[\]': the brackets belong to the type: float32\[\] ranges$"),
    ("int32[] list[3]", r": the brackets belong to the type: int32\[3\] list$"),
    ("float32 ranges [ 3 ]", r": the brackets belong to the type: float32\[3\] ranges$"),
    ("int32 MAX 5", r"'int32 MAX 5': a constant has a =: int32 MAX=5$"),
    ("int32 percent = 5;", r"; a constant: int32 PERCENT=5; a default of a field: int32 percent 5$"),
    ("float64 x;", r"'float64 x;': leave out the semicolon$"),
    ("position geometry_msgs/Point", r"'position' is not a type; the type comes first: geometry_msgs/Point position$"),
    ("x: float64[]", r"the type comes first: float64\[\] x$"),
    ("Goal geometry_msgs/Point", r"the type comes first: geometry_msgs/Point goal$"),
    ("float64", "TYPE NAME"),
    ("flaot64 x", r"not a type; did you mean 'float64'"),
    ("double x", r"'double' is not a type; did you mean 'float64'\?$"),
    ("int[] x", r"'int' is not a type; did you mean 'int32'\?$"),
    ("point p", "'point' is not a type"),
    ("float64[3 x", "is not a type; write float64"),
    ("float64[-1] x", "is not a type"),
    ("float64[0] x", "at least 1 element"),
    ("float64[<=0] x", "at least 1 element"),
    ("string<=0 x", "at least 1"),
    ("int32<=5 x", "only string and wstring take <=N"),
    ("a/b/c/D x", "write package/Name"),
    ("a/srv/D x", "write package/Name"),
    ("Geometry/Point x", "package 'Geometry'"),
    ("geometry_msgs/point x", "type name 'point'"),
    ("/Point x", "package ''"),
    ("float64 X", "field name 'X'"),
    ("float64 2x", "field name '2x'"),
    ("float64 _x", "field name '_x'"),
    ("float64 x_", "field name 'x_'.*not ending with _"),
    ("float64 x__y", "field name 'x__y'"),
    ("float64 x-y", "field name 'x-y'"),
    ("float64 from", "Python keyword"),
    ("float64 x\nint32 y\nbool x", "'x' is defined twice"),
    ("int32 X=1\nint32 X=1", "'X' is defined twice"),
    ("int32 x = 1", "constant name 'x': .*; a constant: int32 X=1; a default of a field: int32 x 1$"),
    ("int32 x=", "constant name 'x': capitals, digits and single _ only$"),
    ("int32 X_=1", "constant name 'X_'"),
    ("int32 X=", "'' is not a value of int32"),
    ("int32 X=one", "'one' is not a value of int32"),
    ("int32 X=1.5", "'1.5' is not a value of int32"),
    ("int8 X=128", "128 does not fit int8: -128 to 127"),
    ("uint8 X=-1", "-1 does not fit uint8: 0 to 255"),
    ("float64 X=far", "'far' is not a value of float64"),
    ("bool X=maybe", "'maybe' is not a value of bool"),
    ("int32[] X=[1]", "constant 'X': only numbers, bool and string"),
    ("string[] n = ['a']", r"can be constants, not string\[\]; a default has no =: string\[\] n \['a'\]"),
    ("wstring X=a", "constant 'X': only numbers, bool and string"),
    ("Point X=1", "constant 'X': only numbers, bool and string"),
    ("uint16 x 65536", "65536 does not fit uint16"),
    ("int64 x 9223372036854775808", "does not fit int64"),
    ("Point p 5", "only primitive types have defaults"),
    ("Point[] p [5]", "only primitive types have defaults"),
    ("int32[2] a 5", r"written \[a, b, c\]"),
    ("int32[2] a [1]", "takes 2 values, not 1"),
    ("int32[<=2] a [1,2,3]", "at most 2 values, not 3"),
    ("int32[] a [1,x]", "'x' is not a value of int32"),
    ("string<=3 s abcd", "longer than string<=3"),
    ("string<=3 s hé€", "longer than string<=3"),
    ('string<=3 s "abcd"', "longer than string<=3"),
    ("wstring<=1 s \N{TURTLE}", "longer than wstring<=1"),
    ("string<=1[] a [a, bc]", "longer than"),
]


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("float32[3", "write float32[3]"),
        ("string<20>", "write string<=20"),
        ("string[20", "write string[20]"),
        ("vector<int32>", "write int32[]"),
        ("List[float64]", "write float64[]"),
        ("geometry_msgs.Point", "write geometry_msgs/Point"),
        ("geometry_msgs.msg.Point[]", "write geometry_msgs/Point[]"),
        ("geometry_msgs::msg::Point", "write geometry_msgs/Point"),
        ("time", "did you mean 'builtin_interfaces/Time'?"),
        ("duration", "did you mean 'builtin_interfaces/Duration'?"),
        ("a?", "write for example float64, string<=8, Point or float64[<=3]"),
    ],
)
def test_types_of_other_languages(text: str, meant: str) -> None:
    """Are told with how they are written."""
    with pytest.raises(InterfaceError) as caught:
        idl.parse_type(text, "pkg")
    assert str(caught.value) == f"{text!r} is not a type; {meant}"


def test_names_of_fields_in_another_style() -> None:
    """The name that would do is offered."""
    for name, near in (("goalX", "goal_x"), ("Goal-y", "goal_y"), ("x__1", "x_1")):
        with pytest.raises(InterfaceError, match=rf"; did you mean '{near}'\?$"):
            message(f"int32 {name}")


@pytest.mark.parametrize(("text", "rule"), BROKEN)
def test_a_broken_rule_is_named_with_its_line(text: str, rule: str) -> None:
    """Every rule broken is an InterfaceError with the definition, the line and the rule."""
    line = 2 + len(text.splitlines())
    with pytest.raises(InterfaceError, match=rf"^pkg/msg/Thing line {line}: .*{rule}"):
        message(f"# a comment\n\n{text}")


@pytest.mark.parametrize("line", ["--", "----", "- - -".replace(" ", "\u2014"), "===", "--- # a comment"])
def test_a_line_that_parts_nothing(line: str) -> None:
    """Is named where sections are missing."""
    with pytest.raises(InterfaceError, match=rf"^pkg/srv/Get line 2: '{line}': write ---$"):
        idl.parse("pkg/srv/Get", f"int32 x\n{line}\nint32 y\n")


def test_lines_are_counted_through_the_sections() -> None:
    """In a service the line is that of the file, and the part is named."""
    with pytest.raises(InterfaceError, match=r"^pkg/srv/Get_Response line 4: 'flat64' is not a type"):
        idl.parse("pkg/srv/Get", "int8 a\n\n---\nflat64 x")


@pytest.mark.parametrize(
    ("name", "text", "found"),
    [
        ("pkg/srv/Get", "int8 a", 0),
        ("pkg/srv/Get", "---\n---", 2),
        ("pkg/action/Go", "---", 1),
        ("pkg/msg/Thing", "int8 a\n---\nint8 b", 1),
    ],
)
def test_the_number_of_sections_is_checked(name: str, text: str, found: int) -> None:
    """Too few or too many lines of dashes are refused, with the number found."""
    with pytest.raises(InterfaceError, match=rf"{name}: expected .* found: {found}$"):
        idl.parse(name, text)


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("Pkg/msg/Thing", "package 'Pkg'"),
        ("pkg_/msg/Thing", "package 'pkg_'"),
        ("p__kg/msg/Thing", "package 'p__kg'"),
        ("1pkg/msg/Thing", "package '1pkg'"),
        ("pkg/msg/thing", "type name 'thing'"),
        ("pkg/msg/My_Thing", "type name 'My_Thing'"),
        ("pkg/msg/2Thing", "type name '2Thing'"),
    ],
)
def test_the_interfaces_own_name_is_checked(name: str, rule: str) -> None:
    """A file or folder with a name that ROS 2 refuses is refused, with the rule."""
    with pytest.raises(InterfaceError, match=rule):
        idl.parse(name, "")


@pytest.mark.parametrize("text", ["float64 " + "a" * 200 + "B", "int32 " + "A" * 200 + "b=1"])
def test_long_names_are_judged_at_once(text: str) -> None:
    """A long name with a fault at its end takes no longer than a good one."""
    with pytest.raises(InterfaceError, match=r"name '.*': .*single _"):
        message(text)


def test_quotes_that_never_close_are_characters() -> None:
    """A quote without its partner is part of the text, however many backslashes follow it."""
    text = '"' + "\\" * 201
    assert default(f"string s {text}") == text
    assert default(f"string[] s [{text}]") == [text]


def test_the_first_fault_is_reported() -> None:
    """Of several faults the one furthest up is told."""
    with pytest.raises(InterfaceError, match="line 1"):
        message("flat x\nfloat64 X")
