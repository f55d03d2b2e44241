"""The writes of a transition, as columns and codes: direct, by copying, or in parts for each name."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from checker.engines.fast.model.columns import Columns, Place, Writes
from checker.engines.fast.model.decision_leaves import Effect
from checker.engines.fast.model.decision_trees import LearningError
from checker.recording.access_recording import Conclusion, Edited, ObservedFacts, Pointwise
from checker.recording.value_templates import Family, split_value
from semantics.behaviours.observations import NOTHING_SEEN
from semantics.state.cell_values import Cell, Changes, Row, merged
from semantics.state.configuration import Transition
from semantics.state.signature import Name


class Relearn(Exception):
    """An assumption about a cell is wrong; everything learned under it must go."""

    def __init__(self, cell: Cell) -> None:
        super().__init__(cell)
        self.cell = cell


class Varies(Relearn):
    """A cell assumed constant varies."""


class Deeper(Relearn):
    """A cell holds more observations than assumed; its writers must write the new ones, too."""


@dataclass(slots=True)
class RecordedEffect:
    """A transition with its writes.

    Attributes:
        step: The transition.
        effect: The writes that do not depend on a name.
        said: The pointwise facts of holes: the cell, the hole's number, the facts by name.
        families: The pointwise writes by name.
        apart: The names that have parts.
        edits: The edits of cells, independent of their values.
    """

    step: Transition
    effect: Effect = field(default_factory=lambda: Effect([]))
    said: list[tuple[Cell, int, Family]] = field(default_factory=list)
    families: tuple[Mapping[Name, Changes], ...] = ()
    apart: tuple[Name, ...] = ()
    edits: list[Edited] = field(default_factory=list)


@dataclass(slots=True)
class EffectWriter:
    """Translates conclusions into writes.

    Attributes:
        columns: All columns.
        still: The initial configuration, with the values of constant cells.
        varying: The cells written so far.
    """

    columns: Columns
    still: Row
    varying: set[Cell]

    def conclude(self, step: Transition) -> RecordedEffect:
        """Return the writes of a transition.

        Raises:
            Relearn: It writes a cell assumed constant, or more observations than assumed.
        """
        found = RecordedEffect(step)
        state = step.target.state
        if not isinstance(state, Conclusion):
            return found
        found.families = state.families
        for cell, value in (state.changes | merged(self._about_still(state))).items():
            self._write(cell, value, found)
        about = {name for _, _, family in found.said for name in self.columns.mobile.intersection(family)}
        about.update(name for family in state.families for name in family if name in self.columns.apart)
        found.apart = tuple(sorted(about))
        return found

    def part(self, found: RecordedEffect, name: Name) -> Writes:
        """Return the writes of a transition about one name."""
        writes = [
            self._coded((cell, number, name), family[name])
            for cell, number, family in found.said
            if name in self.columns.mobile and name in family
        ]
        inner = RecordedEffect(found.step)
        for cell, value in merged(family[name] for family in found.families if name in family).items():
            self._write(cell, value, inner)
        if inner.said or inner.edits or inner.effect.copies:
            raise LearningError(f"the writes of {found.step.label} about {name} are nested")
        return writes + inner.effect.writes

    def edit(self, edited: Edited, value: Any) -> Writes:
        """Return the writes of an edit of a value; neither contains observations."""
        return [self._coded((edited.cell,), edited.of(value))]

    def _about_still(self, state: Conclusion) -> Iterator[Changes]:
        apart = self.columns.apart
        return (family[name] for family in state.families for name in family if name not in apart)

    def _write(self, cell: Cell, value: Any, found: RecordedEffect) -> None:
        if isinstance(value, Edited):
            found.edits.append(value)
            return
        skeleton, families = split_value(value, self.columns.mobile)
        if cell not in self.varying:
            if cell in self.still.layout.index and self.still.read(cell) == value:
                conclusion = found.step.target.state
                assert isinstance(conclusion, Conclusion)
                conclusion.recorder.scopes[-1].take(cell)  # the write leaves the value as it is
                return
            self.varying.add(cell)
            raise Varies(cell)
        found.effect.writes.append(self._coded((cell,), skeleton))
        if self.columns.dig(cell, len(families)):
            raise Deeper(cell)
        for number in range(self.columns.holes.get(cell, 0)):
            self._say(cell, number, families[number] if number < len(families) else {}, found)

    def _say(self, cell: Cell, number: int, family: Family, found: RecordedEffect) -> None:
        here = self.columns.of_hole(cell, number)
        if isinstance(family, ObservedFacts):
            there = dict(self.columns.of_hole(family.cell, family.hole.number))
            found.effect.copies += [(column, there[name]) for name, column in here if column != there[name]]
            return
        if isinstance(family, Pointwise):
            found.said.append((cell, number, family))
        at_once = {} if isinstance(family, Pointwise) else family
        found.effect.writes += [
            self._coded((cell, number, name), at_once.get(name, NOTHING_SEEN)) for name, _ in here
        ]

    def _coded(self, place: Place, value: Any) -> tuple[int, int]:
        number = self.columns.number(place)
        return number, self.columns.all[number].code(value)
