"""Steps decided by the world: an observation causes `env` or `commit`, and is stored so that they can be replayed.

In a live mission, positions of vehicles and spills are observed, not computed. An observation maps cells of P to
observed values. The rules are the verified ones; they decide whether an observation is a step.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from semantics.behaviours.reaction_rules import moved
from semantics.drive import Reach
from semantics.environment import Observed
from semantics.rules import commit, env
from semantics.state.cell_values import NAMES, Cell, Changes, Row
from semantics.state.configuration import Configuration, Transition
from semantics.state.logical_model import links_cell, parent_cell
from semantics.state.physical_model import (
    Carried,
    InTransit,
    PhysicalModel,
    Placement,
    channels_cell,
    placement_cell,
)
from semantics.state.requests import FLY, Request
from semantics.state.signature import Name
from semantics.state.station_partition import Elsewhere, passing
from semantics.successors import remembered

WRITABLE = frozenset({"placement", "channels", "left", "down"})
"""The first words of the cells that an observation may write: those of P, and of the environment's clauses."""


@dataclass(frozen=True, slots=True)
class Sight:
    """One observation: changes of P seen together.

    Attributes:
        words: The description, as in labels of `env`.
        writes: The observed cells of P, with their values.
        admits: The kinds of new entities: seen now, and not named by the mission.
    """

    words: str
    writes: Mapping[Cell, Any] = field(default_factory=dict)
    admits: Mapping[Name, str] = field(default_factory=dict)


def happening(c: Configuration, sight: Sight) -> Iterator[Transition]:
    """Yield the `env` step of an observation; only `commit` may place an entity in transit."""
    there = admitting(c, sight.admits)
    if all(_is_free(there, cell, value) for cell, value in sight.writes.items()):
        observed = Observed(sight.words, tuple(sorted(sight.writes.items(), key=_by_cell)))
        yield from (remembered(there, step) for step in env(there, observed))


def arriving(c: Configuration, a: Name, sight: Sight) -> Iterator[Transition]:
    """Yield the `commit` step of an agent's flight that ends at its observed placement."""
    yield from (remembered(c, step) for step in commit(c, a, reaching(sight.writes)))


def steps_seen(c: Configuration, sight: Sight | Elsewhere, agents: Iterable[Name]) -> Iterator[Transition]:
    """Yield the steps that an observation may cause: events, the ends of agents' flights, messages between stations."""
    if not isinstance(sight, Sight):
        yield from passing(c, sight)
        return
    yield from happening(c, sight)
    if not sight.admits:
        for agent in agents:
            yield from arriving(c, agent, sight)


def reaching(writes: Mapping[Cell, Any]) -> Reach:
    """Return a `Reach` that places a traveller at its observed placement, and nowhere if it was not observed."""

    def reach(_physical: PhysicalModel, node: Name, place: Name) -> Placement | None:
        placement: Placement | None = writes.get(placement_cell(node))
        return None if isinstance(placement, Carried) and placement.by != place else placement

    return reach


def admitting(c: Configuration, kinds: Mapping[Name, str]) -> Configuration:
    """Return the configuration with more entities in its setting; they are still absent from L and P."""
    new = {name: kind for name, kind in sorted(kinds.items()) if name not in c.setting.kinds}
    if not new:
        return c
    cells: Changes = {NAMES: tuple(sorted((*c.read(NAMES), *new)))}
    for name in new:
        cells |= {
            placement_cell(name): None,
            channels_cell(name): (),
            parent_cell(name): None,
            links_cell(name): (),
        }
    assert isinstance(c.state, Row)
    return Configuration(c.setting.naming(new), c.state.growing(cells))


def _is_free(c: Configuration, cell: Cell, value: Any) -> bool:
    known = cell[0] in WRITABLE and (cell[0] == "down" or cell[1] in c.setting.kinds)
    if not known or cell[0] != "placement":
        return known
    if isinstance(value, InTransit) and value.to not in c.setting.kinds:
        return False
    physical = c.structure.physical
    if not isinstance(physical.placement(cell[1]), InTransit):
        return physical.transit(cell[1]) is None
    return not any(_flies(pending.request, cell[1]) for pending in c.eta.all())  # another station sent it


def _flies(request: Request, name: Name) -> bool:
    return isinstance(request, FLY) and any(
        node == name for node, _ in moved(request.reaction, request.match)
    )


def _by_cell(item: tuple[Cell, Any]) -> Cell:
    return item[0]
