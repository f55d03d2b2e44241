"""The pending requests η as a view over cells, and the lines in which the three schedulers serve them."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from semantics.cells import AGENTS, MONITOR, QUEUE, Cell, Cells, Changes
from semantics.provenance import NOTHING, Provenance
from semantics.requests import READY, SND, Request, request_key
from semantics.setting import Scheduler
from semantics.signature import Name

if TYPE_CHECKING:
    from semantics.setting import Setting


def line_cell(agent: Name) -> Cell:
    """Address one agent's requests: in the order asked, sorted where the scheduler knows no order."""
    return ("line", agent)


def sends_cell(agent: Name) -> Cell:
    """Address one agent's messages on their way, sorted: they stand in no line."""
    return ("sends", agent)


class Pending(NamedTuple):
    """A request where it stands: its cell, its position there, and what it rests on."""

    request: Request
    cell: Cell
    position: int
    rests_on: Provenance


class Eta:
    """η over the cells of a configuration.

    Under `program_order` each agent has a line, under `unordered` a multiset, under `fcfs` all share one queue.
    """

    __slots__ = ("cells", "setting")

    def __init__(self, cells: Cells, setting: "Setting") -> None:
        self.cells = cells
        self.setting = setting

    def of(self, agent: Name) -> tuple[Pending, ...]:
        """Return an agent's requests, in line where there is one."""
        return tuple(each for cell in self._cells(agent) for each in self._at(cell, agent))

    def all(self) -> tuple[Pending, ...]:
        """Return every pending request: the agents' in order of their names, under `fcfs` as asked."""
        if self.setting.scheduler is Scheduler.FCFS:
            return tuple(self._at(QUEUE))
        return tuple(each for agent in self.cells.read(AGENTS) for each in self.of(agent))

    def in_line(self, agent: Name) -> tuple[Pending, ...]:
        """Return the requests of an agent that may be served next (under `fcfs` apart from others' turns)."""
        waiting = [each for each in self.of(agent) if not isinstance(each.request, READY)]
        if self.setting.scheduler is Scheduler.UNORDERED:
            return tuple(waiting)
        line = [each for each in waiting if not isinstance(each.request, SND)]
        return (*line[:1], *(each for each in waiting if isinstance(each.request, SND)))

    def ready(self, agent: Name) -> tuple[Pending, ...]:
        """Return the observations of an agent that may be delivered next."""
        ready = tuple(each for each in self.of(agent) if isinstance(each.request, READY))
        return ready if self.setting.scheduler is Scheduler.UNORDERED else ready[:1]

    def adding(self, request: Request, rests_on: Provenance = NOTHING) -> Changes:
        """Write η + request."""
        cell = self._cells(request.agent)[-1 if isinstance(request, SND) else 0]
        return self._write(cell, [*self._at(cell), Pending(request, cell, -1, rests_on)])

    def removing(self, pending: Pending) -> Changes:
        """Write η − request."""
        line = list(self._at(pending.cell))
        return self._write(pending.cell, line[: pending.position] + line[pending.position + 1 :])

    def replacing(self, pending: Pending, request: Request, rests_on: Provenance | None = None) -> Changes:
        """Write η with another request in the place of one."""
        line = list(self._at(pending.cell))
        kept = pending.rests_on if rests_on is None else rests_on
        line[pending.position] = Pending(request, pending.cell, pending.position, kept)
        return self._write(pending.cell, line)

    def _cells(self, agent: Name) -> tuple[Cell, ...]:
        if self.setting.scheduler is Scheduler.FCFS:
            return (QUEUE,)
        if self.setting.scheduler is Scheduler.UNORDERED:
            return (line_cell(agent),)
        return (line_cell(agent), sends_cell(agent))

    def _at(self, cell: Cell, agent: Name | None = None) -> Iterator[Pending]:
        """Yield what stands in a cell, everybody's or one agent's."""
        requests: tuple[Request, ...] = self.cells.read(cell)
        if not requests:
            return
        rests_on = (NOTHING,) * len(requests)
        if self.setting.monitored:
            rests_on = self.cells.read((MONITOR, *cell))
        for position, (request, kept) in enumerate(zip(requests, rests_on, strict=True)):
            if agent is None or request.agent == agent:
                yield Pending(request, cell, position, kept)

    def _write(self, cell: Cell, line: list[Pending]) -> Changes:
        if self.setting.scheduler is Scheduler.UNORDERED or cell[0] == "sends":
            line = sorted(
                line, key=lambda each: (request_key(each.request), sorted(map(repr, each.rests_on)))
            )
        changes: Changes = {cell: tuple(each.request for each in line)}
        if self.setting.monitored:
            changes[MONITOR, *cell] = tuple(each.rests_on for each in line)
        return changes
