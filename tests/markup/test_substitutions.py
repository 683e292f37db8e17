"""`$(...)` in texts: what each stands for, nested, typed, and what is wrong with the others."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import graphflow
from graphflow.markup.substitutions import MAX_DEPTH, Outside, SubstitutionError, Substitutions, Written, truth
from tests.cases import count, slow

ARGS: dict[str, Any] = {
    "name": "turtle2",
    "gain": 2.5,
    "count": 3,
    "on": True,
    "list": [1, 2],
    "none": None,
    "which": "name",
    "dollar": "$(var name)",
}
ENV = {"USER": "ada", "EMPTY": "", "ARG": "gain", "TWO": "a b", "PARENTHESIS": ")"}


def apply(value: Any) -> Any:
    outside = Outside(ENV, Path("/home/ada"), Path("/home/ada/logs/lab/latest"))
    return Substitutions(ARGS, Path("/home/ada/graphs/lab.yaml"), outside, {"rate": 2.5}).apply(value)


@pytest.mark.parametrize(
    "value", ["plain", "", "$HOME", "${HOME}", "$ (var x)", "(var x)", 3, 2.5, True, None, ["$(x)"]]
)
def test_what_has_no_substitution_stays(value: Any) -> None:
    """Other values, and other uses of a dollar, are left alone."""
    assert apply(value) is value


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("$(var name)", "turtle2"),
        ("$(  var   name  )", "turtle2"),
        ("/$(var name)/chaser", "/turtle2/chaser"),
        ("$(var name)$(var name)", "turtle2turtle2"),
        ("$(env USER)", "ada"),
        ("$(env USER grace)", "ada"),
        ("$(env NOBODY grace)", "grace"),
        ("$(env NOBODY two words)", "two words"),
        ("$(env EMPTY full)", ""),
        ("$(dirname)", "/home/ada/graphs"),
        ("$(dirname)/../maps", "/home/ada/graphs/../maps"),
        ("$(filename)", "/home/ada/graphs/lab.yaml"),
        ("$(log_dir)/map.pgm", "/home/ada/logs/lab/latest/map.pgm"),
        ("$(launch_log_dir)", "/home/ada/logs/lab/latest"),
        ("$(param rate)", 2.5),
        ("$(param rat 3)", 3),
        ("$(find-pkg-prefix numpy)", sys.prefix),
        ("$(exec-in-pkg gf graphflow)", f"{sys.prefix}/bin/gf"),
        ("$(if $(var on) a 'b c')", "a"),
        ("$(if false a 'b c')", "b c"),
        ("x$(if 0 a)", "x"),
        ("$(command 'xacro $(var name).urdf' warn)", "$(command 'xacro turtle2.urdf' warn)"),
        ("$(var $(var which))", "turtle2"),
        ("$(var name leo)", "turtle2"),
        ("$(var nobody leo)", "leo"),
        ("$(var nobody 2.5)", 2.5),
        ("$(var nobody '2.5')", "2.5"),
        ("$(var nobody 'a b')", "a b"),
        ("$(var nobody $(var name))s", "turtle2s"),
        ("$(var $(env ARG))", 2.5),
        ("$(env NOBODY $(var name))", "turtle2"),
        ("$(env NOBODY a$(var $(var which))b)", "aturtle2b"),
        ("$(env NOBODY (round))", "(round)"),
        ("$(env PARENTHESIS)", ")"),
        ("$(var 'name')", "turtle2"),
        ('$(var "gain")', 2.5),
        ("$(env 'USER')", "ada"),
        ("$(env 'NOBODY' '')", ""),
        (r"$(env NOBODY 'it\'s')", "it's"),
        ("$(env NOBODY ')')", ")"),
        (r"$(env NOBODY \)\ \()", ") ("),
        ("$(optenv 'USER')", "ada"),
        pytest.param("$(anon 'a')", apply("$(anon a)"), id="anon"),
        ("$(equals $(env TWO) 'a b')", True),
        ("$(equals '$(env TWO)' \"a b\")", True),
        ("$(if $(equals '$(var name)' 'turtle2') '$(env TWO)' c)", "a b"),
        ("$(eval '2 * count')", 6),
        ("$(eval \"'$(var name)' == 'turtle2'\")", True),
        ("$(eval '$(var name)' == 'turtle2')", True),
        ("$(eval name == 'turtle2' or count > 3)", True),
        ("$(if on a) $(not off)", "a true"),
        ("$(all) $(any)", "true false"),
        ("$(equals true 1) $(equals True true) $(equals 1 10)", "true true false"),
        ("$(equals 10 10.0) $(equals nan nan) $(equals 10 10.1)", "true false false"),
        ("$(not-equals wow 1) $(not-equals '' '')", "true false"),
        ("$(eval ceil(1.3) + math.floor(math.pi))", 5),
        ("$(as float $(var count))", 3.0),
        ("$(as str $(var gain))", "2.5"),
        ("$(as yaml \"['$(var name)a', '$(var name)b']\")", ["turtle2a", "turtle2b"]),
        ("$(as yaml 1$(var count))", 13),
        ("$(as float $(command 'cat x'))", "$(as float $(command 'cat x'))"),
        (r"a \$(var name) $(var name)", "a $(var name) turtle2"),
        (r"C:\dir\$(var count)", r"C:\dir$(var count)"),
        (r"C:\dir\x $(var count)", r"C:\dir\x 3"),
    ],
)
def test_substitutions(text: str, value: Any) -> None:
    """Variables, environment with default, folders, and all of them within each other."""
    assert apply(text) == value


def test_find_pkg_share_is_the_folder_of_an_installed_package() -> None:
    """A Python package's folder stands in for ROS's share folder."""
    assert apply("$(find-pkg-share graphflow)/x") == f"{graphflow.__path__[0]}/x"


@pytest.mark.parametrize("name", ["gain", "count", "on", "list", "none", "dollar"])
def test_a_whole_text_takes_the_type(name: str) -> None:
    """A text that is one substitution becomes the argument's value itself."""
    assert apply(f"$(var {name})") is ARGS[name]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a $(var gain)", "a 2.5"),
        ("$(var count) ", "3 "),
        ("v$(var on)", "vtrue"),
        ("$(var none)!", "!"),
    ],
)
def test_within_a_text_it_is_text(text: str, value: str) -> None:
    """Beside other characters a value is written out, as YAML would write it."""
    assert apply(text) == value


def test_values_are_not_read_again() -> None:
    """What a substitution gives is not searched for substitutions, so that no input can become one."""
    assert apply("x$(var dollar)") == "x$(var name)"


def test_the_process_environment_is_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without an environment given, the process's own is used."""
    monkeypatch.setenv("GRAPHFLOW_TEST_WORD", "here")
    assert Substitutions({}, Path("/"), Outside()).apply("$(env GRAPHFLOW_TEST_WORD)") == "here"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("$(var nme)", "there is no argument 'nme'; did you mean 'name'?"),
        ("$(var)", "write $(var NAME), or $(var NAME DEFAULT)"),
        ("$(env)", "write $(env NAME) or $(env NAME default)"),
        ("$(env NOBODY)", "the environment variable NOBODY is not set; give a default: $(env NAME default)"),
        ("$(dirname x)", "write $(dirname)"),
        ("$(param)", "write $(param NAME DEFAULT)"),
        ("$(param rat)", "no group around this gives a parameter 'rat' to its nodes; did you mean 'rate'?"),
        ("$(as float $(var name))", "$(as float ...): expected a number, got 'turtle2'"),
        ("$(as flot 1)", "there is no type 'flot'; did you mean 'float'?"),
        ("$(if true)", "write $(if CONDITION A B)"),
        ("$(if maybe a b)", "expected true or false, got 'maybe'"),
        ("$(all on 2)", "expected true or false, got '2'"),
        ("$(any true maybe)", "expected"),
        ("$(or true maybe)", "expected"),
        ("$(and false maybe)", "expected"),
        ("$(any 'true)", "is not closed, or no space follows it"),
        ("$(env 'HO'ME)", """the quote in "'HO'ME" is not closed, or no space follows it"""),
        ("$(find-pkg-prefix nowhere_to_be)", "no package of that name is installed"),
        ("$(exec-in-pkg gf)", "write $(exec-in-pkg EXECUTABLE PACKAGE)"),
        ("$(exec-in-pkg gf nowhere_to_be)", "no package of that name is installed"),
        (
            "$(exec-in-pkg talker graphflow)",
            "there is no such program in the package; for a node write pkg:",
        ),
        ("$(command)", "write $(command 'PROGRAM ...')"),
        ("$(command 'xacro)", "is not closed, or no space follows it"),
        ("$(command ' ')", "write $(command 'PROGRAM ...')"),
        ("$(find-pkg-share)", "write $(find-pkg-share PACKAGE)"),
        ("$(find-pkg-share nowhere_to_be)", "no package of that name is installed"),
        ("$(find-pkg-share ../x)", "no package of that name is installed"),
        ("$(find-pkg-share __main__)", "no package of that name is installed"),
        ("$(name)", "$(name): unknown substitution 'name'; write $(var name)"),
        ("$(vra name)", "$(vra name): unknown substitution 'vra'; did you mean 'var'?"),
        ("$(arg name)", "$(arg name): unknown substitution 'arg' of ROS 1's; write $(var name)"),
        ("$(find-pkg-shar x)", "unknown substitution 'find-pkg-shar'; did you mean 'find-pkg-share'?"),
        ("$()", "unknown substitution ''"),
        ("a $(var name", "'$(var name' has no closing )"),
        ("$(env NOBODY $(var name)", "has no closing )"),
    ],
)
def test_what_cannot_be_substituted(text: str, message: str) -> None:
    """Every mistake says what is known, or how it is written."""
    with pytest.raises(SubstitutionError) as caught:
        apply(text)
    assert message in str(caught.value)


def test_no_argument_to_be_near_to() -> None:
    """In a file without arguments, the way out is to declare one."""
    with pytest.raises(SubstitutionError, match="there is no argument 'x'; declare it, under args: or by"):
        Substitutions({}, Path("/"), Outside({})).apply("$(var x)")


@slow
def test_nesting_has_an_end() -> None:
    """A text nested without measure is refused, not a crash."""
    depth = MAX_DEPTH - 1
    assert apply("$(env NOBODY " * depth + "x" + ")" * depth) == "x"
    with pytest.raises(SubstitutionError, match=f"nested more than {MAX_DEPTH} deep"):
        apply("$(env NOBODY " * 3000 + "x" + ")" * 3000)


@settings(derandomize=True, max_examples=count(few=75, full=300), deadline=None)
@given(
    st.lists(st.sampled_from(["$(", "$", "(", ")", "var ", "env ", "name", "USER", "dirname", " ", "x"]), max_size=12)
)
def test_any_text_is_substituted_or_refused(words: list[str]) -> None:
    """No text leads to another error than a SubstitutionError."""
    try:
        apply("".join(words))
    except SubstitutionError:
        pass


@pytest.mark.parametrize(("words", "word"), [("1 true", "true"), ("true 0", "false"), ("$(var on)", "true")])
def test_all(words: str, word: str) -> None:
    """Every one of them, as many as there are."""
    assert apply(f"is $(all {words})") == f"is {word}"
    assert apply(f"is $(any {words} false)") == "is true"
    assert apply("$(any false 0)") is False


def test_a_copy_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its substitutions have been made, but for those in comments, and its lines stay; one without any is itself."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    file = tmp_path / "p.yaml"
    file.write_text("# of $(var nobody)\na:\n  rate: $(var gain)\n  who: '$(env USER)'\n")
    copies = [
        str(Substitutions(ARGS, tmp_path / "lab.yaml", Outside(ENV)).apply("$(substituted p.yaml)")) for _ in range(2)
    ]
    assert copies[0] == copies[1]
    assert Path(copies[0]).name == "p.yaml"
    assert Path(copies[0]).read_text() == "\na:\n  rate: 2.5\n  who: 'ada'\n"
    file.write_text("a: 1\n")
    assert apply(f"$(substituted {file})") == str(file)


@pytest.mark.parametrize("word", ["file-content", "substituted"])
def test_files_of_other_kinds(word: str, tmp_path: Path) -> None:
    """A FIFO without a writer keeps nobody waiting."""
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(SubstitutionError, match="it is not a regular file"):
        apply(f"$({word} {tmp_path / 'fifo'})")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("a: $(var nobody)", "there is no argument 'nobody'"),
        ("a: $(substituted p.yaml)", "the file has a substitution of this kind itself"),
        (None, "No such file"),
    ],
)
def test_a_file_that_cannot_be_copied(tmp_path: Path, content: str | None, message: str) -> None:
    """It is told why."""
    if content is not None:
        (tmp_path / "p.yaml").write_text(content)
    with pytest.raises(SubstitutionError, match=message):
        apply(f"$(substituted {tmp_path / 'p.yaml'})")


def test_no_place_for_a_copy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """That is told as well."""
    (tmp_path / "state").touch()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    (tmp_path / "p.yaml").write_text("a: $(var gain)")
    with pytest.raises(SubstitutionError, match="Not a directory"):
        apply(f"$(substituted {tmp_path / 'p.yaml'})")


@pytest.mark.parametrize("value", ["true == true", "False==true"])
def test_a_comparison_as_a_condition(value: str) -> None:
    """Nothing compares it: the argument alone is the condition."""
    with pytest.raises(SubstitutionError, match=r"is not made here; .* is the condition: if: \$\(var NAME\)$"):
        truth(value, "a.yaml")
    with pytest.raises(SubstitutionError, match=r"the condition: IfCondition\(LaunchConfiguration\(NAME\)\)$"):
        truth(value, "a.launch.py")


ARGUMENT = "to use the argument of that name write"


@pytest.mark.parametrize(
    ("value", "file", "way"),
    [
        ("on", "a.yaml", "write 'true'"),
        ("NO", "a.launch.py", "write 'false'"),
        ("1.5", "a.yaml", "compare with $(eval NAME == 'text')"),
        ("1.5", "a.launch.py", "compare with EqualsSubstitution(..., 'text')"),
        ("sim", "a.yaml", f"{ARGUMENT} $(var sim); else compare with $(eval NAME == 'text')"),
        (
            "sim",
            "a.launch.py",
            f"{ARGUMENT} LaunchConfiguration('sim'); else compare with EqualsSubstitution(..., 'text')",
        ),
    ],
)
def test_a_condition_that_is_none(value: str, file: str, way: str) -> None:
    """Is answered in the language of its file."""
    with pytest.raises(SubstitutionError) as caught:
        truth(value, file)
    assert str(caught.value) == f"expected true or false, got {value!r}; {way}"


@pytest.mark.parametrize(
    ("text", "way"),
    [
        ("$(eval $(var name) == 'sim')", "$(eval name == 'sim')"),
        ("$(eval '$(var name)' == sim)", ""),
        ("$(eval $(var name) == 'sim' and $(var count) > 1)", "$(eval name == 'sim' and count > 1)"),
    ],
)
def test_values_in_expressions(text: str, way: str) -> None:
    """A value that became a word of an expression is answered with the argument's name, which expressions know."""
    with pytest.raises(SubstitutionError) as caught:
        apply(text)
    assert str(caught.value).partition("is no argument; write ")[2] == way


@pytest.mark.parametrize(
    ("text", "value"),
    [("0042", 34), ("-017", -15), ("09", 9), ("off", False), ("Yes", True), ("True", True), ("y", "y"), ("", "")],
)
def test_values_of_launch_arguments(text: str, value: object) -> None:
    """They are read by YAML 1.1, as in ROS."""
    assert Written(text).value == value


def test_values_in_expressions_of_launch_files() -> None:
    """ROS's know no names of arguments, and take texts in quotes; their values are texts, too."""
    made = Substitutions({"mode": Written("sim")}, Path("a.launch.xml"), Outside({}, Path(), Path()), is_launch=True)
    assert made.apply("""v=$(eval '1 == 1') $(eval "$(eval '1 == 1')")""") == "v=True True"
    with pytest.raises(SubstitutionError, match=r"""write \$\(eval "'\$\(var mode\)' == 'sim'"\)"""):
        made.apply("$(eval $(var mode) == 'sim')")
