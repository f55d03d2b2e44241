"""The naming service: maps identities of the world to entities of the mission, each name to one identity.

An identity is a scheme and a number: `mavlink:1` (a system id), `serial:2F003B` (an autopilot's own), `mmsi:244660274`,
or `name:oilSpill1` for an entity with a name. The mission's own table takes precedence; other entities are named by
their identity. The names of own vehicles, stations and static places are reserved from the start. Names outside the
table follow a rule without state, so a flood of invented identities exhausts nothing.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from physical import PhysicalError

SCHEMES: Final = ("mavlink", "mmsi", "name", "serial")

_NUMBERED: Final = re.compile(r"(mavlink|mmsi)[0-9]+|serial[0-9A-F]+")
"""Names made from numbers: an entity with a name of its own can't have one of them."""


class NameClash(PhysicalError):
    """Two identities with one name: for instance, an AIS transponder with an own vehicle's name."""


class NamingService:
    """Names for identities, each name for one identity only.

    Arguments:
        table: The mission's own names, by identity.
        own: Reserved names of vehicles and places, by identity (`mavlink:1`, `place:harbour0`).
        kinds: The kinds of the mission's entities: a report with another kind is about another entity.

    Raises NameClash if two identities get one name, PhysicalError if the table has an invalid identity.
    """

    def __init__(
        self,
        table: Mapping[str, str] | None = None,
        own: Mapping[str, str] | None = None,
        kinds: Mapping[str, str] | None = None,
    ) -> None:
        self._names: dict[str, str] = {}
        self._identities: dict[str, str] = {}
        self._kinds = kinds or {}
        for identity, name in (own or {}).items():
            self._give(identity, name)
        for identity, name in sorted((table or {}).items()):
            _check(identity)
            self._give(identity, name)

    def name(self, identity: str, kind: str | None = None) -> str:
        """Return the name of an identity of a kind, always the same.

        >>> NamingService({"mmsi:244660274": "tanker0"}).name("mmsi:244660274")
        'tanker0'

        Raises NameClash if another identity or kind has its name.
        """
        if identity in self._names:
            return self._names[identity]
        name = _own_name(identity)
        holder = self._identities.get(name)
        if holder is not None:
            raise _clash(identity, name, holder)
        if identity.startswith("name:") and _NUMBERED.fullmatch(name):
            raise NameClash("name-clash", f"{name} is the name of a number", "call it otherwise")
        known = self._kinds.get(name, kind)
        if kind is not None and known != kind:
            raise NameClash(
                "name-clash", f"{name} is of kind {known} in the mission, not {kind}", "call it otherwise"
            )
        return name

    def kind_of(self, name: str, said: str) -> str:
        """Return the kind of an entity: the mission's, else the reported one."""
        return self._kinds.get(name, said)

    def _give(self, identity: str, name: str) -> None:
        holder = self._identities.setdefault(name, identity)
        if holder != identity:
            raise _clash(identity, name, holder)
        self._names[identity] = name


def _clash(identity: str, name: str, holder: str) -> NameClash:
    return NameClash(
        "name-clash",
        f"{identity} would be called {name}, as {holder} is",
        "give one of them another name in the mission's table",
    )


def _own_name(identity: str) -> str:
    """Name an identity outside the mission's table: by its own name, or by its number.

    >>> _own_name("mmsi:002442103"), _own_name("name:oilSpill1")
    ('mmsi002442103', 'oilSpill1')
    """
    scheme, _, number = identity.partition(":")
    return number if scheme == "name" else f"{scheme}{number}"


def _check(identity: str) -> None:
    scheme, _, number = identity.partition(":")
    if scheme not in SCHEMES or not number:
        forms = ", ".join(f"{scheme}:..." for scheme in SCHEMES)
        raise PhysicalError("identity", f"{identity!r:.60} is no identity", f"write {forms}")
