"""Values split into columns: a skeleton, and one fact for each mobile name and observation.

In the *skeleton* of a cell's value, each observation is a numbered hole. A hole still holds the facts about names that
never move. The set of mobile names is fixed for a mission, so equal values have equal skeletons. An observation of
twelve vehicles thus takes twelve small values instead of one of thousands.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from semantics.behaviours.observations import NOTHING_SEEN, Fact, Observation, Swept, agent_key
from semantics.behaviours.statements import Migrate, Spawn
from semantics.behaviours.values import Route
from semantics.state.cell_values import Row
from semantics.state.physical_model import Carried
from semantics.state.requests import READY, SND
from semantics.state.setting import Setting
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class ObservationHole:
    """The position of an observation in a skeleton.

    Attributes:
        number: The index of the observation within the value, from 0.
        still: Its facts about names that are not mobile, sorted.
        swept: The places that it searched completely.
    """

    number: int
    still: tuple[tuple[Name, Fact], ...]
    swept: Swept


Family = Mapping[Name, Fact]


def mobile_names(setting: Setting, first: Row) -> frozenset[Name]:
    """Return the names that may move, appear or disappear: observations of them change."""
    driven = set(setting.driven())
    around = {clause.entity for clause in setting.environment if hasattr(clause, "entity")}
    aboard = {cell[-1] for cell, value in first.items() if isinstance(value, Carried)}
    agents: set[Name] = set()
    if any(isinstance(statement, Migrate | Spawn) for statement in setting.program.statements):
        agents = set(map(agent_key, agents_of(setting, first)))
    return frozenset(driven | around | aboard | agents).union(setting.missable)


def agents_of(setting: Setting, first: Row) -> frozenset[Name]:
    """Return every agent that may ever exist."""
    spawned = (each.name for each in setting.program.statements if isinstance(each, Spawn))
    return frozenset((*(cell[-1] for cell, _ in first.items() if cell[0] == "host"), *spawned))


def split_value(value: Any, mobile: frozenset[Name]) -> tuple[Any, tuple[Family, ...]]:
    """Return the skeleton of a value, and the facts by name for each of its holes."""
    families: list[Family] = []

    def dig(seen: Observation) -> ObservationHole:
        families.append(seen.family)
        told = ((name, seen.fact(name)) for name in sorted(set(seen.family) - mobile))
        still = tuple((name, fact) for name, fact in told if fact != NOTHING_SEEN)
        return ObservationHole(len(families) - 1, still, seen.swept)

    return _mapped(_mapped(value, frozenset, settled), Observation, dig), tuple(families)


def join_value(skeleton: Any, family_at: Callable[[ObservationHole], Family]) -> Any:
    """Return the value of a skeleton, with the facts that `family_at` gives for each hole."""
    return _mapped(skeleton, ObservationHole, lambda hole: Observation(family_at(hole), hole.swept))


def settled(value: Any) -> Any:
    """Return a value with all facts of its observations evaluated."""
    return _mapped(value, Observation, lambda seen: Observation(dict(seen.facts), seen.swept), sets=True)


def holes(skeleton: Any) -> Iterator[ObservationHole]:
    """Yield the holes of a skeleton, in the order of their numbers."""
    match skeleton:
        case ObservationHole():
            yield skeleton
        case tuple():
            for part in skeleton:
                yield from holes(part)
        case Route(stops):
            yield from holes(stops)
        case READY():
            yield from holes(skeleton.observation)
        case SND():
            yield from holes(skeleton.message)


def has_no_holes(skeleton: Any) -> bool:
    """Return whether a skeleton contains no observation."""
    return next(holes(skeleton), None) is None


def _mapped(value: Any, kind: type, change: Callable[[Any], Any], *, sets: bool = False) -> Any:
    """Return a value with its parts of one type changed; the same object if it has none.

    Elements of sets have no position: they are changed only if `sets`.
    """
    if isinstance(value, kind):
        return change(value)
    match value:
        case READY():
            return replace(value, observation=_mapped(value.observation, kind, change, sets=sets))
        case SND():
            message = _mapped(value.message, kind, change, sets=sets)
            return value if message is value.message else replace(value, message=message)
        case Route(stops):
            changed = _mapped(stops, kind, change, sets=sets)
            return value if changed is stops else Route(changed)
        case tuple() if type(value) is tuple:
            parts = tuple(_mapped(part, kind, change, sets=sets) for part in value)
            return value if all(map(_same, parts, value)) else parts
        case frozenset() if sets:
            return frozenset(_mapped(part, kind, change, sets=sets) for part in value)
    return value


def _same(one: object, other: object) -> bool:
    return one is other
