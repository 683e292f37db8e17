"""A node's parameters: typed values with limits, checks before each change and observers after it.

Source: rclpy's rules for declared parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple, NoReturn

from graphflow.errors import ParameterError
from graphflow.interface import Parameter
from graphflow.names import did_you_mean
from graphflow.runtime.declarations.checks import positional
from graphflow.runtime.node_arguments import instead_of


class ParameterChange(NamedTuple):
    """A change of a parameter; `old` or `new` is None where the parameter did not exist or was deleted."""

    old: Any
    new: Any


Check = Callable[[Mapping[str, Any]], None]
Observer = Callable[[Mapping[str, ParameterChange]], None]


class Parameters:
    """The parameters of one node.

    Args:
        overrides: Values from a graph file or the command line: name to (value, place that gives it).
    """

    def __init__(self, overrides: Mapping[str, tuple[object, str]] | None = None) -> None:
        self._declared: dict[str, Parameter] = {}
        self._values: dict[str, Any] = {}
        self._sources: dict[str, str] = {}
        self._overrides = dict(overrides or {})
        self._checks: list[Check] = []
        self._observers: list[Observer] = []

    def declare(self, parameter: Parameter) -> Any:
        """Add a parameter; returns its value: the override if there is one, else the default.

        Raises:
            ParameterError: The parameter is already declared, or the override does not fit.
        """
        if parameter.name in self._declared:
            raise ParameterError(f"parameter {parameter.name!r} is declared twice")
        if parameter.name in self._overrides:
            raw, source = self._overrides[parameter.name]
            try:
                value = parameter.fit(raw)
            except ParameterError as error:
                raise ParameterError(f"{error} (from {source})") from None
        else:
            value, source = parameter.fit(parameter.default), "default"
        self._declared[parameter.name] = parameter
        self._values[parameter.name], self._sources[parameter.name] = value, source
        self._notify({parameter.name: ParameterChange(None, value)})
        return value

    def undeclare(self, name: str) -> None:
        """Remove a parameter.

        Raises:
            ParameterError: There is no parameter of that name, or it is read-only.
        """
        if self.describe(name).read_only:
            raise ParameterError(f"parameter {name!r} is read-only")
        value = self._values.pop(name)
        del self._declared[name], self._sources[name]
        self._notify({name: ParameterChange(value, None)})

    def unused_overrides(self, owner: type = object) -> list[str]:
        """Return a sentence for each override that matches no declared parameter.

        Args:
            owner: The node's class; the sentence mentions its plain attributes.
        """

        def hint(name: str, given: object, source: str) -> str:
            if source == "argument" and (way := instead_of(name, given)):
                return f"; {way}"
            value = getattr(owner, name, None)
            is_plain = isinstance(value, (bool, int, float, str))
            return f"; write {name} = Param({value!r})" if is_plain else did_you_mean(name, self._declared)

        return [
            f"there is no parameter {name!r} (from {source}){hint(name, given, source)}"
            for name, (given, source) in self._overrides.items()
            if name not in self._declared
        ]

    def __getitem__(self, name: str) -> NoReturn:
        """Raise TypeError with the correct way to read a value."""
        raise TypeError(f'read a value with parameters.get("{name}"), or self.{name} where the class declares it')

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def __contains__(self, name: object) -> bool:
        return name in self._declared

    def names(self) -> list[str]:
        return sorted(self._declared)

    def get(self, name: str) -> Any:
        """Return a parameter's value.

        Raises:
            ParameterError: There is no parameter of that name; the text suggests the nearest one.
        """
        if name not in self._values:
            raise ParameterError(f"there is no parameter {name!r}{did_you_mean(name, self._declared)}")
        return self._values[name]

    def source(self, name: str) -> str:
        """Return the origin of a value: `default`, a file and line, `command line` or `set`."""
        return self._sources[name]

    def describe(self, name: str) -> Parameter:
        """Return a parameter's declaration. Raises ParameterError as `get` does."""
        self.get(name)
        return self._declared[name]

    def set(self, values: Mapping[str, object], source: str = "set") -> None:
        """Set parameters, all or none. None deletes one that was declared with dynamic typing.

        Raises:
            ParameterError: A parameter is unknown or read-only, or a value has another type, is out of range or is
                refused by a check. Nothing was changed.
        """
        if not isinstance(values, Mapping):
            raise ParameterError(
                f'parameters are set by a dict of values: parameters.set({{"rate": 2.0}}), not {values!r}'
            )
        fitted = {}
        for name, value in values.items():
            declared = self.describe(name)
            if declared.read_only:
                raise ParameterError(f"parameter {name!r} is read-only")
            if value is None and not declared.dynamic:
                raise ParameterError(
                    f"parameter {name!r} belongs to the node and cannot be deleted; only those with dynamic typing can"
                )
            fitted[name] = declared.fit(value)
        for check in self._checks:
            check(fitted)
        changes = {name: ParameterChange(self._values[name], value) for name, value in fitted.items()}
        for name, value in fitted.items():
            if value is None:
                del self._values[name], self._sources[name], self._declared[name]
            else:
                self._values[name], self._sources[name] = value, source
        self._notify(changes)

    def check(self, check: Check) -> None:
        """Call `check(values)` before each change; its ParameterError refuses all the values."""
        self._checks.append(check)

    def observe(self, observer: Observer) -> None:
        """Call `observer(changes)`, changes by name, after each change, declaration or deletion.

        Raises:
            TypeError: It takes other arguments.
        """
        takes = positional(observer)
        if takes is not None and not len(takes[0]) <= 1 <= takes[1]:
            way = "def changed(self, changes): for name, (old, new) in changes.items(): ..."
            raise TypeError(f"observe calls it with one argument, a dict of changes by name: {way}")
        self._observers.append(observer)

    def _notify(self, changes: Mapping[str, ParameterChange]) -> None:
        for observer in self._observers:
            observer(changes)
