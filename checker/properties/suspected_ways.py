"""Suspected ways: an inspection that confirms or refutes what the text suggests about flights."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING

from checker.limits import BoundMet, look
from checker.properties.stance_questions import StanceQuestions
from physical import CarriedBy, GeometryError, Place, Transit, possibly_in
from physical.place_nesting import holds
from semantics.regions.suspicions import MayCross, SuspectedWay, Suspicion
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

if TYPE_CHECKING:
    from semantics.regions.region_facts import RegionFacts
    from semantics.regions.stances import Stance, StanceWords


class SuspectedWays(StanceQuestions):
    """The stances of the pairs that are suspected, wherever both are there.

    Attributes:
        suspicions: The suspicions.
    """

    def __init__(self, suspicions: Iterable[Suspicion]) -> None:
        super().__init__()
        self.suspicions = tuple(suspicions)

    def questions(self) -> Iterator[Callable[[Configuration], object]]:
        """Yield a question for each pair."""
        from semantics.regions.stances import present_both  # noqa: PLC0415 - geometry takes its time to load

        pairs = dict.fromkeys(each.pair for each in self.suspicions)
        yield from (partial(present_both, *pair) for pair in pairs)

    def decided(self, facts: RegionFacts, *, complete: bool) -> Mapping[Suspicion, SuspectedWay | None]:
        """Return for each suspicion a way that confirms it, None if there is none; undecided ones are left out."""
        from semantics.regions.stances import StanceWords  # noqa: PLC0415 - geometry takes its time to load

        words, found = StanceWords(facts), dict[Suspicion, SuspectedWay | None]()
        for suspicion in self.suspicions:
            try:
                way = self._confirmed(suspicion, words)
            except (BoundMet, GeometryError):
                continue
            if way is not None or (complete and not self.bounds):
                found[suspicion] = way
        return found

    def _confirmed(self, suspicion: Suspicion, words: StanceWords) -> SuspectedWay | None:
        pairs = self.together.get(suspicion.pair, set())
        confirm = _crossing if isinstance(suspicion, MayCross) else _meeting
        for one, other in sorted(pairs, key=lambda pair: tuple(map(words.words, pair))):
            look()
            way = confirm(one, other, words)
            if way is not None:
                return way
        return None


def _crossing(one: Stance, place: Stance, words: StanceWords) -> SuspectedWay | None:
    """Return the way of an entity that may be in a place; None if it may not, or if it was sent there or is there."""
    bearer, at = one.chain[-1]
    if place.entity in dict(one.chain) or _is_sent_to(one, place.entity) or _is_inside(at, place.at):
        return None
    if not possibly_in(one.located(words.facts), place.located(words.facts)):
        return None
    if isinstance(at, Transit):
        return SuspectedWay(bearer, words.origin(bearer, at.origin), at.to)
    return SuspectedWay(bearer, "", words.around(bearer, at) if isinstance(at, Place) else "")


def _is_sent_to(stance: Stance, place: Name) -> bool:
    return any(place in plan.stops for plan in stance.plans)


def _is_inside(at: object, around: object) -> bool:
    return isinstance(at, Place) and isinstance(around, Place) and holds(around, at)


def _meeting(one: Stance, other: Stance, words: StanceWords) -> SuspectedWay | None:
    """Return the way to a place to which two vehicles were sent, and where both may now be."""
    shared = _goals(one, words.facts) & _goals(other, words.facts)
    return SuspectedWay(one.entity, "", min(shared)) if shared else None


def _goals(stance: Stance, facts: RegionFacts) -> frozenset[Name]:
    """Return the places to which a control may have sent a vehicle: it flies there, or has arrived."""
    targets = facts.motions[stance.entity].targets
    match stance.at:
        case Transit(_, to):
            return frozenset({to})
        case CarriedBy(carrier):
            return targets & {carrier}
        case Place(geometry):
            ways = facts.ways
            return frozenset(each for each in targets if ways.may_arrive_at(stance.entity, each, geometry))
        case _:
            return frozenset()
