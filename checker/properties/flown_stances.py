"""The stances of entities that are reached, alone and in pairs: an inspection for `check --ways`.

A stance is plain data; geometry is computed afterwards (`checker.properties.corridors`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING

from checker.properties.stance_questions import Pair, StanceQuestions
from semantics.properties.region_atoms import RegionAtom, WithinRangeOf, operands
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

if TYPE_CHECKING:
    from semantics.regions.stances import Stance


class FlownStances(StanceQuestions):
    """The stances of entities, and of pairs of which one is in transit.

    Attributes:
        vehicles: The entities that a control may move, sorted.
        named: The other entities that properties about regions name, sorted.
        ranged: Those of them from which a property allows a greatest distance.
    """

    def __init__(self, initial: Configuration, atoms: Iterable[RegionAtom]) -> None:
        super().__init__()
        facts = initial.setting.regions
        assert facts is not None
        moved = {name for name, motion in facts.motions.items() if motion.targets}
        seen = tuple(atoms)
        self.vehicles = tuple(sorted(moved))
        self.named = tuple(sorted({name for atom in seen for name in operands(atom)} - moved))
        within = (atom for atom in seen if isinstance(atom, WithinRangeOf))
        self.ranged = frozenset(name for atom in within for name in operands(atom)) - moved

    def questions(self) -> Iterator[Callable[[Configuration], object]]:
        """Yield the questions: the pairs are those of vehicles that were seen in transit before."""
        from semantics.regions.stances import standing, together  # noqa: PLC0415 - geometry takes its time to load

        yield from (partial(standing, name) for name in (*self.vehicles, *self.named))
        yield from (partial(together, *pair) for pair in self.pairs(sorted(self.flown())))

    def flown(self) -> dict[Name, list[Stance]]:
        """Return the stances in transit of each vehicle that flies."""
        found = {
            name: [each for each in self.alone.get(name, ()) if each.is_flying] for name in self.vehicles
        }
        return {name: stances for name, stances in found.items() if stances}

    def pairs(self, flown: Iterable[Name]) -> Iterator[Pair]:
        """Yield the pairs of two vehicles that fly, and of one that flies and a named entity."""
        in_order = tuple(flown)
        for rank, one in enumerate(in_order):
            yield from ((one, other) for other in (*in_order[rank + 1 :], *self.named))
