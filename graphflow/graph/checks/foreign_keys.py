"""Keys of other tools, of ROS's launch files, docker-compose and ROS 1, with the equivalents in graph files."""

from __future__ import annotations

from collections.abc import Collection

_IN_A_NAMESPACE = (
    "the namespace is part of the node's name, as in /robot1/talker, or stands in a group: namespace: robot1"
)
_CONTAINED = "leave it out: a node runs on this machine, and in no container"
_PROGRAM = "a program is a node: nodes: {NAME: {command: [PROGRAM, WORD]}}; a step comes after it by after: NAME"
_OF_NODES = {
    "package": ("pkg", ""),
    "executable": ("exec", ""),
    "parameters": ("params", ""),
    "remappings": ("remap", ""),
    "arguments": ("args", ""),
    "respawn": ("restart", "write restart: always"),
    "respawn_delay": ("restart", "write restart: {policy: always, delay: SECONDS}"),
    "output": ("pkg", "what any node prints is logged and shown"),
    "name": ("pkg", "a node is called as its key"),
    "ns": ("pkg", _IN_A_NAMESPACE),
    "namespace": ("pkg", _IN_A_NAMESPACE),
    "required": ("critical", ""),
    "delay": ("exec", "a step waits: steps: {soon: {delay: 2.0}}, and after: soon at the node"),
    "launch-prefix": ("prefix", ""),
    "condition": ("if", ""),
    "when": ("if", ""),
    **dict.fromkeys(("enabled", "enable", "disabled", "disable"), ("if", "if: false leaves out a node")),
    "plugin": ("class", ""),
    "node": ("class", ""),
    "env_vars": ("env", ""),
    "env-vars": ("env", ""),
    "type": ("exec", "it is called 'exec' here, beside pkg:; a class of Python is written class: package.module:Class"),
}
_OF_COMPOSE = {
    "services": ("nodes", ""),
    "version": ("nodes", "leave it out"),
    "depends_on": ("after", ""),
    "environment": ("env", ""),
    "env_file": ("env", "write the variables: env: {NAME: VALUE}"),
    "entrypoint": ("command", ""),
    "cmd": ("command", ""),
    "image": ("command", "no container is made: write class:, or command: [docker, run, IMAGE]"),
    "build": ("command", "nothing is built: write class:, or command: [docker, run, IMAGE]"),
    **dict.fromkeys(
        ("ports", "expose", "volumes", "networks", "network_mode", "container_name", "hostname", "privileged", "tty"),
        ("command", _CONTAINED),
    ),
    **dict.fromkeys(("working_dir", "cwd"), ("command", "write command: [sh, -c, cd FOLDER && PROGRAM]")),
}
_OF_OTHERS = {
    "ns": ("namespace", ""),
    "description": ("doc", ""),
    "help": ("doc", ""),
    "value": ("default", ""),
    **dict.fromkeys(
        ("params", "params_file", "remap", "log_level", "restart"),
        ("file", "a node of the file is changed by override: {NODE: {params: {rate: 5.0}}}"),
    ),
    "choice": ("choices", ""),
    "service": ("call", ""),
    "action": ("goal", ""),
    "sleep": ("delay", ""),
    "message": ("log", ""),
    **dict.fromkeys(("command", "run", "exec"), ("call", _PROGRAM)),
}
"""Keys of groups, arguments, steps and includes."""


def correction(key: str, known: Collection[str]) -> str:
    """Return the correction of a key of another tool; empty for other keys.

    Args:
        known: The valid keys.
    """
    for table in (_OF_NODES, _OF_COMPOSE, _OF_OTHERS):
        ours, why = table.get(key, ("", ""))
        if ours in known:
            return why or f"it is called {ours!r} here"
    return ""
