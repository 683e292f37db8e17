"""The words of a file."""

from __future__ import annotations

import ast

import pytest

from graphflow.analysis.words import methods_in, prefixes_in, words_in

TEXT = "self.set = self.read\ncall(name, 'given')\nself.log.info('shown')\nprint('shown')"


def test_words_are_what_is_read_and_not_what_is_shown() -> None:
    """Attributes, names and strings; set attributes and the texts of logs are none."""
    assert words_in(ast.parse(TEXT)) == {"self", "read", "call", "name", "given", "log", "info", "print"}


def test_methods_are_referred_to_by_attributes_strings_and_names_in_classes() -> None:
    """A name in a function is that of a variable."""
    text = f"{TEXT}\nclass A:\n    again = once\n    @action(accept=may)\n    def tick(self):\n        print(other)"
    assert methods_in(ast.parse(text)) == {"read", "given", "log", "info", "once", "action", "may"}


def test_what_a_module_has_is_no_method() -> None:
    """Neither has the fixture of a test; an object that a module holds may have one."""
    text = "import graphflow, os.path as paths\ngraphflow.run(Robot)\npaths.start\ngraph.stop\ngraphflow.nodes.go"
    assert methods_in(ast.parse(text)) == {"go"}


@pytest.mark.parametrize(
    ("text", "prefixes"),
    [
        ("getattr(self, f'on_{state}')()", ("on_",)),
        ("getattr(self, 'on_' + state)()", ("on_",)),
        ("getattr(self, f'{state}_callback')()", ("",)),
        ("getattr(self, 'on_idle')()", ()),
        ("format(self, f'on_{state}')", ()),
    ],
)
def test_names_that_are_put_together(text: str, prefixes: tuple[str, ...]) -> None:
    """They begin like this; "" if anything may come first."""
    assert prefixes_in(ast.parse(text)) == prefixes
