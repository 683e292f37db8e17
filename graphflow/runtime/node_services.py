"""Services of every ROS 2 node besides the parameters': type descriptions and logger levels.

Source: type_description_interfaces/srv/GetTypeDescription (REP-2016); rcl_interfaces/srv/GetLoggerLevels and
SetLoggerLevels.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from graphflow.errors import InterfaceError
from graphflow.msgs import registry
from graphflow.runtime.endpoints.endpoint import Endpoint
from graphflow.runtime.logs.logger import ROOT
from graphflow.runtime.logs.rosout import LEVELS
from graphflow.wire.schema import Field, Message
from graphflow.wire.typehash import referenced, type_id

if TYPE_CHECKING:
    from graphflow.msgs.rcl_interfaces import srv as rcl_srv
    from graphflow.msgs.type_description_interfaces import msg as description
    from graphflow.msgs.type_description_interfaces import srv


class TypeDescriptions:
    """Responses about the types of a node's own endpoints."""

    def __init__(self, endpoints: Callable[[], Iterable[Endpoint]]) -> None:
        self._endpoints = endpoints

    def get(self, request: srv.GetTypeDescription_Request) -> srv.GetTypeDescription_Response:
        from graphflow.msgs.type_description_interfaces.srv import GetTypeDescription

        def failed(reason: str) -> srv.GetTypeDescription_Response:
            return GetTypeDescription.Response(successful=False, failure_reason=reason)

        name = request.type_name
        if name not in {e.type_name for e in self._endpoints()}:
            return failed(f"this node uses no type {name!r}")
        try:
            digest = registry.hash_of(name)
        except InterfaceError as error:  # a recorder's type, which it passes on without knowing its definition
            return failed(str(error))
        if request.type_hash and request.type_hash != digest:
            return failed(f"this node's {name} has the hash {digest}, not {request.type_hash}")
        whole = registry.whole_schema(name)
        parts = referenced(whole, registry.message_schema)
        response = GetTypeDescription.Response(successful=True)
        response.type_description.type_description = _described(whole)
        response.type_description.referenced_type_descriptions = [_described(parts[n]) for n in sorted(parts)]
        if request.include_type_sources:
            response.type_sources = _sources([name, *sorted(parts)])
        return response


def _described(message: Message) -> description.IndividualTypeDescription:
    from graphflow.msgs.type_description_interfaces.msg import Field as FieldMessage
    from graphflow.msgs.type_description_interfaces.msg import FieldType, IndividualTypeDescription

    def described(field: Field) -> description.Field:
        kind = FieldType(
            type_id=type_id(field.type),
            capacity=field.type.size,
            string_capacity=field.type.string_bound,
            nested_type_name="" if field.type.is_primitive else field.type.base,
        )
        default = "" if field.default is None else str(field.default)
        return FieldMessage(name=field.name, type=kind, default_value=default)

    return IndividualTypeDescription(type_name=message.name, fields=[described(f) for f in message.fields])


def _sources(names: Iterable[str]) -> list[description.TypeSource]:
    """Return the text of definition files; derived types have none and are `implicit`."""
    from graphflow.msgs.type_description_interfaces.msg import TypeSource

    sources = []
    for name in names:
        try:
            text = registry.definition(name)
            source = TypeSource(type_name=name, encoding=name.split("/")[1], raw_file_contents=text)
        except InterfaceError:
            source = TypeSource(type_name=name, encoding="implicit")
        sources.append(source)
    return sources


_ROS_LEVELS = {number: python for python, number in LEVELS.items()}


class LoggerLevels:
    """Access to the levels of a node's logger, by its ROS name, and of those below it."""

    def __init__(self, own: logging.Logger) -> None:
        self._own = own.name.removeprefix(f"{ROOT}.")

    def _logger(self, name: str) -> logging.Logger | None:
        is_ours = name == self._own or name.startswith(f"{self._own}.")
        return logging.getLogger(f"{ROOT}.{name}") if is_ours else None

    def get(self, request: rcl_srv.GetLoggerLevels_Request) -> rcl_srv.GetLoggerLevels_Response:
        from graphflow.msgs.rcl_interfaces.msg import LoggerLevel
        from graphflow.msgs.rcl_interfaces.srv import GetLoggerLevels

        levels = []
        for name in request.names:
            logger = self._logger(name)
            level = 0 if logger is None else LEVELS.get(logger.getEffectiveLevel(), 0)
            levels.append(LoggerLevel(name=name, level=level))
        return GetLoggerLevels.Response(levels=levels)

    def set(self, request: rcl_srv.SetLoggerLevels_Request) -> rcl_srv.SetLoggerLevels_Response:
        from graphflow.msgs.rcl_interfaces.msg import SetLoggerLevelsResult
        from graphflow.msgs.rcl_interfaces.srv import SetLoggerLevels

        results = []
        for wanted in request.levels:
            logger, reason = self._logger(wanted.name), ""
            if logger is None:
                reason = f"{wanted.name!r} is not a logger of this node; its own is {self._own!r}"
            elif wanted.level not in (0, *_ROS_LEVELS):
                reason = f"{wanted.level} is not a level; use 10 debug, 20 info, 30 warn, 40 error, 50 fatal, 0 unset"
            else:
                logger.setLevel(_ROS_LEVELS.get(wanted.level, logging.NOTSET))
            results.append(SetLoggerLevelsResult(successful=not reason, reason=reason))
        return SetLoggerLevels.Response(results=results)
