"""Addresses of runs: how many steps are those of a run from a file, then the numbers of the choices."""

from __future__ import annotations

import re
from typing import Final

FROM_FILE: Final = re.compile(r"~[0-9]{1,9}")
CHOSEN: Final = re.compile(r"([0-9]{1,6})(?:@([0-9]{1,12}))?")
"""A choice, and with times its tick where that is not the earliest."""


def joined(*parts: object) -> str:
    """Return the address of its parts, of which some may be empty.

    >>> joined("~7", 0, "2@15"), joined("", 0)
    ('~7.0.2@15', '0')
    """
    return ".".join(filter(None, map(str, parts)))


def parts_of(address: str) -> tuple[str, list[str]]:
    """Return the part of an address for steps from a file, and those for choices.

    >>> parts_of("~7.0.2@15"), parts_of("0"), parts_of("")
    (('~7', ['0', '2@15']), ('', ['0']), ('', []))
    """
    first, *others = address.split(".")
    return (first, others) if FROM_FILE.fullmatch(first) else ("", [first, *others] if address else [])
