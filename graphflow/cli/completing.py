"""Completions for a shell: verbs, options, live names, types, and messages to fill in."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import click

from graphflow.errors import GraphflowError

_PLAIN = re.compile(r"[\w/.~-]+", re.ASCII)
"""A name without a character that is special to a shell."""
NAMES = ("NODE", "NODES", "TOPIC", "TOPICS", "SERVICE", "ACTION")
LIVE = (*NAMES, "TYPE", "PARAMETER", "PARAMETERS")
"""Arguments that are completed from the running graph."""
PACKAGED = ("executables", "prefix", "xml")
"""Verbs of `pkg` that take one package."""
ANSWER_LIMIT = 1.0
"""Seconds that a node has to list its parameters."""


def choices(words: Sequence[str], partial: str) -> list[str]:
    """Return the completions of a word.

    Args:
        words: The words before it, without `graphflow`.
        partial: Its beginning. If that is a quotation mark, messages are quoted with the same mark.
    """
    command, context, rest = _command(words)
    if isinstance(command, click.Group):
        names = command.list_commands(context)
        found: Iterable[str] = [] if rest else [n for n in names if not _is_hidden(command, context, n)]
        found = {*found, *(_launched_by(rest) if command.name == "launch" else ())}
        return sorted(name for name in found if name.startswith(partial))
    if partial.startswith("-"):
        return sorted(option for option in _options(command) if option.startswith(partial))
    what, given = _expected(command, rest)
    if (command.name, len(given)) in (("run", 0), ("run", 1)) or (what == "PACKAGE" and command.name in PACKAGED):
        return sorted(name for name in _started_by(given, command.name) if name.startswith(partial))
    if what.startswith("GRAPH.yaml") and not given:
        return sorted(n for n in {*_graphs(), *_files(partial)} if n.startswith(partial) and _PLAIN.fullmatch(n))
    mark = partial[:1] if partial[:1] in ("'", '"') else ""
    try:
        found = _names_for(what, given, mark or "'")
    except GraphflowError:  # no graph is running or reachable, so there are no names to offer
        found = []
    return sorted({name for name in found if name.startswith(partial)})


def _command(words: Sequence[str]) -> tuple[click.Command, click.Context, list[str]]:
    """Return the command that some words name, and the remaining words."""
    from graphflow.cli.main import cli

    command: click.Command = cli
    context = click.Context(cli)
    rest = list(words)
    while isinstance(command, click.Group) and rest:
        if rest[0].startswith("-"):
            rest = rest[2:] if rest[0] in _valued(command) else rest[1:]
            continue
        inner = command.get_command(context, rest[0])
        if inner is None:
            break
        command, rest = inner, rest[1:]
    return command, context, rest


def _is_hidden(group: click.Group, context: click.Context, name: str) -> bool:
    from graphflow.cli.main import cli

    return False if group is cli else bool(getattr(group.get_command(context, name), "hidden", False))


def _options(command: click.Command) -> list[str]:
    options = [p for p in command.params if isinstance(p, click.Option) and not p.hidden]
    return ["--help", *(word for option in options for word in option.opts if word.startswith("--"))]


def _valued(command: click.Command) -> set[str]:
    options = [p for p in command.params if isinstance(p, click.Option) and not p.is_flag and not p.count]
    return {word for option in options for word in option.opts}


def _expected(command: click.Command, words: Sequence[str]) -> tuple[str, list[str]]:
    """Return the argument or `--option` that the next word fills, or an empty text; and the arguments so far."""
    valued, given, owner = _valued(command), list[str](), ""
    for word in words:
        if owner:
            owner = ""
        elif word in valued:
            owner = word
        elif not word.startswith("-"):
            given.append(word)
    if owner:
        return owner, given
    arguments = [p for p in command.params if isinstance(p, click.Argument)]
    if not arguments or (len(given) >= len(arguments) and arguments[-1].nargs == 1):
        return "", given
    argument = arguments[min(len(given), len(arguments) - 1)]
    return argument.make_metavar(click.Context(command)).strip("[].").removesuffix("]...").rstrip("."), given


def _names_for(place: str, given: Sequence[str], mark: str) -> Iterable[str]:
    from graphflow.domain import domain_id
    from graphflow.introspect import completions
    from graphflow.introspect.graph_view import View

    word = re.sub(r"^-*(\w*).*", r"\1", place.upper())
    if word not in LIVE and word not in completions.MESSAGES:
        return ()
    if word not in NAMES:
        from graphflow.cli.messages.types import use_project

        use_project()
    if word in completions.MESSAGES:
        return completions.message(given[1], mark) if len(given) >= 2 else ()
    if word == "TYPE" and not given:
        return _types()
    with View(domain_id()) as view:
        if word in ("PARAMETER", "PARAMETERS") and given:
            from graphflow.introspect.parameters import RemoteParameters

            found = RemoteParameters(view, view.node(given[0]), ANSWER_LIMIT).names()
        else:
            found = completions.names_for(word, given, view.cache)
    # The names come from other processes, and the shell evaluates them: offer none with characters special to it.
    plain = [name for name in found if _PLAIN.fullmatch(name)]
    return _types() if word == "TYPE" and not plain else plain


def _started_by(given: Sequence[str], verb: str | None) -> set[str]:
    """Return the packages that have executables or, given a package, its executables; for `run`, nodes by name, too."""
    from graphflow.workspace.executables import all_executables, project_packages
    from graphflow.workspace.project import project_root

    root = project_root(Path.cwd())
    rows = all_executables(root)
    if given:
        return {row.name for row in rows if row.package == given[0]}
    own = {*project_packages(root)} if verb == "run" else set[str]()
    return {row.package for row in rows} | {row.name for row in rows if row.package in own}


def _launched_by(given: Sequence[str]) -> set[str]:
    """Return the packages that have launch files or, given a package, its launch files."""
    from graphflow.cli.ros.launch import launch_files
    from graphflow.workspace.packages import bundled, find_workspace

    if given:
        return set() if len(given) > 1 else {*launch_files(given[0])}
    packages = {*find_workspace(Path.cwd()).packages, *bundled().packages}
    return {name for name in packages if launch_files(name)}


def _graphs() -> set[str]:
    """Return the names of the graphs that `up` finds without a path."""
    from graphflow.workspace import installed
    from graphflow.workspace.project import bundled_graphs, project_root

    own = {file.stem for file in (project_root(Path.cwd()) / "graphs").glob("*.yaml")}
    return {*own, *installed.graphs(), *bundled_graphs()}


def _files(partial: str) -> Iterator[str]:
    """Yield the graph files, and the folders that may have some, whose path begins so."""
    head, slash, _ = partial.rpartition("/")
    for entry in Path(head + slash).glob("*"):
        if entry.suffix in (".yaml", ".yml") or entry.is_dir():
            yield f"{head}{slash}{entry.name}{'/' if entry.is_dir() else ''}"


def _types() -> list[str]:
    """Return the names of all installed types."""
    from graphflow.msgs import registry

    kinds = registry.KINDS
    return [f"{p}/{kind}/{n}" for p in registry.packages() for kind in kinds for n in registry.names_in(p, kind)]


SCRIPTS = {
    "bash": """\
_graphflow() {
    local - IFS=$'\\n' line="${COMP_LINE:0:COMP_POINT}"
    set -f
    COMPREPLY=($(graphflow completion words -- "$line" 2>/dev/null))
    local word="${line##*[[:space:]]}" cut="${COMP_WORDS[COMP_CWORD]}"
    # bash splits words at colons, and expects only the part after the last one
    if [[ "$word" == *:* && "$word" != [\\'\\"]* && "$cut" != "$word" ]]; then
        local head="${word%"${word##*:}"}"
        COMPREPLY=("${COMPREPLY[@]#"$head"}")
    fi
}
complete -o default -F _graphflow graphflow gf
""",
    "zsh": """\
#compdef graphflow gf
_graphflow() {
    local -a found
    # zsh removes an opening quotation mark from the line, and adds both marks to each completion
    found=("${(@f)$(graphflow completion words -- "${LBUFFER%$PREFIX}$QIPREFIX$PREFIX" 2>/dev/null)}")
    [[ -n "$QIPREFIX" ]] && found=("${(@)${(@)found#$QIPREFIX}%$QIPREFIX}")
    [[ -n "$found" ]] && compadd -Q -U -- $found || _files
}
(( $+functions[compdef] )) || { autoload -Uz compinit && compinit }
compdef _graphflow graphflow gf
""",
    "fish": """\
function __graphflow
    graphflow completion words -- (commandline -cp) 2>/dev/null
end
complete -c graphflow -f -a '(__graphflow)'
complete -c gf -f -a '(__graphflow)'
""",
}
"""Completion scripts, by shell; each calls `graphflow completion words`."""
