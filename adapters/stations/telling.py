"""What a station tells the others of a turn of its run: what leaves, what has entered, who flies, who is where."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from adapters.live.state import Turn
from adapters.stations.entries import Broke, Content, Hosted, Posted, Sent, Took
from adapters.stations.merge import Merge
from semantics.configuration import Configuration
from semantics.parting import Passage, is_here
from semantics.plain_parcels import parcel_json

A_MOMENT = 1e-6
"""Seconds by which what is said of an agent is later than what was said of it before, whatever clocks say."""


def told(turn: Turn, vehicles: Collection[str]) -> Iterator[Content]:
    """Yield what a turn tells, in an order in which it may be read."""
    yield from (Posted(each.station, each.number, parcel_json(each.parcel)) for each in turn.parcels)
    yield from (Took(station, number) for station, number in entered(turn).items())
    for step in turn.steps:
        before, after = step.source.structure.physical, step.transition.target.structure.physical
        if step.transition.label.rule in ("command", "commit"):
            for vehicle in sorted(vehicles):
                if before.going_to(vehicle) != after.going_to(vehicle):
                    yield Sent(vehicle, after.going_to(vehicle), step.time)
    for finding in turn.findings:
        if finding.kind == "broken assumption" and not finding.elsewhere:
            yield Broke(finding.message, finding.time)


def entered(turn: Turn) -> dict[str, int]:
    """Return up to which parcel of each station all have entered with a turn."""
    seen = (step.sight for step in turn.steps)
    passed = [each for each in seen if isinstance(each, Passage) and each.parcel is not None]
    return {each.station: each.number for each in passed}


def moved(c: Configuration, merge: Merge, now: float) -> Iterator[Hosted]:
    """Yield where agents that run here are hosted, where the stations know otherwise.

    Whoever has an agent has heard from whom it came all that was said of it before: so what is said last is the latest.
    """
    for agent in c.alpha.names():
        home = merge.home(agent)
        known = home.content if home is not None else None
        host = c.alpha.host(agent)
        if is_here(c, agent) and not (isinstance(known, Hosted) and known.host == host):
            after = known.time + A_MOMENT if isinstance(known, Hosted) else now
            yield Hosted(agent, host, max(now, after))
