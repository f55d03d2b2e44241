"""Take in the world: sightings become `env` and `commit` steps, reports become findings."""

from __future__ import annotations

from collections.abc import Iterable
from typing import assert_never

from adapters.live.assumptions import STRAYED, broken_by_place, clause_of_leaving, is_missed, relations
from adapters.live.batch import Batch, Heard
from adapters.live.command_planning import is_authority
from adapters.live.fallbacks import answers_for, breaks, flies_home
from adapters.live.flying import arrive, doubt, flies, obey, refuse, renew
from adapters.live.fresh_placements import Refusal, Sighting, placement_seen, sighting_of
from adapters.live.order_progress import confirm, refused, sent
from adapters.live.other_stations import take_station_report
from adapters.live.step_taking import observe, take
from adapters.live.surroundings import separating_place
from adapters.live.turn_in_progress import Turning
from adapters.live.unknown_entities import comes_in, place_strangers, remove_strangers
from adapters.plugin import (
    Accepted,
    Arrived,
    Believes,
    Broken,
    Delivered,
    Doubted,
    Failed,
    Hosts,
    LinkLost,
    LinkRestored,
    Presence,
    Rejected,
    Report,
    Sent,
    Status,
    StatusText,
    TakenOver,
    Trouble,
    Underway,
    entity_of,
)
from semantics.environment import Appears, Leaves
from semantics.observed_steps import Sight, happening
from semantics.rules import env
from semantics.state.cell_values import Cell
from semantics.state.physical_model import Carried, Placed, Placement, channels_cell, placement_cell
from semantics.state.signature import REGION, Name


def take_in(turning: Turning, batch: Batch) -> None:
    """Take in observations and reports: take-overs first, so that no move of those vehicles is an arrival."""
    for report in batch.reports:
        if isinstance(report, TakenOver | Doubted):
            note(turning, report)
    hear(turning, batch.heard)
    for report in batch.reports:
        if not isinstance(report, TakenOver | Doubted):
            note(turning, report)


def hear(turning: Turning, heard: Iterable[Heard]) -> None:
    """Take in the newest publication on each entity. Each entity that the mission names has a step of its own."""
    named = turning.plan.first.setting.kinds
    found = _merged(turning, heard)
    if any(entity not in turning.sightings.newest for entity in found):
        turning.agents = turning.agents.looking_again()  # commands may wait until the vehicle is heard
    turning.sightings = turning.sightings.with_newest(found)
    for entity in found:
        if entity in named:
            _place(turning, entity)
    place_strangers(turning, (entity for entity in found if entity not in named))
    if turning.now >= turning.sightings.expires:
        _expire(turning)


def _merged(turning: Turning, heard: Iterable[Heard]) -> dict[Name, Sighting]:
    """Return the newest sighting of each entity that is heard; refusals are reported."""
    newest: dict[Name, Sighting] = {}
    for each in heard:
        entity = entity_of(each.published)
        known = newest.get(entity) or turning.sightings.newest.get(entity)
        found = sighting_of(each, known, turning.plan, turning.now)
        if isinstance(found, Refusal):
            turning.find("trouble", found.entity, found.reason, once=True)
        elif found is not None and (entity in newest or _belongs(turning, each.plugin, found)):
            newest[entity] = found
    return newest


def _belongs(turning: Turning, plugin: str, found: Sighting) -> bool:
    """Return whether the mission names an entity, or has admitted it, or admits it now."""
    return found.property.entity in turning.c.setting.kinds or comes_in(turning, plugin, found)


# --- places -------------------------------------------------------------------------------------------


def _place(turning: Turning, entity: Name) -> None:
    if turning.sightings.newest[entity].until <= turning.now:
        return
    here = turning.c.structure.physical.placement(entity)
    if entity in turning.plan.vehicles:
        _rechannel(turning, entity)
    if turning.c.structure.physical.transit(entity) is not None:
        if not isinstance(here, Carried):
            arrive(turning, entity)
        return
    seen = placement_seen(turning.c, turning.shape(entity), turning.sightings.newest[entity])
    if seen is None or seen == here or (isinstance(here, Carried) and isinstance(seen, Placed)):
        return
    if not _same_place(turning, entity, here, seen):
        _move(turning, entity, here, seen)
    elif entity in turning.plan.vehicles and entity not in turning.overrides.taken:
        _check_covered(turning, entity, here, seen)


def _check_covered(turning: Turning, entity: Name, here: Placement | None, seen: Placement) -> None:
    """Report a vehicle if a place, at a listed position, holds either its seen point or its point in P, not both."""
    if turning.overrides.suspended or not isinstance(here, Placed) or not isinstance(seen, Placed):
        return
    place = separating_place(turning.c, entity, here, seen, turning.plan.first)
    if place:
        only = f"{place}, where the mission lists it, holds {entity} at one of the two points only"
        breaks(
            turning,
            f"{entity} is seen at {seen.geometry!r}, the mission has it at {here.geometry!r}: {only}",
            entity,
        )


def _same_place(turning: Turning, entity: Name, here: Placement | None, seen: Placement) -> bool:
    """Return whether A(P) is the same for two points: no rule depends on a point's exact position within its place."""
    if not isinstance(here, Placed) or not isinstance(seen, Placed) or not seen.geometry.is_point:
        return False
    kind = turning.c.setting.kind(entity)
    return here.geometry.is_point and turning.around(entity, kind, here) == turning.around(entity, kind, seen)


def _move(turning: Turning, entity: Name, here: Placement | None, seen: Placement) -> None:
    expected = flies_home(turning, entity) or (here is None and _is_back(turning, entity, seen))
    cause = turning.overrides.taken.get(entity, STRAYED)
    broken = "" if expected else broken_by_place(turning.plan, turning.c, entity, seen, cause)
    writes: dict[Cell, object] = {placement_cell(entity): seen}
    if here is None:
        writes[channels_cell(entity)] = _channels_of_newcomer(turning, entity)
    around = sorted(turning.around(entity, turning.c.setting.kind(entity), seen))
    verb = "appears in" if here is None else "is seen in"
    sight = Sight(f"{entity} {verb} {', '.join(around) or REGION}", writes)
    if observe(turning, sight, happening(turning.c, sight)):
        if broken:
            breaks(turning, broken, entity)
        if not (isinstance(seen, Placed) and seen.geometry.is_point):
            renew(turning, entity)


def _is_back(turning: Turning, entity: Name, seen: Placement) -> bool:
    """Return whether an entity is back at its last place, after its absence already broke an assumption."""
    cell = placement_cell(entity)
    before = turning.sightings.missing.get(cell)
    turning.sightings = turning.sightings.found(cell)
    c = turning.c
    return isinstance(before, Placed | Carried) and relations(c, entity, before) == relations(c, entity, seen)


def _channels_of_newcomer(turning: Turning, entity: Name) -> tuple[Name, ...]:
    clauses = turning.plan.first.setting.environment
    appears = (clause for clause in clauses if isinstance(clause, Appears) and clause.entity == entity)
    clause = next(appears, None)
    if clause is not None:
        return tuple(sorted(clause.channels))
    return turning.plan.first.structure.physical.channels(entity)


def _expire(turning: Turning) -> None:
    """Remove from P each entity that was not heard for longer than its time to live."""
    expired = turning.sightings.expired(turning.now)
    turning.sightings = turning.sightings.without(expired)
    old = sorted(expired)
    named = turning.plan.first.setting.kinds
    for entity in old:
        if entity not in named:
            continue
        physical = turning.c.structure.physical
        if entity in physical and physical.transit(entity) is None and physical.carrier(entity) is None:
            _vanish(turning, entity)
    remove_strangers(turning, (entity for entity in old if entity not in named))


def _vanish(turning: Turning, entity: Name) -> None:
    if is_missed(turning.plan, entity):
        turning.sightings = turning.sightings.unseeing(entity)
        return
    broken = broken_by_place(turning.plan, turning.c, entity, None)
    gone = sorted({entity, *turning.c.structure.physical.cargo(entity)})
    writes: dict[Cell, object] = {placement_cell(name): None for name in gone}
    writes |= {channels_cell(name): () for name in gone}
    before = turning.c.structure.physical.placement(entity)
    sight = Sight(f"{entity} vanishes", writes)
    if observe(turning, sight, happening(turning.c, sight)) and broken:
        turning.sightings = turning.sightings.with_missing(placement_cell(entity), before)
        breaks(turning, broken, entity)


# --- channels -----------------------------------------------------------------------------------------


def _rechannel(turning: Turning, entity: Name) -> None:
    """Compare a vehicle's observed authority with P; the rules decide about changes by a hand-over."""
    said = frozenset(filter(is_authority, turning.sightings.newest[entity].property.channels))
    physical = turning.c.structure.physical
    known = frozenset(filter(is_authority, physical.links(entity)))
    if said == known or entity not in physical:
        return
    if entity in turning.commanded.hand_overs:
        turning.agents = turning.agents.looking_again()
        return
    for channel in sorted(known - said):
        off_channel(turning, entity, channel, f"{entity} is not on {channel} any more")
    for channel in sorted(said - known):
        _on_channel(turning, entity, channel)


def off_channel(turning: Turning, entity: Name, channel: Name, what: str) -> None:
    """Remove an entity from a channel, by the environment's clause if there is one."""
    clause = clause_of_leaving(turning.plan, entity, channel)
    physical = turning.c.structure.physical
    if clause is not None:
        found = [t for t in env(turning.c, clause) if not str(t.label).endswith("returns⟩")]
        found = [t for t in found if "returns" not in str(t.label.about)]
        if found:
            take(turning, found[0], tuple(found))
        return
    before = physical.channels(entity)
    kept = tuple(each for each in before if each != channel)
    sight = Sight(f"{entity} is off {channel}", {channels_cell(entity): kept})
    if observe(turning, sight, happening(turning.c, sight)):
        cell = channels_cell(entity)
        first = turning.sightings.missing.get(cell, before)
        turning.sightings = turning.sightings.with_missing(cell, first)
        breaks(turning, f"{what}; the mission does not let it leave or drop", entity)


def _on_channel(turning: Turning, entity: Name, channel: Name) -> None:
    clause, physical = clause_of_leaving(turning.plan, entity, channel), turning.c.structure.physical
    if clause is not None:
        found = [t for t in env(turning.c, clause) if "returns" in str(t.label.about)]
        if found:
            take(turning, found[0], tuple(found))
            return
    on = tuple(sorted({*physical.channels(entity), channel}))
    writes: dict[Cell, object] = {channels_cell(entity): on}
    if isinstance(clause, Leaves):
        writes[clause.left] = False
    elif clause is not None:
        writes["down", channel] = False
    sight = Sight(f"{entity} is on {channel}", writes)
    back = channel in turning.sightings.missing.get(channels_cell(entity), ())  # type: ignore[operator]
    if observe(turning, sight, happening(turning.c, sight)) and not back:
        breaks(
            turning,
            f"{entity} is on {channel}; the mission neither links it there, nor hands it over, nor lets it return",
            entity,
        )


# --- reports ------------------------------------------------------------------------------------------


def note(turning: Turning, report: Report) -> None:
    """Take in a plugin's report; a report alone commits nothing."""
    match report:
        case Accepted(request, entity) | Arrived(request, entity):
            obey(turning, entity, report)
            confirm(turning, entity, request)
        case Sent(request, entity):
            sent(turning, entity, request)
        case Delivered() | Underway() | Hosts() | Believes() | Broken():
            take_station_report(turning, report)
        case Rejected():
            _refuse(turning, report)
        case Doubted(entity):
            doubt(turning, entity)
        case TakenOver(entity, _, reason):
            turning.overrides = turning.overrides.taken_over(entity, reason)
            back = f"it gets no commands until `bigactors give-back {entity}`"
            turning.find("taken over", entity, f"{entity} was taken over: {reason}; {back}")
        case LinkLost(entity, _, since):
            _lose(turning, entity, since)
        case LinkRestored(entity, _, rebooted):
            _restore(turning, entity, rebooted=rebooted)
        case Failed(source, reason):
            breaks(turning, f"{source} fails: {reason}", source, "failed")
        case Trouble(source, _, what, detail, count):
            often = f" ({count:,} times)" if count > 1 else ""
            turning.find("trouble", source, f"{source}: {what}{often}{': ' if detail else ''}{detail}")
        case Status() | StatusText() | Presence():
            pass  # for people alone
        case _:
            assert_never(report)


def _refuse(turning: Turning, rejected: Rejected) -> None:
    request, entity, reason = rejected.request, rejected.entity, rejected.reason
    refuse(turning, entity, request)
    if refused(turning, entity, request, reason):
        return
    if entity not in turning.overrides.taken:  # else its take-over was already reported
        message = f"{entity} refuses {request}: {reason}; the request stays pending"
        turning.find("refused", entity, message)


def _lose(turning: Turning, entity: Name, since: float) -> None:
    if entity in turning.sightings.lost:
        return
    turning.sightings = turning.sightings.losing(entity)
    turning.find("lost link", entity, f"nothing was heard of {entity} for {turning.now - since:.0f} s")
    if not answers_for(turning, entity):
        return  # the other station reports on its own link
    for channel in filter(is_authority, turning.c.structure.physical.links(entity)):
        off_channel(turning, entity, channel, f"the link to {entity} over {channel} is lost")


def _restore(turning: Turning, entity: Name, *, rebooted: bool) -> None:
    turning.sightings = turning.sightings.restored(entity)
    turning.agents = turning.agents.looking_again()
    turning.find("link restored", entity, f"{entity} is heard again{', rebooted' if rebooted else ''}")
    order = turning.commanded.flights.get(entity)
    if not rebooted or order is None:
        return
    doubt(turning, entity)
    if flies(turning, entity):
        turning.command(order.command)
