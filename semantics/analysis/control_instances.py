"""The instances of a control: the reactions that it requests, for all possible hosts and arguments."""

from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import islice, product
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
    if name not in program.reactions or prod(map(len, ranges)) > MOST_INSTANCES:
        return None  # a rule with a mistake, which is reported, makes none
    return tuple(first_instances(program, name, ranges))


def first_instances(program: Program, name: str, given: Iterable[Iterable[Name]]) -> Iterator[Reaction]:
    """Yield the reactions of a command or rule for the first hosts and arguments, at most `MOST_INSTANCES`."""
    make = program.reactions[name]
    for host, *names in islice(product(*map(sorted, given)), MOST_INSTANCES):
        with suppress(Fault):  # the command may reject some names
            yield make(host, *names)
