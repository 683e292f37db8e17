"""The JSON Schema of graph files, generated from the models for use in editors."""

from __future__ import annotations

import json
from typing import Any

from pydantic.json_schema import GenerateJsonSchema

from graphflow.graph.model import FROM_GROUPS, GraphFile, NodeSpec, keys_of
from graphflow.machines.restarts import POLICIES

_SUBSTITUTION = {"type": "string", "pattern": r"\$\("}
"""A text with a substitution, which may replace any value."""


class _Written(GenerateJsonSchema):
    """The generator of the schema of files as written: with substitutions, and with the short forms of blocks."""

    def int_schema(self, schema: Any) -> dict[str, Any]:
        return {"anyOf": [super().int_schema(schema), _SUBSTITUTION]}

    def float_schema(self, schema: Any) -> dict[str, Any]:
        return {"anyOf": [super().float_schema(schema), _SUBSTITUTION]}

    def bool_schema(self, schema: Any) -> dict[str, Any]:
        return {"anyOf": [super().bool_schema(schema), _SUBSTITUTION]}


_SHORT: dict[str, Any] = {
    "IncludeBlock": {"type": "string"},
    "RestartSpec": {"anyOf": [{"enum": list(POLICIES)}, _SUBSTITUTION]},
    "GroupSpec": {"type": ["string", "array"]},
}
"""The short forms of blocks, by model."""


def graph_schema() -> dict[str, Any]:
    """Return the schema, in draft 2020-12."""
    schema: dict[str, Any] = GraphFile.model_json_schema(schema_generator=_Written)
    definitions = schema["$defs"]
    node = definitions["NodeSpec"]
    for key in [key for key in node["properties"] if key.endswith(FROM_GROUPS)]:
        del node["properties"][key]
    node["required"] = []  # a class, a command or a template
    for model in definitions.values():  # a key without a value counts as absent
        for name, described in model.get("properties", {}).items():
            if name not in model.get("required", ()):
                model["properties"][name] = {"anyOf": [described, {"type": "null"}]}
    definitions["GroupBlock"]["properties"]["nodes"] = {"$ref": "#/properties/nodes"}
    definitions["ForBlock"]["properties"]["nodes"] = {"$ref": "#/properties/nodes"}
    for key in ("group", "for", "include"):
        for model in ("GroupBlock", "ForBlock"):
            definitions[model]["properties"][key] = {"$ref": f"#/properties/{key}"}
    schema["properties"]["templates"]["additionalProperties"] = {"$ref": "#/$defs/NodeSpec"}
    for name, short in _SHORT.items():
        definitions[f"{name}Long"] = definitions[name]
        definitions[name] = {"anyOf": [short, {"$ref": f"#/$defs/{name}Long"}]}
    assert set(node["properties"]) == set(keys_of(NodeSpec))
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "A graph file of graphflow"}
    return {**schema, **head}


def schema_text() -> str:
    """Return the schema as text, as it is saved beside graph files."""
    return json.dumps(graph_schema(), indent=2) + "\n"
