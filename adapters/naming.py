"""The naming service: which entity of the mission an identity of the world is, and that no two share a name.

An identity is a kind of number and the number: `mavlink:1` (a system id), `serial:2F003B` (an autopilot's own),
`mmsi:244660274`, or `name:oilSpill1` of what already comes with one. The mission's own table goes first; what it
doesn't name is named by its identity. Own vehicles and the places that never move have their names before anything is
heard: nobody else can take them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from physical import PhysicalError

MAX_NAMES: Final = 100_000
"""Entities named at a time: a flood of made-up identities ends there."""

SCHEMES: Final = ("mavlink", "mmsi", "name", "serial")


class NameClash(PhysicalError):
    """Two identities with one name: an own vehicle's name, for instance, taken by an AIS transponder."""


class NamingService:
    """Names for identities, each name for one identity only.

    Arguments:
        table: The mission's own names, by identity.
        own: Names that are taken: whose vehicles and places they are, by identity (`mavlink:1`, `place:harbour0`).

    Raises NameClash where two identities get one name, PhysicalError where the table has no identity.
    """

    def __init__(self, table: Mapping[str, str] | None = None, own: Mapping[str, str] | None = None) -> None:
        self._names: dict[str, str] = {}
        self._identities: dict[str, str] = {}
        for identity, name in (own or {}).items():
            self._give(identity, name)
        for identity, name in sorted((table or {}).items()):
            _check(identity)
            self._give(identity, name)

    def name(self, identity: str) -> str:
        """Return the name of an identity, always the same.

        >>> NamingService({"mmsi:244660274": "tanker0"}).name("mmsi:244660274")
        'tanker0'

        Raises NameClash where its name is another's.
        """
        if identity not in self._names:
            if len(self._names) >= MAX_NAMES:
                raise PhysicalError(
                    "names", f"more than {MAX_NAMES:,} entities", "filter the feed by area or kind"
                )
            self._give(identity, _own_name(identity))
        return self._names[identity]

    def identity(self, name: str) -> str | None:
        """Return whose name it is."""
        return self._identities.get(name)

    def _give(self, identity: str, name: str) -> None:
        holder = self._identities.setdefault(name, identity)
        if holder != identity:
            raise NameClash(
                "name-clash",
                f"{identity} would be called {name}, as {holder} is",
                "give one of them another name in the mission's table",
            )
        self._names[identity] = name


def _own_name(identity: str) -> str:
    """Name what the mission's table doesn't: as it calls itself, or by its number.

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
