"""The commands of the language, given values that may be no nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from semantics.expressions import Fault
from semantics.reactions import Reaction
from semantics.signature import Name
from semantics.values import Value, show


def checked(
    name: str, command: Callable[..., Reaction], kinds: Mapping[Name, str]
) -> Callable[..., Reaction]:
    """Return a command that fails, as a computation does, for a value that is no node."""

    def make(host: Name, *arguments: Value) -> Reaction:
        for value in arguments:
            if not isinstance(value, str) or value not in kinds:
                raise Fault(f"{name} needs a node, not {show(value, frozenset(kinds))}")
        return command(host, *arguments)

    return make
