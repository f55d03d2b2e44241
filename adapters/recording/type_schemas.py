"""JSON schemas of recorded values, generated from the fields and the docstrings of their types."""

from __future__ import annotations

import inspect
import re
from collections.abc import Collection
from typing import Any, Final

from msgspec.json import schema_components

Schema = dict[str, Any]

RING: Final[Schema] = {
    "type": "array",
    "description": "Latitude and longitude of each vertex in 1e-7 degree; one vertex for a point.",
    "items": {"type": "array", "items": {"type": "integer"}, "minItems": 2, "maxItems": 2},
}
BAND: Final[Schema] = {
    "type": "array",
    "items": {"type": "number"},
    "minItems": 2,
    "maxItems": 2,
    "description": "Lowest and highest, metres above sea level.",
}

FORMS: Final[dict[str, Schema]] = {"Geometry": RING, "Band": BAND}
"""The recorded forms of values that are not objects."""

NAMES: Final = {"place": "ring"}
"""The members whose names are not those of their fields."""


def members_of(*kinds: type, without: Collection[str] = (), nulls: bool = False) -> dict[str, Schema]:
    """Return the schemas of the members of values of some types, by name, but for some fields.

    A member has a description if all types with the member agree on it. With `nulls`, a value without some member has
    null there; else it lacks the member.
    """
    found: dict[str, Schema] = {}
    for kind in kinds:
        for name, schema in _members(kind, without, nulls=nulls).items():
            known = found.setdefault(name, schema)
            if known.get("description") != schema.get("description"):
                found[name] = {part: each for part, each in known.items() if part != "description"}
    return found


def _members(kind: type, without: Collection[str], *, nulls: bool) -> dict[str, Schema]:
    _, defs = schema_components([kind], ref_template="{name}")
    told = descriptions(kind)
    return {
        NAMES.get(name, name): _plain(schema, defs, nulls=nulls)
        | ({"description": told[name]} if name in told and name not in NAMES else {})
        for name, schema in defs[kind.__name__]["properties"].items()
        if name not in without
    }


def _plain(schema: Schema, defs: dict[str, Schema], *, nulls: bool) -> Schema:
    """Return a generated schema without references, alternatives and defaults."""
    match schema:
        case {"$ref": name} if name in FORMS:
            return FORMS[name]
        case {"$ref": name}:
            parts = defs[name]["properties"].items()
            inner = {part: _plain(each, defs, nulls=nulls) for part, each in parts}
            return {"type": "object", "required": [*inner], "properties": inner}
        case {"anyOf": [one, {"type": "null"}]}:
            found = _plain(one, defs, nulls=nulls)
            return {**found, "type": [found["type"], "null"]} if nulls else found
        case {"prefixItems": [one, *_] as all_items}:
            count = len(all_items)
            return {"type": "array", "items": one, "minItems": count, "maxItems": count}
        case {"items": items}:
            return {"type": "array", "items": _plain(items, defs, nulls=nulls)}
    return {name: part for name, part in schema.items() if name != "default"}


def descriptions(kind: type) -> dict[str, str]:
    """Return the descriptions of fields in the docstring of a type, each its first sentence."""
    _, _, told = (inspect.getdoc(kind) or "").partition("Attributes:\n")
    found = re.findall(r"^    (\w+): (.+(?:\n        .+)*)", told, re.MULTILINE)
    texts = {name: " ".join(text.split()).replace("None", "null") for name, text in found}
    return {name: re.sub(r"(?<=\.) .*", "", text) for name, text in texts.items()}
