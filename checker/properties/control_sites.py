"""The possible sites of a control's request in the mission's text; findings with equal sites are grouped."""

from functools import lru_cache

from semantics.analysis.traversal import reachable
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Block, ControlBy, Spawn
from semantics.races.relevance import Names, hosts_of, requested
from semantics.state.configuration import Configuration
from semantics.state.requests import CTR, FLY
from semantics.state.setting import Setting
from semantics.state.signature import Name

Site = int
"""The line of a `control`; for one without a line its number, negative."""


def common_sites(c: Configuration, *requests: CTR | FLY) -> tuple[tuple[Site, ...], ...] | None:
    """Return the possible sites of each of some controls, in order; None if some are unknown.

    Each control has one site, unless the text contains the same control several times.
    """
    found = sorted(
        _sites(c.setting, each.agent, hosts_of(c, each.agent), str(each.reaction)) for each in requests
    )
    return tuple(found) if all(found) else None


@lru_cache(maxsize=1 << 12)
def _sites(setting: Setting, agent: Name, hosts: Names, control: str) -> tuple[Site, ...]:
    found = (
        setting.program.line(number) or -1 - number
        for number in _runs(setting.program, agent)
        if control in _may_ask(setting, number, hosts)
    )
    return tuple(sorted(set(found)))


@lru_cache(maxsize=1 << 10)
def _may_ask(setting: Setting, number: int, hosts: Names) -> frozenset[str]:
    """Return the controls that a statement may request; empty if it has too many combinations of arguments."""
    statement = setting.program.statements[number]
    found = requested(setting, statement, hosts) if isinstance(statement, ControlBy) else None
    return frozenset(map(str, found or ()))


@lru_cache(maxsize=1 << 8)
def _runs(program: Program, agent: Name) -> frozenset[int]:
    """Return the statements that an agent may run; all of them if the text does not name it."""
    begun = [program.bodies[agent]] if agent in program.bodies else list(_spawned(program, agent))
    return frozenset[int]().union(*(reachable(program, block) for block in begun))


def _spawned(program: Program, agent: Name) -> tuple[Block, ...]:
    spawns = (each for each in program.statements if isinstance(each, Spawn) and each.name == agent)
    found = tuple(program.behaviours[each.behaviour].body for each in spawns)
    return found or (tuple(range(len(program.statements))),)
