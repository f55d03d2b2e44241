"""The two access tokens of a console, one to watch and one to act; the printed links contain them."""

from __future__ import annotations

import secrets
from dataclasses import dataclass, field
from enum import StrEnum
from hmac import compare_digest


class Role(StrEnum):
    """The permission that a token gives."""

    WATCH = "watch"
    ACT = "act"


def _token() -> str:
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, slots=True)
class Access:
    """The tokens of one console; each gives its holder a role.

    Attributes:
        watch: For observers.
        act: For operators, who may send messages and orders.
    """

    watch: str = field(default_factory=_token)
    act: str = field(default_factory=_token)

    def role(self, token: str) -> Role | None:
        """Return the role of a token, None for an unknown token.

        >>> Access("blue", "red").role("red"), Access("blue", "red").role("green")
        (<Role.ACT: 'act'>, None)
        """
        given = token.encode(errors="replace")
        if compare_digest(given, self.act.encode()):
            return Role.ACT
        return Role.WATCH if compare_digest(given, self.watch.encode()) else None


def bearer(header: str) -> str:
    """Return the token of an `Authorization` header.

    >>> bearer("Bearer blue"), bearer("Basic blue")
    ('blue', '')
    """
    scheme, _, token = header.partition(" ")
    return token.strip() if scheme.lower() == "bearer" else ""
