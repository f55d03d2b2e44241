"""The environment section: the effects of `env : P'` and `say`, clause by clause."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from semantics.behaviours.values import Value, show
from semantics.state.cell_values import Cell, Changes
from semantics.state.physical_model import (
    Carried,
    PhysicalModel,
    Placed,
    down_cell,
    left_cell,
)
from semantics.state.signature import Name

if TYPE_CHECKING:
    from physical import DriftWithin

Effect = tuple[str, Changes]
"""A description of an event, and its writes to P."""


@dataclass(frozen=True, slots=True)
class Drifts:
    """An entity drifts among placements; its cargo goes along.

    Attributes:
        entity: The entity that drifts.
        placements: Its possible placements.
        names: The name of each placement.
        next: The possible successors of each placement; from any other placement, those in `first`.
        first: The possible successors of the initial placement.
        within: Whether the placements represent a whole place, so that the entity may be anywhere in it.
        arrangement: The places that cut this drift into faces, for regions; None if it is not within a place.
    """

    entity: Name
    placements: tuple[Placed, ...]
    names: tuple[str, ...]
    next: tuple[tuple[int, ...], ...]
    first: tuple[int, ...]
    within: bool = False
    arrangement: "DriftWithin | None" = field(default=None, compare=False, repr=False)

    @property
    def words(self) -> tuple[str, ...]:
        """The descriptions of its possible events."""
        return tuple(map(self.word, range(len(self.names))))

    def word(self, index: int) -> str:
        """Return the description of a drift to a placement."""
        return f"{self.entity} drifts to {self.names[index]}"

    def effects(self, physical: PhysicalModel) -> Iterator[Effect]:
        """Yield each drift; an entity that is absent, carried or in transit does not drift."""
        here = physical.placement(self.entity)
        if not isinstance(here, Placed):
            return
        known = self.placements.index(here) if here in self.placements else None
        for index in self.first if known is None else self.next[known]:
            if self.placements[index] != here:
                yield self.word(index), physical.placing(self.entity, self.placements[index])


@dataclass(frozen=True, slots=True)
class Drops:
    """A channel drops, and returns if `returns` is set."""

    channel: Name
    returns: bool

    @property
    def words(self) -> tuple[str, ...]:
        """The descriptions of its possible events."""
        return (f"{self.channel} drops", f"{self.channel} returns")[: 1 + self.returns]

    def effects(self, physical: PhysicalModel) -> Iterator[Effect]:
        """Yield the drop of a channel that is up, the return of one that is down."""
        if not physical.is_down(self.channel):
            yield self.words[0], {down_cell(self.channel): True}
        elif self.returns:
            yield self.words[1], {down_cell(self.channel): False}


@dataclass(frozen=True, slots=True)
class Leaves:
    """One entity leaves a channel, and returns to it if `returns` is set."""

    entity: Name
    channel: Name
    returns: bool

    @property
    def left(self) -> Cell:
        """The cell that records whether the entity is off the channel because it left."""
        return left_cell(self.entity, self.channel)

    @property
    def words(self) -> tuple[str, ...]:
        """The descriptions of its possible events."""
        both = (f"{self.entity} leaves {self.channel}", f"{self.entity} returns to {self.channel}")
        return both[: 1 + self.returns]

    def effects(self, physical: PhysicalModel) -> Iterator[Effect]:
        """Yield the entity's leaving; its return only if it has left and has not joined since."""
        channels = frozenset(physical.channels(self.entity))
        if self.entity not in physical:
            return
        if self.channel in channels:
            left = physical.joining(self.entity, channels - {self.channel})
            yield self.words[0], left | {self.left: True}
        elif self.returns and physical.cells.read(self.left):
            yield self.words[1], physical.joining(self.entity, channels | {self.channel})


@dataclass(frozen=True, slots=True)
class Appears:
    """An absent entity appears, with its channels."""

    entity: Name
    placements: tuple[Placed | Carried, ...]
    channels: tuple[Name, ...] = ()

    @property
    def words(self) -> tuple[str, ...]:
        """The descriptions of its possible events."""
        several = len(self.placements) > 1
        numbers = range(1, len(self.placements) + 1)
        return tuple(f"{self.entity} appears" + (f" ({number})" if several else "") for number in numbers)

    def effects(self, physical: PhysicalModel) -> Iterator[Effect]:
        """Yield each placement at which the entity may appear, if it is absent."""
        if self.entity in physical:
            return
        for words, placement in zip(self.words, self.placements, strict=True):
            if not isinstance(placement, Carried) or placement.by in physical:
                changes = physical.joining(self.entity, frozenset(self.channels))
                yield words, physical.placing(self.entity, placement) | changes


@dataclass(frozen=True, slots=True)
class Vanishes:
    """An entity vanishes with its cargo; L keeps their nodes."""

    entity: Name

    @property
    def words(self) -> tuple[str, ...]:
        """The descriptions of its possible events."""
        return (f"{self.entity} vanishes",)

    def effects(self, physical: PhysicalModel) -> Iterator[Effect]:
        """Yield its vanishing, if it is there."""
        if self.entity not in physical:
            return
        changes: Changes = {}
        for name in sorted({self.entity, *physical.cargo(self.entity)}):
            changes |= physical.placing(name, None) | physical.joining(name, frozenset())
        yield self.words[0], changes


@dataclass(frozen=True, slots=True)
class Says:
    """An outside sender sends a message to an agent, at most `times` times (rule `say`, not `env`)."""

    message: Value
    agent: Name
    times: int
    number: int

    @property
    def counter(self) -> Cell:
        """The cell that counts the remaining messages."""
        return ("says", str(self.number))

    @property
    def words(self) -> tuple[str, ...]:
        """The descriptions of its possible events."""
        return (f"{show(self.message)} to {self.agent}",)


@dataclass(frozen=True, slots=True)
class Observed:
    """An event shown by telemetry or feeds: in a live mission the environment allows it, since it has happened.

    Attributes:
        words: The description of the event.
        changes: The cells of P that it writes, sorted, with their values.
    """

    words: str
    changes: tuple[tuple[Cell, Any], ...]

    def effects(self, physical: PhysicalModel) -> Iterator[Effect]:  # noqa: ARG002 - as the clauses have it
        """Yield the observed event."""
        yield self.words, dict(self.changes)


Clause = Drifts | Drops | Leaves | Appears | Vanishes | Says

Placing = Drifts | Appears
"""The clauses that give an entity new placements, in their `placements`."""
