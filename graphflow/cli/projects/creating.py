"""`graphflow pkg create`: a package as `ros2 pkg create` writes it, or a starter project of graphflow's own."""

from __future__ import annotations

import getpass
import os
import subprocess
from collections.abc import Mapping
from keyword import iskeyword
from pathlib import Path
from typing import Any

import click

from graphflow.cli import output
from graphflow.cli.projects.new_names import (
    check_dependencies,
    check_package,
    known_dependency,
    near_name,
    tell_name,
    tell_place,
)
from graphflow.cli.projects.ros_package import BUILD_TYPES, TEMPLATES, Description, known_licenses, license_text, parts
from graphflow.errors import UsageFault


class _Create(click.Command):
    """A command whose option `--dependencies` takes every word up to the next option, as ROS 2's does."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        words, is_list = list[str](), False
        for word in args:
            if word.startswith("-"):
                is_list = word == "--dependencies"
                words += [] if is_list else [word]
            else:
                words += ["--dependencies", word] if is_list else [word]
        ctx.allow_extra_args = True
        left = super().parse_args(ctx, words)
        if left and not ctx.resilient_parsing:
            name = ctx.params["name"]
            if all(map(known_dependency, left)):
                ctx.fail(f"write graphflow pkg create {name} --dependencies {' '.join(left)}")
            one = near_name("_".join([name, *left]))
            ctx.fail(f"a name is one word, such as {one}; packages that it needs stand behind --dependencies")
        return left


@click.command(cls=_Create)
@click.argument("name", default="")
@click.option("--destination-directory", type=click.Path(path_type=Path), default=Path(), help="Where to make it. [.]")
@click.option("--build-type", type=click.Choice(BUILD_TYPES), help="Write a package of ROS 2's, for this build tool.")
@click.option("--template", "--template-name", type=click.Choice(list(TEMPLATES)), help="Its files, if not the usual.")
@click.option("--node-name", help="A first executable.")
@click.option("--library-name", help="A first library.")
@click.option("--dependencies", multiple=True, metavar="PACKAGE...", help="Packages that it needs.")
@click.option("--package-format", type=click.Choice(("2", "3")), help="Of package.xml. [3]")
@click.option("--description", help="For package.xml.")
@click.option("--license", help="For package.xml; the text of a known one is written, too. ? lists those.")
@click.option("--maintainer-name", help="For package.xml.")
@click.option("--maintainer-email", help="For package.xml.")
def create(name: str, destination_directory: Path, build_type: str | None, template: str | None, **given: Any) -> None:
    """Write a package of ROS 2's with --build-type, or else a starter project, as `graphflow init NAME` does."""
    if given["license"] == "?":
        output.lines(["Supported licenses:", *known_licenses()])
        return
    if not name:
        taken = given["dependencies"]
        why = ": --dependencies takes the words behind it" if taken else ": graphflow pkg create NAME"
        raise UsageFault(f"the package's name is missing; write it first{why}")
    settings = {option: value for option, value in given.items() if value}
    if build_type or template:
        _ros_package(name, destination_directory, build_type, template, settings)
    else:
        _project(name, destination_directory, settings)


def _project(name: str, destination: Path, unused: Mapping[str, object]) -> None:
    from graphflow.cli.projects.init import check_new, written

    folder = destination / name
    check_new(folder)
    _tell_of_new(name, destination)
    output.data(f"creating folder {_joined(destination, name)}")
    output.lines(f"creating {_joined(destination, file.relative_to(destination))}" for file in written(folder))
    if unused:
        options = ", ".join(f"--{option.replace('_', '-')}" for option in unused)
        output.talk(f"note: {options}: not used by a project of graphflow's; --build-type makes a package of ROS 2's")
    output.talk(f"next:\n  cd {folder}\n  graphflow up graphs/{folder.name}.yaml")


def _ros_package(
    name: str, destination: Path, build_type: str | None, template: str | None, settings: dict[str, Any]
) -> None:
    new = _described(name, build_type, template, settings)
    folder = destination / name
    if folder.exists():
        raise UsageFault(f"{folder} already exists; choose another name or remove it")
    check_package(name, folder)
    check_dependencies(settings.get("dependencies", ()), folder)
    _tell_of_new(name, destination)
    output.lines(new.lines())
    output.data(f"creating folder {_joined(destination, name)}")
    for path, text in parts(new):
        file = folder / path
        (file if text is None else file.parent).mkdir(parents=True, exist_ok=True)
        output.data(f"creating {'folder ' if text is None else ''}{_joined(destination, name, path)}")
        if text is not None:
            file.write_text(text, encoding="utf-8")
        if path == "package.xml":
            output.data(f"creating source {'folder' if new.build_type == 'ament_python' else 'and include folder'}")
    text = license_text(new.license)
    if text is not None:
        (folder / "LICENSE").write_text(text, encoding="utf-8")
    else:
        known = ", ".join(known_licenses())
        output.talk(f"note: no LICENSE file is written for {new.license!r}; those with --license: {known}")
    tell_name(name)
    tell_place(folder)
    output.talk(f"next:\n  {_next(new, folder)}")


def _described(name: str, build_type: str | None, template: str | None, settings: dict[str, Any]) -> Description:
    """The settings of a new package, with what ROS 2 puts where one is not given.

    Raises:
        UsageFault: A name cannot be one of a module, or the template is one of another build type.
    """
    template = template or build_type or ""
    if build_type not in (None, TEMPLATES[template]):
        raise UsageFault(f"the template {template} is one of --build-type {TEMPLATES[template]}")
    node, library = settings.get("node_name"), settings.get("library_name")
    for what, word in {"package": name, "node": node, "library": library}.items():
        if word is not None and not (word.isidentifier() and word.isascii() and not iskeyword(word)):
            rule = "use letters, digits and _, begin with a letter, and take no keyword of Python's"
            raise UsageFault(f"{word!r} is no name of a {what}: {rule}; did you mean {near_name(word)!r}?")
    if name == "test" and TEMPLATES[template] == "ament_python":
        raise UsageFault("a Python package cannot be called 'test', as the folder of its tests is; choose another name")
    if node is not None and node == library:
        settings["node_name"] = f"{node}_node"
        output.talk(f"note: the library is called {library!r}, so that the node becomes {settings['node_name']!r}")
    settings["package_format"] = int(settings.get("package_format", 3))
    person = settings.setdefault("maintainer_name", _user())
    settings.setdefault("maintainer_email", _email() or f"{person}@todo.todo")
    return Description(name=name, template=template, **settings)


def _user() -> str:
    try:
        return getpass.getuser()
    except (OSError, KeyError):  # this user has no entry in the system's list; the error is another one from 3.13 on
        return "user"


def _email() -> str:
    """The address that git has for the user; empty where there is none."""
    try:
        words = ["git", "config", "user.email"]
        return subprocess.run(words, capture_output=True, text=True, timeout=5, check=False).stdout.strip()
    except (OSError, subprocess.TimeoutExpired):
        return ""


def _next(new: Description, folder: Path) -> str:
    """The command or the file with which to go on."""
    if new.build_type != "ament_python":
        return "colcon builds C++; graphflow runs the Python programs that CMakeLists.txt installs below lib/"
    if new.node_name:
        return f"graphflow run {new.name} {new.node_name}"
    return f"write a module in {folder / new.name}, and name its function in console_scripts of {folder / 'setup.py'}"


def _tell_of_new(name: str, destination: Path) -> None:
    output.data("going to create a new package")
    output.data(f"package name: {name}")
    output.data(f"destination directory: {destination.resolve()}")


def _joined(*parts: Path | str) -> str:
    """A path as ROS 2 tells it: `./my_package`, `src/my_package`."""
    return os.path.join(*map(str, parts))
