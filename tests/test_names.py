"""Names: what is legal, how they are expanded, and how they are remapped."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from graphflow.errors import InvalidName
from graphflow.names import (
    Kind,
    Remap,
    Resolver,
    check_full_name,
    check_namespace,
    check_node_name,
    expand,
    is_hidden,
    join,
    split,
)
from tests.cases import slow


def rules(*texts: str) -> list[Remap]:
    return [Remap.parse(text) for text in texts]


@pytest.mark.parametrize("name", ["talker", "_hidden", "Node2", "a__b"])
def test_node_names(name: str) -> None:
    """Letters, digits and underscores make a node name."""
    assert check_node_name(name) == name


@pytest.mark.parametrize("name", ["", "2nd", "a-b", "a b", "a\n", "é", "~", "a.b", "{node}"])
def test_wrong_node_names(name: str) -> None:
    """Anything else is refused, with the rule."""
    with pytest.raises(InvalidName, match="is not a node name: use letters, digits and _"):
        check_node_name(name)


@pytest.mark.parametrize(
    ("name", "near"), [("my turtle", "my_turtle"), ("a-b.c", "a_b_c"), ("2nd", ""), ("\u00e9", "")]
)
def test_a_name_that_is_like_a_wrong_one(name: str, near: str) -> None:
    """Is told where there is one, also of a namespace."""
    end = f"; did you mean '{near}'?" if near else "with a digit"
    for check in (check_node_name, check_namespace):
        with pytest.raises(InvalidName) as caught:
            check(name)
        assert str(caught.value).endswith(end)


def test_a_node_name_that_is_no_text() -> None:
    """As in `super().__init__(...)`, copied with its dots."""
    with pytest.raises(InvalidName, match=r"^Ellipsis is not a node name: write a text, or nothing for the name of"):
        check_node_name(...)  # type: ignore[arg-type]


@pytest.mark.parametrize(("name", "namespace"), [("/a/b", "/a"), ("a/b", "a"), ("/b", "/")])
def test_a_node_name_with_a_namespace_in_it(name: str, namespace: str) -> None:
    """Who writes the namespace into the name is told to give it apart."""
    with pytest.raises(InvalidName, match=f"give the namespace '{namespace}' separately"):
        check_node_name(name)


@pytest.mark.parametrize("name", ["/a", "/a/b_c/D2", "/_a", "/a__b", "/" + "a" * 254])
def test_full_names(name: str) -> None:
    """Legal names between slashes make a full name, up to 255 characters."""
    assert check_full_name(name) == name


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("", "begins with /"),
        ("a", "begins with /"),
        ("/", "ends with /"),
        ("/a/", "ends with /"),
        ("//a", "has // in it"),
        ("/a//b", "has // in it"),
        ("/2a", "'2a' may have only letters"),
        ("/a/b-c", "'b-c' may have only letters"),
        ("/a/b\n", "may have only letters"),
        ("/a*", "may have only letters"),
        ("/a/%", "may have only letters"),
        ("/" + "a" * 255, "longer than 255"),
    ],
)
def test_wrong_full_names(name: str, problem: str) -> None:
    """What would not be legal in ROS 2, or would break a Zenoh key, is refused with the rule."""
    with pytest.raises(InvalidName, match=f"is not a topic: .*{problem}"):
        check_full_name(name, "topic")


@pytest.mark.parametrize(("given", "full"), [("", "/"), ("/", "/"), ("a", "/a"), ("/a/b", "/a/b"), ("a/b", "/a/b")])
def test_namespaces_get_their_slash(given: str, full: str) -> None:
    """A namespace is put into its full form."""
    assert check_namespace(given) == full


@pytest.mark.parametrize("namespace", ["/a/", "a//b", "2", "~"])
def test_wrong_namespaces(namespace: str) -> None:
    """A namespace that is not made of legal names is refused."""
    with pytest.raises(InvalidName, match="is not a namespace"):
        check_namespace(namespace)


@pytest.mark.parametrize(
    ("namespace", "name", "full"),
    [("/", "a", "/a"), ("/ns", "a", "/ns/a"), ("/ns", "/a", "/a"), ("/n/s", "a/b", "/n/s/a/b")],
)
def test_join(namespace: str, name: str, full: str) -> None:
    """Relative names join the namespace, absolute ones do not."""
    assert join(namespace, name) == full


@pytest.mark.parametrize(("full", "parts"), [("/b", ("/", "b")), ("/a/b", ("/a", "b")), ("/a/b/c", ("/a/b", "c"))])
def test_split_undoes_join(full: str, parts: tuple[str, str]) -> None:
    """Splitting a name gives what joins to it again."""
    assert split(full) == parts
    assert join(*parts) == full


@pytest.mark.parametrize(
    ("name", "hidden"), [("/a", False), ("/_a", True), ("/a/_action/status", True), ("/a_/b", False), ("_b", True)]
)
def test_hidden_names(name: str, hidden: bool) -> None:
    """A name is hidden when a part of it begins with an underscore."""
    assert is_hidden(name) is hidden


EXPANSIONS = [
    ("chatter", "/chatter", "/ns/chatter"),
    ("a/b", "/a/b", "/ns/a/b"),
    ("/chatter", "/chatter", "/chatter"),
    ("~", "/node", "/ns/node"),
    ("~/out", "/node/out", "/ns/node/out"),
    ("~/a/b", "/node/a/b", "/ns/node/a/b"),
    ("{node}/out", "/node/out", "/ns/node/out"),
    ("/all/{node}", "/all/node", "/all/node"),
    ("x_{node}", "/x_node", "/ns/x_node"),
    ("_private", "/_private", "/ns/_private"),
]


@pytest.mark.parametrize(("name", "at_root", "in_namespace"), EXPANSIONS)
def test_expansion(name: str, at_root: str, in_namespace: str) -> None:
    """Relative, absolute, private and substituted names become full ones as in ROS 2."""
    assert expand(name, "/", "node") == at_root
    assert expand(name, "/ns", "node") == in_namespace


@pytest.mark.parametrize("word", ["ns", "namespace"])
def test_the_namespace_is_substituted(word: str) -> None:
    """`{ns}` is the namespace with its slash."""
    assert expand(f"{{{word}}}/a", "/n/s", "node") == "/n/s/a"


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("", "is empty"),
        ("/", "ends with /"),
        ("a/", "ends with /"),
        ("~/", "ends with /"),
        ("~a", "'~a' may have"),
        ("a/~", "'~' may have"),
        ("a//b", "has // in it"),
        ("//a", "has // in it"),
        ("//", "it ends with /"),
        ("2a", "'2a' may have"),
        ("a b", "may have only"),
        ("/spawn x/srv/Spawn {x: 1}", "has spaces in it; the name ends at '/spawn', so write the name alone"),
        ("{nod}", r"has \{nod\} in it; only \{node\} and \{ns\} are known"),
        ("a{", "may have only"),
    ],
)
def test_what_cannot_be_expanded(name: str, problem: str) -> None:
    """A name that would not be legal is refused as it was written, with the rule."""
    with pytest.raises(InvalidName, match=f"^'{name.replace('{', '.').replace('}', '.')}' .*{problem}"):
        expand(name, "/ns", "node")


@pytest.mark.parametrize("name", ["a//b", "{ns}//a", "{ns}/a//b"])
def test_empty_parts_at_the_root(name: str) -> None:
    """They are refused there, too, but for the one that the namespace leaves."""
    assert expand("{ns}/a", "/", "node") == "/a"
    with pytest.raises(InvalidName, match="has // in it"):
        expand(name, "/", "node")


@slow
@settings(derandomize=True, deadline=None)
@given(st.text(st.sampled_from("aB_2/~{}-node"), max_size=12))
def test_an_expanded_name_is_a_full_name(name: str) -> None:
    """Whatever is written either is refused or becomes a legal full name that expands to itself."""
    try:
        full = expand(name, "/ns", "node")
    except InvalidName:
        return
    assert check_full_name(full) == full
    assert expand(full, "/other", "other") == full


@pytest.mark.parametrize(
    ("text", "rule"),
    [
        ("a:=b", Remap("a", "b")),
        ("/a:=/b/c", Remap("/a", "/b/c")),
        ("~/a:=~/b", Remap("~/a", "~/b")),
        ("n:a:=b", Remap("a", "b", node="n")),
        ("rostopic://a:=b", Remap("a", "b", kind="topic")),
        ("rosservice:///a:=b", Remap("/a", "b", kind="service")),
        ("n:rostopic://a:=b", Remap("a", "b", node="n", kind="topic")),
        ("n:rosservice://a:=b", Remap("a", "b", node="n", kind="service")),
        ("__ns:=/x", Remap("__ns", "/x")),
        ("__node:=x", Remap("__node", "x")),
        ("__name:=x", Remap("__name", "x")),
        ("n:__node:=x", Remap("__node", "x", node="n")),
    ],
)
def test_rules_are_read(text: str, rule: Remap) -> None:
    """A rule has a match and a replacement, perhaps a node, perhaps a kind."""
    assert Remap.parse(text) == rule


def test_a_rule_keeps_its_source() -> None:
    """Where a rule was written stays with it."""
    assert Remap.parse("a:=b", "demo.yaml:7").source == "demo.yaml:7"


@pytest.mark.parametrize("text", ["a:=b", "n:a:=b", "n:__node:=x"])
def test_a_rule_prints_as_it_is_written(text: str) -> None:
    """A rule's text is that of the command line."""
    assert str(Remap.parse(text)) == text


@pytest.mark.parametrize("text", ["", "a", "a=b", "a:b", ":=b", ":="])
def test_what_is_no_rule(text: str) -> None:
    """A rule without `:=`, or with nothing on a side, is refused with an example."""
    with pytest.raises(InvalidName, match="is not a remap rule; write it as from:=to"):
        Remap.parse(text)


def test_a_rule_that_a_space_has_cut() -> None:
    """What is behind the space is no part of it."""
    with pytest.raises(InvalidName, match=r"'__node:=': the name is missing; write it behind := without a space"):
        Remap.parse("__node:=")


@pytest.mark.parametrize("text", [":a:=b", "/ns/n:a:=b", "2n:a:=b"])
def test_a_rule_for_what_is_no_node(text: str) -> None:
    """A rule for one node that no node can be called is refused."""
    with pytest.raises(InvalidName, match="is not a node name"):
        Remap.parse(text)


def test_a_misspelt_key_is_helped() -> None:
    """An unknown `__key` is refused with the nearest known one."""
    with pytest.raises(InvalidName, match="'__nod' is not a remap key; did you mean '__node:=x'"):
        Remap.parse("__nod:=x")


def test_without_rules_a_name_is_its_expansion() -> None:
    """A node without rules has the names it asks for."""
    resolver = Resolver("node", "/ns")
    assert (resolver.full_name, resolver.resolve("a"), resolver.resolve("~/b")) == ("/ns/node", "/ns/a", "/ns/node/b")


def test_the_first_match_wins() -> None:
    """Of two rules for one name the first applies."""
    assert Resolver("node", "/", rules("a:=first", "/a:=second")).resolve("a") == "/first"


def test_a_result_is_not_remapped_again() -> None:
    """Rules are not chained, so two names can be swapped."""
    resolver = Resolver("node", "/", rules("a:=b", "b:=a"))
    assert (resolver.resolve("a"), resolver.resolve("b")) == ("/b", "/a")


def test_both_sides_of_a_rule_are_expanded() -> None:
    """Match and replacement are read as the node itself would read them."""
    resolver = Resolver("node", "/ns", rules("~/a:=b", "/ns/c:=/d", "e:=~/f"))
    assert [resolver.resolve(n) for n in ("~/a", "/ns/node/a", "c", "e")] == ["/ns/b", "/ns/b", "/d", "/ns/node/f"]


def test_only_whole_names_match() -> None:
    """A rule for a name leaves longer names alone."""
    assert Resolver("node", "/", rules("a:=b")).resolve("a/c") == "/a/c"


def test_a_rule_for_one_kind() -> None:
    """A rule for services leaves the topic of the same name alone, and the other way round."""
    resolver = Resolver("node", "/", rules("rosservice://a:=s", "rostopic://a:=t"))
    kinds: list[Kind] = ["topic", "service"]
    assert [resolver.resolve("a", kind) for kind in kinds] == ["/t", "/s"]


def test_a_rule_for_one_node() -> None:
    """A rule for another node is not this one's."""
    texts = ("other:a:=wrong", "node:a:=right")
    assert Resolver("node", "/", rules(*texts)).resolve("a") == "/right"


def test_node_and_namespace_are_replaced() -> None:
    """`__node` and `__ns` change the node's own name before any other name is made of it."""
    resolver = Resolver("node", "/", rules("__node:=fred", "__ns:=/x/y", "~/a:=b"))
    assert (resolver.full_name, resolver.resolve("~/a"), resolver.resolve("~/c")) == (
        "/x/y/fred",
        "/x/y/b",
        "/x/y/fred/c",
    )


def test_the_first_name_and_namespace_win() -> None:
    """Of several `__node` or `__ns` rules that apply, the first does."""
    resolver = Resolver("node", "", rules("other:__node:=no", "__name:=one", "__node:=two", "node:__ns:=a", "__ns:=b"))
    assert resolver.full_name == "/a/one"


def test_a_renamed_node_goes_by_both_names() -> None:
    """Rules for one node find it by the name it was given and by the one it was changed to."""
    resolver = Resolver(
        "node", "/", rules("node:__node:=fred", "fred:__ns:=/x", "fred:a:=b", "node:c:=d", "other:e:=f")
    )
    assert [resolver.full_name, *map(resolver.resolve, "ace")] == ["/x/fred", "/x/b", "/x/d", "/x/e"]


@pytest.mark.parametrize(
    ("name", "namespace", "texts"),
    [("a b", "/", []), ("a", "/b/", []), ("a", "/", ["__node:=/x/y"]), ("a", "/", ["__ns:=b c"])],
)
def test_a_resolver_checks_its_own_name(name: str, namespace: str, texts: list[str]) -> None:
    """A node with an illegal name or namespace, its own or from a rule, is refused."""
    with pytest.raises(InvalidName):
        Resolver(name, namespace, rules(*texts))


@pytest.mark.parametrize("text", ["a:=b c", "a:=b/", "2:=b"])
def test_a_rule_that_makes_no_name(text: str) -> None:
    """A rule with an illegal side is refused when a name is resolved by it."""
    with pytest.raises(InvalidName):
        Resolver("node", "/", rules(text)).resolve("a")


def test_the_derivation_tells_each_step() -> None:
    """For every name it is kept what was written, its full form, and the rule with its source."""
    rule = Remap.parse("pose:=/turtle1/pose", "demo.yaml:12:5")
    resolver = Resolver("node", "/ns", [rule])
    for name in ("pose", "/clock", "~/out"):
        resolver.resolve(name)
    assert [str(d) for d in resolver.derivations.values()] == [
        "pose -> /ns/pose -> /turtle1/pose (remap pose:=/turtle1/pose from demo.yaml:12:5)",
        "/clock",
        "~/out -> /ns/node/out",
    ]
    derivation = resolver.derivations["/ns/pose"]
    assert (derivation.given, derivation.resolved, derivation.rule) == ("pose", "/turtle1/pose", rule)


def test_a_derivation_without_a_source() -> None:
    """A rule of unknown origin is told without one."""
    resolver = Resolver("node", "/", rules("node:/a:=/b"))
    resolver.resolve("/a")
    assert str(resolver.derivations["/a"]) == "/a -> /b (remap node:/a:=/b)"


def test_unused_rules_are_known() -> None:
    """Rules that no name has matched are told; other nodes' rules and `__` rules are not."""
    resolver = Resolver("node", "/", rules("a:=b", "node:c:=d", "other:e:=f", "__ns:=/x", "a:=never"))
    assert [str(r) for r in resolver.unused()] == ["a:=b", "node:c:=d", "a:=never"]
    resolver.resolve("a")
    assert [str(r) for r in resolver.unused()] == ["node:c:=d", "a:=never"]


def test_a_rule_that_matches_but_does_not_change_is_used() -> None:
    """A rule to the name's own name counts as used."""
    resolver = Resolver("node", "/", rules("a:=a"))
    assert resolver.resolve("a") == "/a"
    assert resolver.unused() == []


@pytest.mark.parametrize(
    ("rule", "name", "resolved"),
    [
        ("/turtle1/*:=/robot/\\1", "/turtle1/pose", "/robot/pose"),
        ("/turtle1/*:=/robot/\\1", "/turtle1/a/pose", "/turtle1/a/pose"),
        ("/turtle1/**:=/robot/\\1", "/turtle1/a/pose", "/robot/a/pose"),
        ("/turtle1/**:=/robot/\\1", "/turtle1", "/robot"),
        ("/**/pose:=/poses/\\1", "/a/b/pose", "/poses/a/b"),
        ("/*/*:=/\\2/\\1", "/a/b", "/b/a"),
        ("*:=x", "chatter", "/ns/x"),
        ("~/*:=\\1", "~/state", "/ns/state"),
        ("**:=/all/\\1", "a/b", "/all/a/b"),
    ],
)
def test_wildcards(rule: str, name: str, resolved: str) -> None:
    """`*` stands for one part of a name, `**` for any number; the new name may use what they stand for."""
    assert Resolver("node", "/ns", [Remap.parse(rule)]).resolve(name) == resolved


@pytest.mark.parametrize(
    ("rule", "message"),
    [
        ("*chatter:=/a", "a wildcard stands for whole parts of a name"),
        ("/a*/b:=/a", "a wildcard stands for whole parts of a name"),
        ("/***:=/a", "a wildcard stands for whole parts of a name"),
        ("/*:=/a/\\2", "for which the rule has no wildcard"),
        ("/*:=/a/\\0", "for which the rule has no wildcard"),
    ],
)
def test_wildcards_that_are_wrong(rule: str, message: str) -> None:
    """Are told when the first name is looked at."""
    with pytest.raises(InvalidName, match=message):
        Resolver("node", "/", [Remap.parse(rule)]).resolve("chatter")


def test_a_name_that_an_earlier_rule_has_renamed() -> None:
    """The earlier rule is known; a rule is not in its own way."""
    first, second = rules("/a:=b", "a:=c")
    names = Resolver("node", "/", [first, second])
    assert names.taken_by(second) is None
    names.resolve("a")
    assert names.unused() == [second]
    assert names.taken_by(second) == first
    assert names.taken_by(first) is None
