"""The initial configuration of a mission: L₀ = A(P₀), unless the mission declares beliefs."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import assert_never

from semantics.behaviours.process_conversion import new_process, starting
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.agents import Code
from semantics.state.cell_values import AGENTS, NAMES, QUEUE, Changes
from semantics.state.configuration import Configuration
from semantics.state.logical_model import links_cell, parent_cell
from semantics.state.physical_model import Placement, channels_cell, down_cell, placement_cell
from semantics.state.setting import Scheduler, Setting
from semantics.state.signature import Name


@dataclass(frozen=True, slots=True)
class Beliefs:
    """The differences of L₀ from A(P₀).

    Attributes:
        parents: The believed parent of a node, None if the node is not in L₀.
        links: The believed links of a node.
    """

    parents: Mapping[Name, Name | None] = field(default_factory=dict)
    links: Mapping[Name, Iterable[Name]] = field(default_factory=dict)


def initial(
    setting: Setting,
    placements: Mapping[Name, Placement],
    channels: Mapping[Name, Iterable[Name]],
    agents: Mapping[Name, tuple[Name, Code]],
    beliefs: Beliefs | None = None,
) -> Configuration:
    """Return the initial configuration of a mission.

    Args:
        setting: The constants of the mission.
        placements: P₀ of the present entities; the setting's other entities are absent.
        channels: The channels of the present entities.
        agents: The host and the initial code of each agent.
        beliefs: The differences of L₀ from A(P₀).
    """
    contents: Changes = {NAMES: tuple(sorted(setting.kinds)), AGENTS: tuple(sorted(agents))}
    for name in setting.kinds:
        contents[placement_cell(name)] = placements.get(name)
        contents[channels_cell(name)] = tuple(sorted(channels.get(name, ())))
    for clause in setting.environment:
        contents |= _remembered(clause)
    if setting.timing is not None:
        from semantics.timing.flight_history import remembered_at_first  # noqa: PLC0415 - geometry takes its time to load

        contents |= remembered_at_first(setting)
    for agent, (host, code) in sorted(agents.items()):
        contents |= starting(setting, agent, host, new_process(setting, agent, host, code))
    if setting.scheduler is Scheduler.FCFS:
        contents[QUEUE] = ()
        contents |= {("watch", *QUEUE): ()} if setting.monitored else {}
    return _believing(Configuration.of(setting, contents), beliefs or Beliefs())


def _remembered(clause: Clause) -> Changes:
    """Return the initial cells of a clause of the environment."""
    match clause:
        case Drops(channel):
            return {down_cell(channel): False}
        case Leaves():
            return {clause.left: False}
        case Says():
            return {clause.counter: clause.times}
        case Drifts() | Appears() | Vanishes():
            return {}
        case _:
            assert_never(clause)


def _believing(c: Configuration, beliefs: Beliefs) -> Configuration:
    physical = c.structure.physical
    slots: Changes = {}
    parents = physical.abstract_parents()
    for name in c.setting.kinds:
        slots[parent_cell(name)] = parents.get(name)
        slots[links_cell(name)] = physical.links(name) if name in parents else ()
    slots |= {parent_cell(name): parent for name, parent in beliefs.parents.items()}
    slots |= {links_cell(name): tuple(sorted(links)) for name, links in beliefs.links.items()}
    slots |= {links_cell(name): () for name, parent in beliefs.parents.items() if parent is None}
    return c.with_(slots)
