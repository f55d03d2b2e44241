"""The pending requests η as a view over cells, and the queues of the three schedulers."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from semantics.races.provenance import NOTHING, Provenance
from semantics.state.cell_values import AGENTS, MONITOR, QUEUE, Cell, Cells, Changes, Edit
from semantics.state.requests import FLY, READY, SND, Request, request_key
from semantics.state.setting import Scheduler
from semantics.state.signature import Name
from semantics.state.views import CellView

if TYPE_CHECKING:
    from semantics.state.setting import Setting


def line_cell(agent: Name) -> Cell:
    """Address one agent's requests: in the order of asking, or sorted if the scheduler has no order."""
    return ("line", agent)


def sends_cell(agent: Name) -> Cell:
    """Address one agent's messages in transit, sorted: they are in no line."""
    return ("sends", agent)


class PendingRequest(NamedTuple):
    """A pending request: its cell, its position there, and its provenance."""

    request: Request
    cell: Cell
    position: int
    rests_on: Provenance


class Eta(CellView):
    """η over the cells of a configuration.

    Under `program_order` each agent has a line, under `unordered` a multiset. Under `fcfs` all agents share one queue
    of requests. READY and FLY are not served from it. They stay in their agent's own line, since their position among
    others' requests is not observable.
    """

    __slots__ = ("cells", "setting")
    SORTS = frozenset({"line", "sends", "queue"})

    def __init__(self, cells: Cells, setting: "Setting") -> None:
        self.cells = cells
        self.setting = setting

    def of(self, agent: Name) -> tuple[PendingRequest, ...]:
        """Return an agent's requests, in line if there is one."""
        return tuple(each for cell in self._cells(agent) for each in self._at(cell, agent))

    def all(self) -> tuple[PendingRequest, ...]:
        """Return all pending requests: the agents' by name, then the queue of `fcfs` in order of asking."""
        agents: tuple[Name, ...] = self.cells.read(AGENTS)
        if self._shares:
            return tuple(each for cell in (*map(line_cell, agents), QUEUE) for each in self._at(cell))
        return tuple(each for agent in agents for each in self.of(agent))

    def queued(self) -> tuple[PendingRequest, ...]:
        """Return the queue of `fcfs`, in order of asking."""
        return tuple(self._at(QUEUE))

    def own(self, agent: Name) -> tuple[PendingRequest, ...]:
        """Return the requests in an agent's own line, which has all READY and FLY."""
        return tuple(self._at(line_cell(agent)))

    def count(self, agent: Name) -> int:
        """Return the number of an agent's requests."""
        if not self._shares:
            return len(self.of(agent))
        in_queue: int = self.cells.ask(QUEUE, count_of, agent)
        return len(self.own(agent)) + in_queue

    def in_line(self, agent: Name) -> tuple[PendingRequest, ...]:
        """Return the requests of an agent that may be served next (under `fcfs` regardless of others' turns)."""
        asked = (*self.own(agent), *self._first_in_queue(agent)) if self._shares else self.of(agent)
        waiting = [each for each in asked if not isinstance(each.request, READY)]
        if self.setting.scheduler is Scheduler.UNORDERED:
            return tuple(waiting)
        line = [each for each in waiting if not isinstance(each.request, SND)]
        return (*line[:1], *(each for each in waiting if isinstance(each.request, SND)))

    def _first_in_queue(self, agent: Name) -> Iterator[PendingRequest]:
        """Yield an agent's messages in the queue, and the first of its other requests; rules need no more of it."""
        found: tuple[tuple[int, Request], ...] = self.cells.ask(QUEUE, first_of, agent)
        for position, request in found:
            kept = self.cells.read((MONITOR, *QUEUE))[position] if self.setting.monitored else NOTHING
            yield PendingRequest(request, QUEUE, position, kept)

    def ready(self, agent: Name) -> tuple[PendingRequest, ...]:
        """Return the observations of an agent that may be delivered next."""
        ready = tuple(each for each in self.own(agent) if isinstance(each.request, READY))
        return ready if self.setting.scheduler is Scheduler.UNORDERED else ready[:1]

    def adding(self, request: Request, rests_on: Provenance = NOTHING) -> Changes:
        """Return the writes of η + request."""
        cell = self._cell(request)
        if cell == QUEUE:
            return self._edit(appended, (request,), (rests_on,))
        return self._write(cell, [*self._at(cell), PendingRequest(request, cell, -1, rests_on)])

    def removing(self, pending: PendingRequest) -> Changes:
        """Return the writes of η − request."""
        if pending.cell == QUEUE:
            return self._edit(without, (pending.position,), (pending.position,))
        line = list(self._at(pending.cell))
        return self._write(pending.cell, line[: pending.position] + line[pending.position + 1 :])

    def replacing(
        self, pending: PendingRequest, request: Request, rests_on: Provenance | None = None
    ) -> Changes:
        """Return the writes that replace a request: in its place, or at the end of the new request's own line."""
        kept = pending.rests_on if rests_on is None else rests_on
        if self._cell(request) != pending.cell:
            return self.removing(pending) | self.adding(request, kept)
        line = list(self._at(pending.cell))
        line[pending.position] = PendingRequest(request, pending.cell, pending.position, kept)
        return self._write(pending.cell, line)

    @property
    def _shares(self) -> bool:
        """Whether all agents share one queue."""
        return self.setting.scheduler is Scheduler.FCFS

    def _cells(self, agent: Name) -> tuple[Cell, ...]:
        more = {Scheduler.FCFS: (QUEUE,), Scheduler.PROGRAM_ORDER: (sends_cell(agent),)}
        return (line_cell(agent), *more.get(self.setting.scheduler, ()))

    def _cell(self, request: Request) -> Cell:
        """Return the cell of a request."""
        if self._shares and not isinstance(request, READY | FLY):
            return QUEUE
        is_message = self.setting.scheduler is Scheduler.PROGRAM_ORDER and isinstance(request, SND)
        return sends_cell(request.agent) if is_message else line_cell(request.agent)

    def _at(self, cell: Cell, agent: Name | None = None) -> Iterator[PendingRequest]:
        """Yield the requests of a cell, of all agents or of one; a queue without requests of that agent is not read."""
        if cell == QUEUE and agent is not None and not self.cells.test(cell, is_asked_by, agent):
            return
        requests: tuple[Request, ...] = self.cells.read(cell)
        if not requests:
            return
        rests_on = (NOTHING,) * len(requests)
        if self.setting.monitored:
            rests_on = self.cells.read((MONITOR, *cell))
        for position, (request, kept) in enumerate(zip(requests, rests_on, strict=True)):
            if agent is None or request.agent == agent:
                yield PendingRequest(request, cell, position, kept)

    def _edit(self, edit: Edit, of_requests: tuple[Any, ...], of_provenance: tuple[Any, ...]) -> Changes:
        """Return the writes of a queue edit, which need not read the requests of others."""
        changes: Changes = {QUEUE: self.cells.edited(QUEUE, edit, *of_requests)}
        if self.setting.monitored:
            watch = (MONITOR, *QUEUE)
            changes[watch] = self.cells.edited(watch, edit, *of_provenance)
        return changes

    def _write(self, cell: Cell, line: list[PendingRequest]) -> Changes:
        if self.setting.scheduler is Scheduler.UNORDERED or cell[0] == "sends":
            line = sorted(
                line, key=lambda each: (request_key(each.request), sorted(map(repr, each.rests_on)))
            )
        changes: Changes = {cell: tuple(each.request for each in line)}
        if self.setting.monitored:
            changes[MONITOR, *cell] = tuple(each.rests_on for each in line)
        return changes


def is_asked_by(queue: tuple[Request, ...] | None, agent: Name) -> bool:
    """Whether an agent has a request in a queue; a question about a cell."""
    return any(each.agent == agent for each in queue or ())


def count_of(queue: tuple[Request, ...] | None, agent: Name) -> int:
    """Return the number of an agent's requests in a queue; a question about a cell."""
    return sum(each.agent == agent for each in queue or ())


def first_of(queue: tuple[Request, ...] | None, agent: Name) -> tuple[tuple[int, Request], ...]:
    """Return an agent's messages in a queue, and the first of its other requests, each with its position."""
    own = [(position, each) for position, each in enumerate(queue or ()) if each.agent == agent]
    first = next((each for each in own if not isinstance(each[1], SND)), None)
    return tuple(each for each in own if each is first or isinstance(each[1], SND))


def appended(line: tuple[Any, ...] | None, member: object) -> tuple[Any, ...]:
    """Return a line with one more member at its end."""
    return (*(line or ()), member)


def without(line: tuple[Any, ...], position: int) -> tuple[Any, ...]:
    """Return a line without the member at a position."""
    return line[:position] + line[position + 1 :]
