"""Properties about ways before take-off: a run does not watch ways, and says so or refuses to fly."""

from __future__ import annotations

from bigactors.mistakes import Mistake
from bigactors.terminal import tell
from semantics.properties.property import asks_of_regions
from specs.elaboration import ElaboratedMission


def check_ways(mission: ElaboratedMission, *, is_verified: bool) -> None:
    """Refuse a verdict that rests on `strays`, and warn of properties about ways, which nothing watches in flight.

    Without `strays` the verdict assumes that vehicles fly straight from place to place. With it, it also assumes that a
    flight ends near its waypoint only, but a run ends a flight as soon as the vehicle is seen in its place.

    Raises:
        Mistake: The verdict rests on `strays`.
    """
    asked = [each for each in mission.properties if asks_of_regions([each])]
    if not asked:
        return
    lines = ", ".join(f"'{each.name}' (line {each.line})" for each in asked)
    if mission.setting.strays and is_verified:
        message = f"a run does not watch 'strays' yet, and the verdict on {lines} rests on it"
        hint = "leave strays out and check it again: ways are then as wide as their places; or fly it --unverified"
        raise Mistake(message, hint, mission.source.name)
    rests = "they hold as long as each vehicle flies straight from place to place"
    tell(f"{mission.source.name}: warning: the run does not watch ways: {lines}; {rests}")
