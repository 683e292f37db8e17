"""Arguments that nothing uses."""

from __future__ import annotations

from pathlib import Path

import pytest

from graphflow.graph.resolve import load

ARGS = "args: {rate: {default: 2.0, unit: Hz}}\n"
NODE = "nodes: {/t: {class: a:T}}\n"
INNER = "args: {rate: {default: 1.0}}\nnodes: {/i: {class: a:I, params: {rate: $(var rate)}}}\n"


def told(folder: Path, text: str, **others: str) -> list[str]:
    """Return the remarks on a graph, without its folder."""
    for name, content in others.items():
        (folder / f"{name}.yaml").write_text(content)
    (folder / "g.yaml").write_text(text)
    return [remark.replace(f"{folder}/", "") for remark in load(folder / "g.yaml", (), {}).remarks]


def test_an_argument_that_nothing_uses(tmp_path: Path) -> None:
    """It is reported with its place, also in an included file, and once."""
    text = "nothing uses the argument 'rate'; write $(var rate) where it is meant"
    assert told(tmp_path, f"{ARGS}nodes: {{/t: {{class: a:T, params: {{rate: 1.0}}}}}}\n") == [f"g.yaml:1:8: {text}"]
    loop = "for: {var: i, in: [1, 2], include: {file: inner.yaml, namespace: r$(var i)}}\n"
    inner = f"{ARGS}nodes: {{t: {{class: a:T}}}}\n"
    assert told(tmp_path, loop, inner=inner) == [f"inner.yaml:1:8: {text}"]
    assert told(tmp_path, "include: {file: inner.yaml, args: {rate: 3.0}}\n", inner=inner) == [
        f"inner.yaml:1:8: {text}"
    ]


@pytest.mark.parametrize(
    "text",
    [
        "nodes: {/t: {class: a:T, params: {rate: $(var rate)}}}\n",
        "nodes: {/t: {class: a:T, params: {period: $(eval 1 / rate)}}}\n",
        "nodes: {/t: {class: a:T, if: $(eval rate < 5)}}\n",
        "nodes: {'/t$(eval int(rate))': {class: a:T}}\n",
        "templates: {t: {class: a:T, params: {rate: $(var rate)}}}\n" + NODE,
        "group: {if: false, nodes: {/t: {class: a:T, params: {rate: $(var rate)}}}}\n" + NODE,
        "steps: {s: {log: 'at $(var rate) Hz', after: /t}}\n" + NODE,
        "console: {windows: [{panes: [{log: /t, filter: 'x$(var rate)'}]}]}\n" + NODE,
        "include: {file: inner.yaml, args: {rate: $(var rate)}}\n",
        "include: inner.yaml\n",
        "include: {file: inner.yaml, if: false}\n" + NODE,
        "group: {if: false, include: inner.yaml}\n" + NODE,
        "for: {var: i, in: [], include: inner.yaml}\n" + NODE,
        "include: ros.launch.yaml\n",
        "nodes: {/t: {class: a:T, params: {file: $(substituted map.txt)}}}\n",
    ],
)
def test_uses(tmp_path: Path, text: str) -> None:
    """Any substitution is one, and one that cannot be seen may be."""
    (tmp_path / "map.txt").write_text("$(var rate)")
    (tmp_path / "ros.launch.yaml").write_text(
        "launch:\n- arg: {name: other, default: '1'}\n- executable: {cmd: 'true'}\n"
    )
    assert told(tmp_path, ARGS + text, inner=INNER) == []


def test_names_that_are_made(tmp_path: Path) -> None:
    """A name made by a substitution may be that of any argument."""
    args = "args: {side: {default: left}, left_speed: {default: 1.0}, right_speed: {default: 2.0}}\n"
    assert told(tmp_path, args + "nodes: {/t: {class: a:T, params: {v: $(var $(var side)_speed)}}}\n") == []


def test_a_variable_of_a_shell(tmp_path: Path) -> None:
    """It has a remark of its own."""
    [remark] = told(tmp_path, ARGS + "nodes: {/t: {class: a:T, params: {rate: '${rate}'}}}\n")
    assert "${rate} stays as it is" in remark


def test_an_argument_used_by_a_default(tmp_path: Path) -> None:
    """It is used by the argument whose default it makes, which may be unused itself."""
    args = "args: {a: {default: 1}, b: {default: $(var a)}}\n"
    [remark] = told(tmp_path, args + NODE)
    assert "the argument 'b'" in remark
