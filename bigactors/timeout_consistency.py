"""Time limits of the section `live` below the flight times that the section `timing` allows."""

from collections.abc import Iterator, Mapping

from semantics.state.signature import Name
from semantics.timing.dates import lapse_text
from specs.elaboration import ElaboratedMission


def short_limits(mission: ElaboratedMission, flights: Mapping[Name, float]) -> Iterator[str]:
    """Yield a sentence for each live limit that a flight may reach within its allowed time.

    `flights` is the longest flight of each bigActor in seconds.
    """
    for limit in mission.precautions.limits:
        for agent, seconds in sorted(flights.items()):
            if limit.covers("FLY", agent) and limit.seconds < seconds:
                given, most = (lapse_text(round(1000 * each)) for each in (limit.seconds, seconds))
                yield f"live lets {agent} fly for {given}, but by the times its flight may take {most}"
