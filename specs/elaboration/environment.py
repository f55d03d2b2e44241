"""The environment phase: events without an agent."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import assert_never

from semantics.environment import Appears, Clause, Drops, Leaves, Says, Vanishes
from semantics.state.physical_model import Carried, Placed
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.constant_values import elaborate_constant
from specs.elaboration.drifts import Spots, drifts_among, drifts_within
from specs.elaboration.mobility import Mobility, carries
from specs.elaboration.names import Names
from specs.elaboration.world import InitialWorld


@dataclass(slots=True)
class _Clauses:
    """The state of the phase.

    Attributes:
        arriving: Entities whose flights always end.
        appearing: Entities that appear, each with a channel that it then is on.
        vanishing: Entities that vanish.
        positions: The position of each clause, by identity, since equal clauses may occur twice.
    """

    names: Names
    world: InitialWorld
    mobility: Mobility
    spots: Spots
    all: tuple[s.EnvironmentClause, ...]
    arriving: set[str] = field(default_factory=set)
    appearing: set[tuple[str, str]] = field(default_factory=set)
    vanishing: set[str] = field(default_factory=set)
    positions: dict[int, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for position, clause in enumerate(self.all):
            self.positions[id(clause)] = position
            if isinstance(clause, s.Appears):
                self.appearing |= {(clause.entity.text, channel.text) for channel in clause.channels}
            elif isinstance(clause, s.Vanishes):
                self.vanishing.add(clause.entity.text)


def elaborate_environment(
    mission: s.Mission, names: Names, world: InitialWorld, mobility: Mobility
) -> tuple[tuple[Clause, ...], tuple[s.Span, ...], frozenset[str]]:
    """Return the clauses of a mission with their spans, and the entities whose flights always end."""
    written = tuple(clause for section in mission.each(s.Environment) for clause in section.clauses)
    phase = _Clauses(names, world, mobility, Spots(names, world), written)
    _check_repeated(phase)
    clauses, spans = list[Clause](), list[s.Span]()
    for each in written:
        clause = _clause(phase, each)
        if clause is not None:
            clauses.append(clause)
            spans.append(each.span)
    return tuple(clauses), tuple(spans), frozenset(phase.arriving)


def appearing_channels(mission: s.Mission, names: Names) -> None:
    """Declare the channels that only appearing entities are on."""
    for section in mission.each(s.Environment):
        for clause in section.clauses:
            for channel in clause.channels if isinstance(clause, s.Appears) else ():
                if channel.text not in names.channels:
                    names.channels.add(channel.text)
                    names.declare("channel", channel.text, channel)


def _check_repeated(phase: _Clauses) -> None:
    seen: set[tuple[object, ...]] = set()
    for clause in phase.all:
        match clause:
            case s.DriftsAmong(entity) | s.DriftsWithin(entity):
                key, code = ("drifts", entity.text), Code.TWO_DRIFTS
            case s.Drops(channel):
                key, code = ("drops", channel.text), Code.REPEATED_SETTING
            case s.Leaves(entity, channel):
                key, code = ("leaves", f"{entity.text} {channel.text}"), Code.REPEATED_SETTING
            case s.Appears(entity):
                key, code = ("appears", entity.text), Code.REPEATED_SETTING
            case s.Vanishes(entity):
                key, code = ("vanishes", entity.text), Code.REPEATED_SETTING
            case s.Says() | s.Arrives() | s.Strays() | s.Misses():
                continue
            case _:
                assert_never(clause)
        if key in seen:
            phase.names.findings.add(
                code, clause, f"'{key[1]}' {key[0]} by two clauses", "make one of the two"
            )
        seen.add(key)


def _clause(phase: _Clauses, clause: s.EnvironmentClause) -> Clause | None:
    """Return the meaning of a clause; None if it has a mistake, or has no effect on P."""
    match clause:
        case s.DriftsAmong():
            return drifts_among(clause, phase.spots)
        case s.DriftsWithin():
            return drifts_within(clause, phase.spots, phase.mobility, phase.all)
        case s.Drops(channel):
            return Drops(channel.text, clause.returns) if phase.names.channel(channel) else None
        case s.Leaves():
            return _leaves(phase, clause)
        case s.Appears():
            return _appears(phase, clause)
        case s.Vanishes(entity):
            return Vanishes(entity.text) if phase.names.entity(entity) is not None else None
        case s.Says():
            return _says(phase, clause)
        case s.Arrives():
            _arrives(phase, clause)
            return None
        case s.Strays() | s.Misses():
            return None  # they are about no change: see `specs.elaboration.strays` and `misses`
        case _:
            assert_never(clause)


def _leaves(phase: _Clauses, clause: s.Leaves) -> Clause | None:
    kind, known = phase.names.entity(clause.entity), phase.names.channel(clause.channel)
    if kind is None or not known:
        return None
    entity, channel = clause.entity.text, clause.channel.text
    ever = channel in phase.world.channels.get(entity, ()) or (entity, channel) in phase.appearing
    if clause.returns and not ever:
        message = f"'{entity}' is not on '{channel}' and cannot return to it"
        phase.names.findings.add(
            Code.POINTLESS_CLAUSE, clause, message, f"write 'linked {channel}' where '{entity}' is declared"
        )
    return Leaves(entity, channel, clause.returns)


def _appears(phase: _Clauses, clause: s.Appears) -> Clause | None:
    known = phase.names.entity(clause.entity) is not None
    entity, world = clause.entity.text, phase.world
    if known and entity not in world.absent and entity not in phase.vanishing:
        message = f"'{entity}' is there already and never vanishes"
        hint = "declare it absent, or let it vanish"
        phase.names.findings.add(Code.POINTLESS_CLAUSE, clause, message, hint)
    placements = [_spot(phase, spot, entity) for spot in clause.placements]
    found = [placement for placement in placements if placement is not None]
    phase.spots.check_different(clause.placements, placements)
    channels = sorted({channel.text for channel in clause.channels}) or world.channels.get(entity, ())
    return Appears(entity, tuple(found), tuple(channels)) if found else None


def _spot(phase: _Clauses, spot: s.Placement | s.Name, entity: str) -> Placed | Carried | None:
    if isinstance(spot, s.Name) and carries(phase.names, spot.text, entity):
        placed = phase.spots.placed(spot, entity)
        return None if placed is None else Carried(spot.text, placed)
    return phase.spots.placed(spot, entity)


def _says(phase: _Clauses, clause: s.Says) -> Clause | None:
    message = elaborate_constant(clause.message, phase.names)
    agents = phase.names.agents
    if clause.recipient is not None:
        named = phase.names.agent(clause.recipient)
        known, agent = named is not None, named or ""
    else:
        known, agent = len(agents) == 1, min(agents, default="")
        if not known:
            several = f"there are {len(agents)} bigActors" if agents else "there is no bigActor"
            hint = f"write 'to' and one of {', '.join(sorted(agents)[:5])}" if agents else "declare one"
            phase.names.findings.add(Code.NO_RECIPIENT, clause, f"the recipient is missing: {several}", hint)
    return Says(message, agent, clause.times, phase.positions[id(clause)]) if known else None


def _arrives(phase: _Clauses, clause: s.Arrives) -> None:
    kind = phase.names.entity(clause.entity)
    if kind is not None and not phase.names.signature[kind].driven:
        message = f"'{clause.entity.text}' never flies: its kind {kind} is not driven"
        phase.names.findings.add(Code.POINTLESS_CLAUSE, clause, message, f"declare it: kind {kind} driven")
    phase.arriving.add(clause.entity.text)
