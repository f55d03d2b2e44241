"""A proposed signature for a mission without one, from the use of its entities."""

from __future__ import annotations

from collections.abc import Iterator

from semantics.state.signature import Kind
from specs import syntax as s


def proposed(mission: s.Mission, kinds: tuple[str, ...]) -> tuple[Kind, ...]:
    """Return the proposed kinds: those with areas contain all, those of moving hosts are driven, carriers carry."""
    entities = tuple(
        entry for world in mission.each(s.World) for entry in world.entries if isinstance(entry, s.Entity)
    )
    there = frozenset(entity.kind.text for entity in entities)
    areas = {
        entity.kind.text
        for entity in entities
        if entity.placement is not None and not isinstance(entity.placement.geometry, s.Point)
    }
    kind_of = {entity.name.text: entity.kind.text for entity in entities}
    driven = {kind_of[name] for name in _movers(mission) if name in kind_of} - areas
    return tuple(
        Kind(kind, there if kind in areas else frozenset(), _cargo(kind, entities, kind_of), kind in driven)
        for kind in kinds
    )


def _movers(mission: s.Mission) -> Iterator[str]:
    """Yield the hosts of bigActors that move them or call a behaviour, and entities that are moved by name."""
    for actor in mission.each(s.BigActor):
        parts = tuple(s.walk(actor))
        commands = {part.name for part in parts if isinstance(part, s.Command)}
        moves = "MOVE_HOST_TO" in commands or any(isinstance(part, s.Call) for part in parts)
        yield from [actor.host.text] if moves else []
    for part in s.walk(mission):
        if isinstance(part, s.Command) and part.name == "MOVE" and isinstance(part.operands[0], s.Name):
            yield part.operands[0].text


def _cargo(kind: str, entities: tuple[s.Entity, ...], kind_of: dict[str, str]) -> frozenset[str]:
    return frozenset(
        entity.kind.text
        for entity in entities
        if entity.carrier is not None and kind_of.get(entity.carrier.text) == kind
    )
