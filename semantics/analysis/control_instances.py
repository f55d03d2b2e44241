"""The instances of a control: the reactions that it requests, for all possible hosts and arguments."""

from collections.abc import Iterable
from contextlib import suppress
from itertools import product
from math import prod
from typing import Final

from semantics.behaviours.expressions import Fault
from semantics.behaviours.program import Program
from semantics.behaviours.reaction_rules import Reaction
from semantics.state.signature import Name

MOST_INSTANCES: Final = 5_000
"""The most combinations of a control's arguments; a control with more is assumed to do anything."""


def instances(program: Program, name: str, given: Iterable[Iterable[Name]]) -> tuple[Reaction, ...] | None:
    """Return the reactions of a command or rule for some hosts and arguments; None if there are too many."""
    ranges = [sorted(each) for each in given]
    make = program.reactions.get(name)  # a rule with a mistake, which is reported, makes none
    if make is None or prod(map(len, ranges)) > MOST_INSTANCES:
        return None
    found = []
    for host, *names in product(*ranges):
        with suppress(Fault):  # the command may reject some names
            found.append(make(host, *names))
    return tuple(found)
