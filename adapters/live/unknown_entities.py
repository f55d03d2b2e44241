"""Strangers: entities that the mission does not name, seen in its places.

Any sender of positions can invent any number of strangers. So each plugin has a quota, and one step admits all
strangers of a turn: a step's cost grows with the number of entities.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from adapters.live.fallbacks import breaks
from adapters.live.flying import renew
from adapters.live.fresh_placements import Sighting
from adapters.live.step_taking import observe
from adapters.live.turn_in_progress import Turning
from semantics.observed_steps import Sight, happening
from semantics.state.cell_values import NAMES, Cell
from semantics.state.physical_model import Placed, Placement, channels_cell, placement_cell
from semantics.state.signature import REGION, Name

MOST_STRANGERS = 1_000
"""The most strangers."""

SHARE = MOST_STRANGERS // 2
"""The most strangers of one plugin, so that a flood on one feed leaves room for the others."""

MOST_PLACES = 60
"""The most places of one plugin: each observation compares entities with all places."""


def comes_in(turning: Turning, plugin: str, found: Sighting) -> bool:
    """Return whether an entity is of a kind of the mission and in one of its places, and there is room for it."""
    entity, kind, c = found.property.entity, found.property.kind, turning.c
    at = _placed(found)
    if kind not in c.setting.signature.kinds or not turning.around(entity, kind, at):
        return False
    is_place = not at.geometry.is_point and bool(c.setting.signature[kind].contains)
    taken, places = turning.sightings.admitted.get(plugin, (0, 0))
    full = taken >= SHARE or sum(share for share, _ in turning.sightings.admitted.values()) >= MOST_STRANGERS
    if full or (is_place and places >= MOST_PLACES):
        what = f"{taken:,} entities" if full else f"{places} places"
        message = f"'{plugin}': {what} that the mission does not name are taken in; more are ignored"
        turning.find("trouble", plugin, message, once=True)
        return False
    turning.sightings = turning.sightings.admitting(plugin, is_place=is_place)
    return True


def place_strangers(turning: Turning, entities: Iterable[Name]) -> None:
    """Place all seen strangers, in one step. Their contents are not compared: their presence breaks enough."""
    kinds, physical = turning.c.setting.kinds, turning.c.structure.physical
    writes: dict[Cell, object] = {}
    admits: dict[Name, str] = {}
    broken: list[str] = []
    placed: list[tuple[Name, str]] = []
    for entity in entities:
        sighting = turning.sightings.newest[entity]
        here, seen = physical.placement(entity), _placed(sighting)
        if sighting.until <= turning.now or here == seen or _grows(here, seen):
            continue
        kind = kinds.get(entity, sighting.property.kind)
        around, before = turning.around(entity, kind, seen), turning.around(entity, kind, here)
        if (
            isinstance(here, Placed)
            and here.geometry.is_point
            and seen.geometry.is_point
            and around == before
        ):
            continue
        writes[placement_cell(entity)] = seen
        where = ", ".join(sorted(around))
        placed.append(
            (entity, f"{entity} {'appears in' if here is None else 'is seen in'} {where or REGION}")
        )
        if here is None:
            writes[channels_cell(entity)] = ()
        if entity not in kinds:
            admits[entity] = kind
        if entity not in kinds or (here is not None and around != before):  # a returning one is not new
            broken.append(f"{entity} ({kind}) is in {where or 'none of the places'}")
    _happen(turning, Sight(_together([words for _, words in placed]), writes, admits))
    if broken:
        breaks(turning, f"{_together(broken)}; the mission names no such entity", placed[0][0])
    for entity, _ in placed:
        if not turning.sightings.newest[entity].property.geometry.is_point:
            renew(turning, entity)


def remove_strangers(turning: Turning, entities: Iterable[Name]) -> None:
    """Remove from P the strangers that are no longer seen, and their cargo, in one step."""
    physical = turning.c.structure.physical
    gone = {entity for entity in entities if entity in physical}
    if not gone:
        return
    setting = turning.c.setting
    carriers = {entity for entity in gone if setting.signature[setting.kind(entity)].carries}  # mostly none
    names = turning.c.read(NAMES) if carriers else ()
    carried = {name for name in names if not carriers.isdisjoint(physical.carriers(name))}
    writes: dict[Cell, object] = {placement_cell(name): None for name in gone | carried}
    writes |= {channels_cell(name): () for name in gone | carried}
    _happen(turning, Sight(_together([f"{entity} vanishes" for entity in sorted(gone)]), writes))


def _placed(sighting: Sighting) -> Placed:
    """Return the placement of a stranger; a report that it is carried is ignored, since it cannot be checked."""
    return Placed(sighting.property.geometry)


def _grows(here: Placement | None, seen: Placed) -> bool:
    """Return whether a point has become a place, which has another quota."""
    return isinstance(here, Placed) and here.geometry.is_point and not seen.geometry.is_point


def _happen(turning: Turning, sight: Sight) -> None:
    if sight.writes:
        observe(turning, sight, happening(turning.c, sight))


def _together(words: Sequence[str]) -> str:
    """Describe an event of several entities by the first.

    >>> _together(["a vanishes", "b vanishes", "c vanishes"])
    'a vanishes, and so on for 2 more'
    """
    return "".join(words[:1]) + (f", and so on for {len(words) - 1:,} more" if len(words) > 1 else "")
