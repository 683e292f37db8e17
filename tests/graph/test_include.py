"""One graph file over another: what differs is all the second says, and every place is the one it was written at."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.errors import GraphFileError
from graphflow.graph.plan import Plan
from graphflow.graph.resolve import load

BASE = """\
name: base
args:
  gain: {default: 1.0}
deadlock: report
call_timeout: never
nodes:
  /a:
    class: nodes.a:A
    params: {gain: $(var gain), file: $(dirname)/map}
    remap: {goal: /pose, speed: /v}
    concurrency: {all: [control, enable]}
  /b: {class: nodes.b:B}
"""


def plan(folder: Path, over: str, *given: str, base: str = BASE) -> Plan:
    (folder / "sub").mkdir()
    (folder / "sub" / "base.yaml").write_text(base)
    (folder / "over.yaml").write_text(over)
    return load(folder / "over.yaml", given)


def test_a_file_that_only_includes_is_the_same_graph_by_another_name(tmp_path: Path) -> None:
    """Arguments, settings and nodes are the included file's; the name and the folder of classes are its own."""
    made = plan(tmp_path, "include: sub/base.yaml\n", "gain:=2.5")

    assert (made.name, made.deadlock, made.call_timeout) == ("over", "report", None)
    assert made.root == str(tmp_path)
    a, b = made.nodes
    assert (a.name, b.name) == ("/a", "/b")
    assert a.params["gain"].value == 2.5
    assert a.params["file"].value == str(tmp_path / "sub" / "map")
    assert a.params["gain"].place.file.endswith("sub/base.yaml")
    assert a.params["gain"].place.line == 9


def test_an_override_is_the_difference(tmp_path: Path) -> None:
    """Parameters and remaps entry by entry, groups as a whole, settings of the file, and nodes added."""
    over = """\
include: sub/base.yaml
deadlock: raise
args: {gain: {default: 7.0}}
override:
  /a:
    params: {extra: 1}
    remap: {goal: /goal}
    concurrency:
      motion: [control]
      goals: {handlers: [enable], limit: none, when_full: drop_old}
nodes:
  /c: {class: nodes.c:C}
"""
    made = plan(tmp_path, over)

    assert (made.deadlock, made.call_timeout) == ("raise", None)
    a, _, c = made.nodes
    assert c.name == "/c"
    assert {name: setting.value for name, setting in a.params.items()} == {
        "gain": 7.0,
        "file": str(tmp_path / "sub" / "map"),
        "extra": 1,
    }
    assert {rule.match: rule.replacement for rule in a.remaps} == {"goal": "/goal", "speed": "/v"}
    assert a.concurrency.keys() == {"motion", "goals"}
    goals = a.concurrency["goals"].change
    assert (goals.handlers, goals.limit, goals.sets_limit, goals.when_full) == (("enable",), None, True, "drop_old")
    assert a.concurrency["motion"].handler_places["control"].file.endswith("over.yaml")
    assert a.concurrency["motion"].handler_places["control"].line == 9
    assert Plan.from_json(made.to_json()) == made
    assert any("goals: enable; limit none; when_full drop_old" in line for line in made.lines())


@pytest.mark.parametrize("namespace", ["/", "$(var none '')"])
def test_a_namespace_that_is_none(tmp_path: Path, namespace: str) -> None:
    """It changes no name, and is none that fails to."""
    made = plan(tmp_path, f"include: {{file: sub/base.yaml, namespace: {namespace}}}\n")
    assert "/a" in [node.name for node in made.nodes]


@pytest.mark.parametrize(
    ("over", "complaint"),
    [
        ("include: sub/base.yml\n", r"over.yaml:1:10: there is no file .*sub/base.yml; did you mean 'base.yaml'"),
        ("include: over.yaml\n", r"over.yaml:1:10: over.yaml includes itself"),
        (
            "include: sub/base.yaml\noverride: {/aa: {env: {}}}\n",
            r"over.yaml:2:12: the included file has no node '/aa'",
        ),
        (
            "include: sub/base.yaml\noverride: {/a: 3}\n",
            r"over.yaml:2:16: /a: expected a mapping of what differs, got 3",
        ),
        ("include: sub/base.yaml\noverride: {/a: {parms: {}}}\n", r"over.yaml:2:17: unknown key 'parms'; did you mean"),
        ("include: sub/base.yaml\nnodes: {/a: {class: x:Y}}\n", r"over.yaml:2:9: /a is already in the included file"),
        (
            "include: {file: sub/base.yaml, namespace: /robot}\n",
            r"over.yaml:1:43: every name in sub/base.yaml begins with a slash, so the namespace has no effect; leave",
        ),
        (
            "include: [{file: sub/base.yaml, namespace: /r}, {file: sub/base.yaml, namespace: /s}]\n",
            r"this makes the node /a more than once: .* or leave out its slash and give each include: of this file a ",
        ),
        (
            "nodes: {/a: {class: x:Y}}\ngroup: {include: sub/base.yaml}\n",
            r"/a is already at .*over.yaml:1:9; give one of them another name, or one include: a namespace",
        ),
        (
            "include: [sub/base.yaml]\noverride: {/a: {env: {}}}\n",
            r"over.yaml:2:1: override: with a list of files, .* as in - {file: FILE, override: ...}",
        ),
        ("include: sub/base.yaml\noverride: {/a: {enabled: no}}\n", r"unknown key 'enabled'; if: false leaves out a"),
        ("include: [3]\nnodes: {}\n", r"over.yaml:1:11: include: expected a mapping, got 3, for example include: base"),
        ("include: {fil: x}\nnodes: {}\n", r"over.yaml:1:11: unknown key 'fil'; did you mean 'file'?"),
        ("override: {}\nnodes: {/a: {class: x:Y}}\n", r"over.yaml:1:1: override: goes with include:"),
        (
            "include: sub/base.yaml\noverride: {/a: {concurrency: {g: [x], h: [x]}}}\n",
            r"x is put in two groups, 'g' an",
        ),
        (
            "include: sub/base.yaml\noverride: {/a: {concurrency: {g: {limit: 0}}}}\n",
            r"limit: expected 1 or more, or none",
        ),
        (
            "include: sub/base.yaml\noverride: {/a: {concurrency: {g: {lmit: 1}}}}\n",
            r"unknown key 'lmit'; did you mean",
        ),
        (
            "include: sub/base.yaml\noverride: {/a: {concurrency: {g: {when_full: x}}}}\n",
            r"when_full: expected one of wai",
        ),
        (
            "include: sub/base.yaml\ndeadlock: shout\n",
            r"over.yaml:2:11: deadlock: expected one of raise, report, break",
        ),
        (
            "include: sub/base.yaml\ncall_timeout: 0\n",
            r"over.yaml:2:15: call_timeout: expected seconds, or never, got 0",
        ),
    ],
)
def test_mistakes(tmp_path: Path, over: str, complaint: str) -> None:
    """Each is told with its place in the file that it was made in."""
    with pytest.raises(GraphFileError, match=complaint):
        plan(tmp_path, over)


def test_a_ring_of_files(tmp_path: Path) -> None:
    """Files that include each other are told."""
    with pytest.raises(GraphFileError, match=r"sub/base.yaml:1:10: ../over.yaml includes itself"):
        plan(tmp_path, "include: sub/base.yaml\n", base="include: ../over.yaml\n")
