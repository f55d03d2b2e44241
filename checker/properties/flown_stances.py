"""The stances of entities that are reached, alone and in pairs: an inspection for `check --ways`.

A stance is plain data; geometry is computed afterwards (`checker.properties.corridors`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING, ClassVar

from checker.limits import Bound
from checker.properties.inspections import InTime
from semantics.properties.region_atoms import RegionAtom, WithinRangeOf, operands
from semantics.state.configuration import Configuration
from semantics.state.signature import Name
from semantics.successors import Expansion

if TYPE_CHECKING:
    from semantics.regions.stances import Stance

Pair = tuple[Name, Name]


class FlownStances:
    """The stances of entities, and of pairs of which one is in transit.

    Attributes:
        vehicles: The entities that a control may move, sorted.
        named: The other entities that properties about regions name, sorted.
        ranged: Those of them from which a property allows a greatest distance.
        alone: The stances of each vehicle and each named entity.
        together: The stances of each pair: of two vehicles, or of a vehicle and a named entity.
        bounds: The bounds at which an engine stopped asking.
    """

    in_time: ClassVar[InTime] = InTime.ENABLED

    def __init__(self, initial: Configuration, atoms: Iterable[RegionAtom]) -> None:
        facts = initial.setting.regions
        assert facts is not None
        moved = {name for name, motion in facts.motions.items() if motion.targets}
        seen = tuple(atoms)
        self.vehicles = tuple(sorted(moved))
        self.named = tuple(sorted({name for atom in seen for name in operands(atom)} - moved))
        within = (atom for atom in seen if isinstance(atom, WithinRangeOf))
        self.ranged = frozenset(name for atom in within for name in operands(atom)) - moved
        self.alone: dict[Name, set[Stance]] = {}
        self.together: dict[Pair, set[tuple[Stance, Stance]]] = {}
        self.bounds: list[Bound] = []

    def questions(self) -> Iterator[Callable[[Configuration], object]]:
        """Yield the questions; the answer to each is noted before the next one."""
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

    def note(self, answer: object) -> None:
        """Note the answer to a question."""
        from semantics.regions.stances import Stance  # noqa: PLC0415 - geometry takes its time to load

        if isinstance(answer, Stance):
            self.alone.setdefault(answer.entity, set()).add(answer)
        elif isinstance(answer, tuple):
            one, other = answer
            self.together.setdefault((one.entity, other.entity), set()).add((one, other))

    def __call__(self, _: int, c: Configuration, __: Expansion) -> None:
        """Note the stances in a configuration."""
        for question in self.questions():
            self.note(question(c))

    def add(self, part: FlownStances) -> None:
        """Add the stances that another worker saw."""
        for vehicle, stances in part.alone.items():
            self.alone.setdefault(vehicle, set()).update(stances)
        for pair, both in part.together.items():
            self.together.setdefault(pair, set()).update(both)
        self.bounds += part.bounds
