"""Views: the state that a console shows at one moment, and the difference between two of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

Json = Any
"""A JSON value."""

Section = Mapping[str, Json]
"""Values by their keys; a value is replaced as a whole and never changed in place."""


@dataclass(frozen=True, slots=True)
class View:
    """All sections of the protocol's state (docs/reference/console.md), by their names."""

    sections: Mapping[str, Section]


NOTHING: Final = View({})
"""The view before the first frame."""


def difference(before: View, after: View) -> tuple[dict[str, dict[str, Json]], dict[str, list[str]]]:
    """Return the values to set and the keys to remove, by section; identical objects are not compared further.

    >>> difference(View({"a": {"x": 1, "y": 2}}), View({"a": {"y": 3}}))
    ({'a': {'y': 3}}, {'a': ['x']})
    """
    changed: dict[str, dict[str, Json]] = {}
    gone: dict[str, list[str]] = {}
    for name in before.sections.keys() | after.sections.keys():
        old, new = before.sections.get(name, {}), after.sections.get(name, {})
        if old is new:
            continue
        if more := {key: value for key, value in new.items() if _differs(old.get(key, _ABSENT), value)}:
            changed[name] = more
        if less := [key for key in old if key not in new]:
            gone[name] = less
    return changed, gone


_ABSENT: Final = object()


def _differs(old: Json, new: Json) -> bool:
    return old is not new and old != new


def keeping(before: Section, after: Section) -> Section:
    """Return a section that reuses equal values of an earlier one; the earlier section itself if all are equal."""
    if before is after:
        return before
    kept = {key: _kept(before.get(key, _ABSENT), value) for key, value in after.items()}
    same = len(before) == len(kept) and all(before.get(key, _ABSENT) is value for key, value in kept.items())
    return before if same else kept


def _kept(old: Json, new: Json) -> Json:
    return old if old is not new and old == new else new
