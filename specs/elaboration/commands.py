"""The commands of the language, for operands that may be no nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from semantics.behaviours.expressions import Fault
from semantics.behaviours.reactions import Reaction
from semantics.behaviours.values import Value, show
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True, eq=False)
class Checked:
    """A command that fails, as a computation does, for a value that is no node.

    Attributes:
        name: What it is called in the language.
        command: The command.
        kinds: The nodes that there are.
    """

    name: str
    command: Callable[..., Reaction]
    kinds: Mapping[Name, str]

    def __call__(self, host: Name, *arguments: Value) -> Reaction:
        """Return the command's reaction."""
        for value in arguments:
            if not isinstance(value, str) or value not in self.kinds:
                raise Fault(f"{self.name} needs a node, not {show(value, frozenset(self.kinds))}")
        return self.command(host, *arguments)
