"""Blocks of graph files taken apart: groups, loops, conditions, templates, and files in files."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError, Place
from graphflow.graph.expansion import expand
from graphflow.graph.plan import Plan
from graphflow.graph.resolve import load, resolve
from graphflow.markup import source
from tests.cases import slow

ENV = {"USER": "ada"}


def plan(text: str, *given: str) -> Plan:
    return resolve(source.read(text, "f.yaml"), Path("/nowhere/f.yaml"), given, ENV)


def problems(text: str, *given: str) -> list[str]:
    with pytest.raises(GraphFileError) as caught:
        plan(text, *given)
    return [str(problem).removeprefix("f.yaml:") for problem in caught.value.problems]


def names(found: Plan) -> list[str]:
    return [node.name for node in found.nodes]


# groups


GROUP = """\
group:
  namespace: fleet
  params: {rate: 5.0, limits: {speed: 1.0}}
  remap: {goal: /goal, pose: where}
  env: {A: "1", B: "2"}
  restart: on_failure
  log_level: debug
  nodes:
    one: {class: x:Y}
    two:
      class: x:Y
      namespace: inner
      params: {rate: 7.0}
      remap: {pose: /mine}
      env: {B: "3"}
      restart: never
    /three: {class: x:Y, namespace: ""}
  steps:
    go: {call: one/go, after: [one, inner/two]}
"""


def test_a_group_is_shared() -> None:
    """Namespace, parameters, remaps, environment and policies hold for all its nodes that do not say otherwise."""
    found = plan(GROUP)
    one, two, three = found.nodes
    assert names(found) == ["/fleet/one", "/fleet/inner/two", "/three"]
    assert {k: (s.value, s.is_optional) for k, s in one.params.items()} == {
        "rate": (5.0, True),
        "limits.speed": (1.0, True),
    }
    assert one.params["rate"].place == Place("f.yaml", 3, 18)
    assert {k: s.value for k, s in two.params.items()} == {"rate": 7.0, "limits.speed": 1.0}
    assert [(r.match, r.replacement, r.is_optional) for r in two.remaps] == [
        ("pose", "/mine", False),
        ("goal", "/goal", True),
        ("pose", "where", True),
    ]
    assert (one.env, two.env) == ({"A": "1", "B": "2"}, {"A": "1", "B": "3"})
    assert (one.restart.policy, two.restart.policy, three.restart.policy) == ("on_failure", "never", "on_failure")
    assert (one.log_level, three.log_level) == ("debug", "debug")
    (step,) = found.steps
    assert (step.target, step.after) == ("/fleet/one/go", {"/fleet/one": "ready", "/fleet/inner/two": "ready"})
    assert Plan.from_json(found.to_json()) == found


def test_groups_in_groups() -> None:
    """The innermost word counts; several groups are a list; an absolute namespace begins anew."""
    found = plan(
        """\
group:
  - namespace: a
    params: {p: 1, q: 1}
    group:
      - {namespace: b, params: {p: 2}, nodes: {n: {class: x:Y}}}
      - {namespace: /c, nodes: {n: {class: x:Y}}}
  - {nodes: {m: {class: x:Y}}}
"""
    )
    assert {n.name: {k: s.value for k, s in n.params.items()} for n in found.nodes} == {
        "/a/b/n": {"p": 2, "q": 1},
        "/c/n": {"p": 1, "q": 1},
        "/m": {},
    }


# loops


def test_a_loop_is_a_group_for_each_value() -> None:
    """A span, a list, mappings with parts, and what an expression gives; the variable keeps its type."""
    found = plan(
        """\
args: {count: {default: 2}}
for:
  - var: i
    in: 1..$(var count)
    namespace: turtle$(var i)
    nodes: {driver: {class: x:Y, params: {id: $(var i)}}}
    steps: {go$(var i): {call: go}}
  - var: t
    in: [{name: leo, x: 1.5}, {name: don, x: 2.5}]
    nodes: {/$(var t.name): {class: x:Y, params: {x: $(var t.x)}}}
  - {var: i, in: $(eval range(count)), for: {var: k, in: [a, b], nodes: {$(var k)$(var i): {class: x:Y}}}}
"""
    )
    assert names(found) == ["/turtle1/driver", "/turtle2/driver", "/leo", "/don", "/a0", "/b0", "/a1", "/b1"]
    assert [n.params["id"].value for n in found.nodes[:2]] == [1, 2]
    assert [n.params["x"].value for n in found.nodes[2:4]] == [1.5, 2.5]
    assert [(s.name, s.target) for s in found.steps] == [("go1", "/turtle1/go"), ("go2", "/turtle2/go")]
    assert found.args == {"count": 2}


def test_no_loop_is_endless(monkeypatch: pytest.MonkeyPatch) -> None:
    """The rounds of all loops are counted together."""
    monkeypatch.setattr(expand, "MAX_ROUNDS", 50)
    loop = "{var: i, in: 1..10, for: {var: k, in: 1..10, nodes: {}}}"
    assert problems(f"for: {loop}\nnodes: {{a: {{class: x:Y}}}}\n") == ["1:44: the loops have more than 50 rounds"]


GROWING = "args:\n" + "".join(
    f"  a{i}: {{default: {what}}}\n"
    for i, what in enumerate(["[1, 2]", *(f"[{', '.join([f'$(var a{i})'] * 10)}]" for i in range(12))])
)
TEXTS = "args:\n" + "".join(
    f"  a{i}: {{default: '{what}'}}\n" for i, what in enumerate(["x" * 10, *(f"$(var a{i})" * 10 for i in range(12))])
)
SUMS = "args:\n" + "".join(
    f"  a{i}: {{default: {what}}}\n" for i, what in enumerate(["[1, 2]", *(f"$(eval a{i} + a{i})" for i in range(40))])
)


@slow
@pytest.mark.parametrize(
    ("text", "said"),
    [
        (GROWING, "loops and arguments make more than 500,000 values of it"),
        (TEXTS, "the text has more than 100,000 characters"),
        (SUMS, "a list has at most 10000 elements"),
    ],
)
def test_arguments_do_not_grow_without_end(text: str, said: str) -> None:
    """Each made of those before it ten times over: it is refused before it costs much."""
    assert any(said in problem for problem in problems(f"{text}nodes: {{a: {{class: x:Y}}}}\n"))


# conditions


@pytest.mark.parametrize(
    ("condition", "is_there"),
    [
        ("if: true", True),
        ("if: false", False),
        ("unless: true", False),
        ("if: $(var view)", False),
        ("unless: $(var view)", True),
        ("if: $(eval mode == 'sim')", True),
        (r"if: $(eval '\'$(var mode)\' == \'sim\'')", True),
        (r"if: $(eval '\'$(var mode)\' == \'real\'')", False),
        ("if: $(equals $(var mode) sim)", True),
        ("if: $(not $(var view))", True),
        ('if: "1"', True),
        ("if: TRUE", True),
        ("{if: true, unless: true}", False),
    ],
)
def test_conditions(condition: str, is_there: bool) -> None:
    """On nodes, steps, groups, loops and includes; what is left out is not looked at any further."""
    head = "args: {view: {default: false}, mode: {default: sim}}\nnodes:\n  b: {class: x:Y, after: a}\n"
    words = condition.strip("{}")
    node = f"  a: {{class: $(env NOBODY x:Y), {words}}}\n"
    found = plan(head + node)
    assert names(found) == (["/b", "/a"] if is_there else ["/b"])
    assert found.nodes[0].after == ({"/a": "ready"} if is_there else {})
    for block in ("group: {%s, nodes: {c: {class: x:Y}}}", "for: {%s, var: i, in: [1], nodes: {c: {class: x:Y}}}"):
        assert ("/c" in names(plan(head + "  a: {class: x:Y}\n" + block % words))) is is_there
    step = f"steps: {{s: {{call: /x, {words}}}}}\n"
    assert bool(plan(head + "  a: {class: x:Y}\n" + step).steps) is is_there


def test_what_is_left_out_is_not_asked_for() -> None:
    """Neither is its environment variable, nor its file."""
    text = "nodes: {a: {class: x:Y}, b: {class: $(env NOBODY), if: false}}\ninclude: {file: gone.yaml, if: false}\n"
    assert names(plan(text)) == ["/a"]


# templates


def test_a_template_is_filled_in() -> None:
    """Parameters, remaps and environment by entry; the rest as a whole; substitutions with the node's own values."""
    found = plan(
        """\
templates:
  robot: {class: x:Y, params: {a: 1, who: $(var i)}, remap: {p: q}, process: all, after: []}
for: {var: i, in: [1, 2], nodes: {r$(var i): {template: robot, params: {a: $(var i)}, process: mine}}}
nodes: {s: {template: robot, class: x:Z, params: {who: me}}}
"""
    )
    one, two, s = sorted(found.nodes, key=lambda n: n.name)
    assert [n.params["who"].value for n in (one, two, s)] == [1, 2, "me"]
    assert [n.params["a"].value for n in (one, two, s)] == [1, 2, 1]
    assert [(n.class_path, n.process) for n in (one, two, s)] == [("x:Y", "mine"), ("x:Y", "mine"), ("x:Z", "all")]
    assert one.remaps[0].place == Place("f.yaml", 2, 62)


# files


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Files that others include."""
    (tmp_path / "robot.yaml").write_text(
        "args: {name: {default: leo}, speed: {default: 1.0}}\n"
        "templates: {spare: {class: x:S}}\n"
        "deadlock: report\n"
        "group: {namespace: $(var name), nodes: {driver: {class: x:D, params: {speed: $(var speed)}}}}\n"
        "steps: {hello_$(var name): {call: /hello}}\n"
    )
    return tmp_path


def loaded(folder: Path, text: str, *given: str) -> Plan:
    (folder / "main.yaml").write_text(text)
    return load(folder / "main.yaml", given, ENV)


def test_one_file_twice(folder: Path) -> None:
    """With arguments of its own each time; what is not given is an argument of the whole."""
    found = loaded(
        folder,
        "include:\n  - {file: robot.yaml, args: {name: don}}\n"
        "  - {file: robot.yaml, args: {name: raph}, namespace: n}\n",
        "speed:=2",
    )
    assert {n.name: n.params["speed"].value for n in found.nodes} == {"/don/driver": 2, "/n/raph/driver": 2}
    assert [s.name for s in found.steps] == ["hello_don", "hello_raph"]
    assert (found.args, found.deadlock) == ({"speed": 2}, "raise")


def test_a_file_in_a_group_and_in_a_loop(folder: Path) -> None:
    """It has the namespace and the settings of what is around it; its templates are there for the includer."""
    found = loaded(
        folder,
        "group:\n  namespace: lab\n  params: {noise: 0.1}\n  for:\n    var: r\n    in: [a, b]\n"
        "    include: {file: robot.yaml, args: {name: $(var r)}, override: {driver: {params: {speed: 9.0}}}}\n"
        "include: {file: robot.yaml}\nnodes: {s: {template: spare}}\n",
    )
    assert {n.name: {k: s.value for k, s in n.params.items()} for n in found.nodes} == {
        "/leo/driver": {"speed": 1.0},
        "/lab/a/driver": {"noise": 0.1, "speed": 9.0},
        "/lab/b/driver": {"noise": 0.1, "speed": 9.0},
        "/s": {},
    }
    assert found.deadlock == "report"


@pytest.mark.parametrize(
    ("text", "deadlock"),
    [
        ("include: robot.yaml\n", "report"),
        ("include: {file: robot.yaml}\n", "report"),
        ("include: {file: robot.yaml, namespace: n}\n", "raise"),
        ("group: {include: robot.yaml}\n", "raise"),
        ("for: {var: i, in: [1], include: robot.yaml}\n", "raise"),
    ],
)
def test_whose_settings_count(folder: Path, text: str, deadlock: str) -> None:
    """A file that is included whole speaks for the graph; one that is a part of it does not."""
    assert loaded(folder, text).deadlock == deadlock


def test_a_node_can_be_taken_out(folder: Path) -> None:
    """An override with a condition that does not hold leaves a node of the included file out."""
    text = "include: robot.yaml\noverride: {driver: {if: false}}\nnodes: {b: {class: x:Y, after: /leo/driver}}\n"
    found = loaded(folder, text)
    assert names(found) == ["/b"]
    assert found.nodes[0].after == {}


def test_the_file_name_may_be_made(folder: Path) -> None:
    """Of arguments; it is looked for beside the file that names it."""
    assert names(loaded(folder, "args: {which: {default: robot}}\ninclude: $(var which).yaml\n")) == ["/leo/driver"]


# mistakes

HEAD = "nodes: {a: {class: x:Y}}\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("group: {nodes: {b: {class: x:Y}}, nods: {}}", "2:35: unknown key 'nods'; did you mean 'nodes'?"),
        ("group: {params: [a]}", "2:17: params: expected a mapping, got ['a']"),
        ("group: 3", "2:8: group: expected a mapping, got 3, for example group: {namespace: robot1, nodes: {talker"),
        ("group: {namespace: n, nodes: {/b: {class: x:Y}}}", "2:20: every name in this group begins with a slash, so"),
        ("group: {namespace: a-b, nodes: {b: {class: x:Y}}}", "2:20: '/a-b' is not a namespace"),
        ("group: {restart: sometimes}", "2:18: restart: expected one of never, on_failure, always, got 'sometimes'"),
        ("for: {var: i, nodes: {}}", "2:1: the key 'in' is missing"),
        ("for: {vr: i, in: [1]}", "2:7: unknown key 'vr'; did you mean 'var'?"),
        ("for: {var: a-b, in: [1]}", "2:12: var: expected a name for the loop's values, got 'a-b'"),
        ("for: {var: i, in: 3..1, nodes: {b: {class: x:Y}}}", "2:19: in: 3..1 is empty, as a span counts up; write 1."),
        ("for: {var: i, in: [a, b, a], nodes: {b: {class: x:Y}}}", "2:26: in: 'a' is in the list twice; remove one"),
        ("for: {var: i, in: 1..2}", "2:1: the loop has no nodes; indent nodes: below it"),
        ("group: {namespace: lab}", "2:1: the group has no nodes; indent nodes: below it"),
        (
            "group: {lab: {nodes: {b: {class: x:Y}}}}",
            "2:9: unknown key 'lab'; a group is named by its namespace: group: ",
        ),
        ("for i in 1..3:\n  nodes: {}", "2:1: unknown key 'for i in 1..3'; write for: {var: i, in: 1..3, nodes: ...}"),
        ("include: sub.yaml r:=2 s:=b", "2:10: arguments stand apart: include: {file: sub.yaml, args: {r: 2, s: b}}"),
        (
            "steps: {s: {publish: /x}}",
            "2:13: unknown key 'publish'; no step publishes: let a node do it, or graphflow t",
        ),
        (
            "group: {nodes: {b: {class: x:Y, params: {rate=2.0}}}}",
            "2:42: parameter 'rate=2.0' has no value; write rate: 2",
        ),
        ("for: {var: i, in: x}", "2:19: in: expected a list or a span such as 1..10, got 'x'"),
        ("for: {var: i, in: [1, 2], nodes: {b: {class: x:Y}}}", "2:35: this makes the node /b more than once:"),
        ("for: {var: i, in: [1, 2], nodes: {$(var j): {class: x:Y}}}", "2:35: there is no argument 'j'; there is i"),
        ("for: {var: i, in: [{n: 1}], nodes: {b$(var i.m): {class: x:Y}}}", "2:37: $(var i.m): 'i' has no 'm'"),
        (
            "group: {if: perhaps, nodes: {b: {class: x:Y}}}",
            "2:13: if: expected true or false, got 'perhaps'; compare with $(eval ",
        ),
        ("group: {if: $(eval x ==), nodes: {b: {class: x:Y}}}", "2:13: $(eval x ==): not an expression"),
        ("group: {if: 'Yes', nodes: {b: {class: x:Y}}}", "2:13: if: expected true or false, got 'Yes'; write 'true'"),
        ("group: {nodes: {b: {template: t}}}", "2:31: there is no template 't'; the file has none under templates:"),
        (
            "group: {nodes: {b: {template: [t]}}}",
            "2:31: template: expected the name of one template, got ['t']; write te",
        ),
        (
            "group: {nodes: {b: {template: [t, u]}}}",
            "2:31: template: expected the name of one template, got ['t', 'u']",
        ),
        (
            "templates: {t: {class: x:Y, template: u}}\ngroup: {nodes: {b: {template: t}}}",
            "2:29: a template cannot use a template; write here what it has",
        ),
        ("templates: {t: {clas: x}}\nsteps: {s: {call: /x}}\ngroup: {nodes: {b: {template: t}}}", "2:17: unknown key"),
        (
            "templates: {t: 3}\ngroup: {nodes: {b: {template: t}}}",
            "2:16: templates.t: expected a mapping, as",
        ),
        (
            "include: [{file: a.yaml, if: false}]\noverride: {}",
            "3:1: override: with several files, write it at the one whose",
        ),
        ("include: {fil: x}", "2:11: unknown key 'fil'; did you mean 'file'?"),
        ("include: {file: 3}", "2:17: file: expected text, got 3"),
        (
            "steps: {s: {call: /x, set: /y}}",
            "2:9: a step has one of call, set, goal, wait, delay, log, shutdown; 's' has call",
        ),
        ("steps: {s: {wait: /x, request: {a: 1}}}", "2:23: request: does not go with wait:, which sends nothing"),
        ("steps: {s: {call: /x, params: {a: 1}}}", "2:23: params: does not go with call:; write request:"),
        ("steps: {s: {set: /a}}", "2:9: there is nothing to set; write params: {NAME: VALUE} beside set: /a"),
        ("group: {nodes: {b: {command: ls}}}", "2:30: command: expected a list; write command: [ls]"),
        (
            "group: {nodes: {b: {command: [ls], params: {a: 1}}}}",
            "2:20: params: is for nodes, and this is",
        ),
        ("group: {nodes: {b: {command: [ls], class: x:Y}}}", "2:20: class: is for nodes, and this is"),
        (
            "group: {nodes: {b: {class: x:Y, on_exit: stop}}}",
            "2:42: on_exit: expected one of ignore, rest",
        ),
        ("group: {nodes: {b: {class: x:Y, on_exit: restart, restart: never}}}", "2:42: on_exit: restart contradicts"),
        (
            "group: {nodes: {b: {class: x:Y, log_level: loud}}}",
            "2:44: log_level: expected one of debug, i",
        ),
        (
            "group: {nodes: {b: {class: x:Y, after: {a: later}}}}",
            "2:40: after: expected a name, a list of n",
        ),
        (
            "group: {lifecycle: true}",
            "2:20: lifecycle: expected one of unconfigured, inactive, active, got true; write lifecycle: active",
        ),
        ("group: {on_exit: 3}", "2:18: on_exit: expected one of ignore, restart, shutdown, got 3"),
        ("strategy: all", "2:11: strategy: expected one of one_for_one, rest_for_one, one_for_all, got 'all'"),
    ],
)
def test_mistakes(text: str, said: str) -> None:
    """Each is told once, where it was made, with what may stand there."""
    (found,) = problems(HEAD + text)
    assert found.startswith(said)


def test_nodes_of_groups_on_their_own_namespace() -> None:
    """A group whose namespace is used by its steps or inner groups alone has not written it in vain."""
    assert (
        plan(HEAD + "group: {namespace: n, nodes: {/b: {class: x:Y}}, steps: {s: {call: go}}}").steps[0].target
        == "/n/go"
    )


def test_variables_of_groups_are_seen_in_them() -> None:
    """By `$(env ...)`, also where a group within adds to one."""
    text = (
        "group: {env: {A: 1, USER: $(env USER)s}, group: {env: {A: $(env A):2}, "
        "nodes: {n: {class: x:Y, params: {a: $(env A) $(env USER)}}}}}\n"
    )
    [node] = plan(text).nodes
    assert (node.env["A"], node.params["a"].value) == ("1:2", "1:2 adas")
    assert problems("{nodes: {n: {class: x:Y, params: {a: $(env A)}}}, group: {env: {A: 1}, nodes: {}}}\n")


def test_a_loop_may_be_empty_by_its_arguments() -> None:
    """A span whose end an argument says may have no values; so may a list."""
    text = HEAD + "args: {n: {default: 0}}\nfor: {var: i, in: 1..$(var n), nodes: {b$(var i): {class: x:Y}}}"
    assert names(plan(text)) == ["/a"]
    assert names(plan(text, "n:=2")) == ["/a", "/b1", "/b2"]


def test_a_variable_of_another_language_is_remarked() -> None:
    """An argument's name as a shell or a template has it stays as it is; in a program's words it may be meant."""
    text = (
        "args: {rate: {default: 2}}\nnodes:\n"
        "  a: {class: x:Y, params: {p: '${rate} $HOME'}}\n"
        "  b: {command: [sh, -c, 'echo $rate']}\n"
    )
    assert plan(text).remarks == ("f.yaml:3:31: ${rate} stays as it is; for the value of 'rate' write $(var rate)",)
