"""The site: everything public, every page and every graph has its place on it. CI builds it strictly."""

from __future__ import annotations

import ast
import re

import graphflow
import graphflow.bag
import graphflow.description
import graphflow.maps
import graphflow.simulator
import graphflow.testing
import graphflow.tf
import graphflow.tui
from tests.conftest import PROJECT

DOCS = PROJECT / "docs"


def test_everything_public_is_in_the_reference_once() -> None:
    """Each public name of each public package, and nothing else."""
    text = "".join(page.read_text("utf-8") for page in DOCS.glob("api/*.md"))
    found = re.findall(r"^\.\. auto(?:class|function|exception):: ([\w.]+)$", text, re.MULTILINE)
    public = [
        f"{package.__name__}.{name}"
        for package in (
            graphflow,
            graphflow.bag,
            graphflow.description,
            graphflow.maps,
            graphflow.simulator,
            graphflow.testing,
            graphflow.tf,
            graphflow.tui,
        )
        for name in package.__all__
    ]
    assert sorted(found) == sorted(set(public) - {"graphflow.__version__"})


def test_every_page_is_in_the_sidebar() -> None:
    """Once."""
    [pages] = [
        ast.literal_eval(node.value)
        for node in ast.parse((DOCS / "conf.py").read_text("utf-8")).body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "NAVIGATION"
    ]
    listed = [entry.split("<")[-1].rstrip(">") for entries in pages.values() for entry in entries]
    there = [page.relative_to(DOCS).with_suffix("").as_posix() for page in DOCS.rglob("*.md")]
    assert sorted(listed) == sorted(set(there) - {"index"})


def test_every_graph_is_in_the_gallery() -> None:
    """Under a heading of its own, with a picture."""
    text = (DOCS / "gallery.md").read_text("utf-8")
    assert [g.stem for g in PROJECT.glob("graphs/*.yaml") if f"`graphflow up {g.stem}" not in text] == []
    pictures = re.findall(r'src="([\w/.-]+)"', text)
    assert all((DOCS / picture).is_file() for picture in pictures)
