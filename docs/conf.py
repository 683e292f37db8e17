"""The documentation as a site: `python -m sphinx -W docs build/site` builds it and fails on a dead link.

The pages are the Markdown files beside this one. `site/` stands for the repository's own pages (the README, the change
log, what contributors read), which stay where repositories have them. `api/` is made from the docstrings, which are
Google's style in Markdown.
"""

from __future__ import annotations

import re
from importlib import metadata
from pathlib import Path

from pygments.lexers.special import TextLexer
from sphinx.application import Sphinx

ROOT = Path(__file__).parents[1]
REPOSITORY = {f"site/{name.lower()}": f"{name}.md" for name in ("README", "CHANGELOG", "CONTRIBUTING", "SECURITY")}
"""Pages of the site that are files of the repository."""
NAVIGATION = {
    "Start": ["README <site/readme>", "gallery"],
    "Concepts": [
        "nodes",
        "topics",
        "services",
        "parameters",
        "names",
        "graphs",
        "running",
        "console",
        "interfaces",
        "testing",
        "qos",
        "sim-time",
        "transforms",
        "simulator",
        "maps",
        "description",
        "network",
        "actions",
        "lifecycle",
        "composition",
        "bags",
        "viewers",
        "groups",
        "threads",
        "deployment",
        "notebooks",
    ],
    "ROS 2": ["coming-from-ros2", "rclpy", "ros2-cli", "ros2-acceptance"],
    "When something is wrong": ["symptoms", "errors", "mistakes"],
    "Reference": [
        "api/index",
        "api/nodes",
        "api/declarations",
        "api/handlers",
        "api/endpoints",
        "api/qos",
        "api/errors",
        "api/transforms",
        "api/simulator",
        "api/maps",
        "api/description",
        "api/testing",
        "api/bags",
        "api/views",
        "keys",
        "glossary",
    ],
    "Contributing": ["site/contributing", "architecture", "site/changelog", "site/security"],
}
"""The pages of the site in order, by the headings of its sidebar."""
SECTION = re.compile(r"(Args|Attributes|Returns|Yields|Raises|Source|Example|Examples|Note):\s*$")

project, author, copyright = "graphflow", "The graphflow developers", "The graphflow developers, Apache-2.0"  # noqa: A001
release = metadata.version("graphflow-zenoh")
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
root_doc = "index"
exclude_patterns = ["**/__pycache__"]
html_theme = "furo"
html_title = f"graphflow {release}"
default_role = "code"
myst_enable_extensions = ["html_image"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header"]
autodoc_default_options = {"members": True, "member-order": "bysource"}
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_preserve_defaults = True
napoleon_use_rtype = False


def rewrite_links(app: Sphinx, page: str, source: list[str]) -> None:
    """Fill in the repository's own pages, and lead links between them and `docs/` to each other."""
    text = source[0]
    if page in REPOSITORY:
        text = (ROOT / REPOSITORY[page]).read_text("utf-8")
        text = re.sub(r"(\]\(|src=\")docs/", r"\1../", text)
        text = re.sub(r"\[([^]]*)\]\(LICENSE\)", r"\1", text)
    if page == "index":
        entries = [":hidden:", ":caption: {}", ""]
        text += "".join(
            "\n```{toctree}\n" + "\n".join([*entries, *pages]).format(title) + "\n```\n"
            for title, pages in NAVIGATION.items()
        )
    up = "" if page in REPOSITORY else "site/"
    for other, file in REPOSITORY.items():
        name = up + other.removeprefix("site/") + ".md"
        text = re.sub(rf"\]\((?:\.\./)?{re.escape(file)}(?=[#)])", f"]({name}", text)
    source[0] = text


def mark_code(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Mark indented blocks of a docstring that belong to no section as Python code."""
    marked: list[str] = []
    in_section = in_code = False
    for i, line in enumerate(lines):
        if SECTION.match(line):
            in_section = True
        elif line and not line.startswith(" "):
            in_section = in_code = False
        if line.startswith("    ") and not in_section and not in_code and (i == 0 or not lines[i - 1].strip()):
            marked += [".. code-block:: python", ""]
            in_code = True
        marked.append(line)
    lines[:] = marked


def setup(app: Sphinx) -> None:
    """Connect the two functions above; the second runs before napoleon's. Definitions of interfaces have no lexer."""
    for language in ("msg", "srv", "action"):
        app.add_lexer(language, TextLexer)
    app.connect("source-read", rewrite_links)
    app.connect("autodoc-process-docstring", mark_code, priority=100)
