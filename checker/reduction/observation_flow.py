"""Informants: the agents that may pass on their observations.

A message or a spawned agent carries its sender's provenance, if the sender had observed anything. In many missions no
sender had: agents first agree, then observe and move.
"""

from collections.abc import Iterator

from semantics.analysis.overapproximation import Names
from semantics.analysis.traversal import reachable
from semantics.analysis.value_flow import ValueFlow
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Block, Observe, React
from semantics.races.relevance import tells
from semantics.state.configuration import Configuration
from semantics.state.requests import OBS
from semantics.state.signature import Name


def tellers(initial: Configuration, roles: ValueFlow) -> Names:
    """Return the agents that may pass on observations, their own or received ones."""
    first = frozenset(_tellers(initial, roles, (Observe,)))
    return frozenset(_tellers(initial, roles, (Observe, React))) if first else first


def _tellers(initial: Configuration, roles: ValueFlow, sources: tuple[type, ...]) -> Iterator[Name]:
    """Yield the agents that may tell after a statement by which observations come, or with such a message."""
    for agent in roles.agents:
        if agent not in roles.first:
            may_tell = tells(roles.program, roles[agent].statements)
        else:
            looking = any(isinstance(each.request, OBS) for each in initial.eta.of(agent))
            may_tell = _tells_after(
                roles.program, initial.alpha.code(agent), sources, observed=looking or React in sources
            )
        if may_tell:
            yield agent


def _tells_after(program: Program, code: Block, sources: tuple[type, ...], *, observed: bool) -> bool:
    """Return whether code may tell after it has observed; the order inside a statement does not count."""
    for number in code:
        inside = reachable(program, (number,))
        observed |= any(isinstance(program.statements[each], sources) for each in inside)
        if observed and tells(program, inside):
            return True
    return False
