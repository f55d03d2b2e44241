"""The agents α as a view over cells, and the race monitor's watch beside each."""

from dataclasses import dataclass, replace

from semantics.behaviours.values import Value, order_key
from semantics.races.provenance import NOTHING, Provenance
from semantics.state.cell_values import AGENTS, MONITOR, Cell, Cells, Changes, has
from semantics.state.signature import Name
from semantics.state.views import CellView

Code = tuple[int, ...]
"""The code left to run: statements by number in the program, the next one first."""

Store = tuple[tuple[str, Value], ...]
"""The variables that the code may read, or that properties mention, sorted."""


def written(variable: str) -> str:
    """Return a variable's name as the programmer wrote it; empty for a generated variable.

    >>> written("obs#2"), written("#1")
    ('obs', '')
    """
    return variable.partition("#")[0]


@dataclass(frozen=True, slots=True)
class AgentProvenance:
    """The provenance of an agent's code, variables, mail and host; each part is parallel to its cell.

    Attributes:
        code: For each statement left to run, the provenance of the tests that led to it.
        store: For each variable, the provenance of its value.
        mailbox: For each message, the provenance of its content and its sending.
        host: The provenance of the choice of its host.
        begun: The loops that it is in, each by the number of statements behind it in the code, sorted. The next turn of
            such a loop does not depend on the tests of this turn.
    """

    code: tuple[Provenance, ...] = ()
    store: tuple[Provenance, ...] = ()
    mailbox: tuple[Provenance, ...] = ()
    host: Provenance = NOTHING
    begun: tuple[int, ...] = ()


def host_cell(agent: Name) -> Cell:
    """Address the host of an agent."""
    return ("host", agent)


def code_cell(agent: Name) -> Cell:
    """Address the code that an agent has left to run."""
    return ("code", agent)


def is_over(code: Code | None) -> bool:
    """Whether no code is left to run; a question about a cell."""
    return not code


def store_cell(agent: Name) -> Cell:
    """Address an agent's variables."""
    return ("store", agent)


def mailbox_cell(agent: Name) -> Cell:
    """Address the messages delivered to an agent and not yet received: a sorted tuple."""
    return ("mailbox", agent)


def watch_cell(agent: Name) -> Cell:
    """Address an agent's `AgentProvenance`; a monitor cell."""
    return (MONITOR, "agent", agent)


class Agents(CellView):
    """α over the cells of a configuration."""

    __slots__ = ("cells",)
    SORTS = frozenset({"agents", "host", "code", "store", "mailbox"})

    def __init__(self, cells: Cells) -> None:
        self.cells = cells

    def names(self) -> tuple[Name, ...]:
        """Return the agents, sorted."""
        names: tuple[Name, ...] = self.cells.read(AGENTS)
        return names

    def __contains__(self, agent: Name) -> bool:
        return self.cells.test(AGENTS, has, agent)

    def host(self, agent: Name) -> Name:
        """Return the host of an agent."""
        host: Name = self.cells.read(host_cell(agent))
        return host

    def code(self, agent: Name) -> Code:
        """Return the code that an agent has left to run; empty if it has ended."""
        code: Code = self.cells.read(code_cell(agent))
        return code

    def store(self, agent: Name) -> Store:
        """Return an agent's variables."""
        store: Store = self.cells.read(store_cell(agent))
        return store

    def mailbox(self, agent: Name) -> tuple[Value, ...]:
        """Return the messages of an agent's mailbox, sorted: they have no order of arrival."""
        mailbox: tuple[Value, ...] = self.cells.read(mailbox_cell(agent))
        return mailbox

    def watch(self, agent: Name) -> AgentProvenance | None:
        """Return the monitor's memory of an agent, None if the monitor is off."""
        watch: AgentProvenance | None = self.cells.read(watch_cell(agent))
        return watch

    def hosted(self, node: Name) -> tuple[Name, ...]:
        """Return the agents hosted at a node, sorted."""
        return tuple(agent for agent in self.names() if self.host(agent) == node)

    def hosting(self, agent: Name, host: Name, rests_on: Provenance = NOTHING) -> Changes:
        """Return the writes of host(agent) ↦ host."""
        watch = self.watch(agent)
        changes: Changes = {host_cell(agent): host}
        return changes if watch is None else {**changes, watch_cell(agent): replace(watch, host=rests_on)}

    def posting(self, agent: Name, message: Value, rests_on: Provenance = NOTHING) -> Changes:
        """Return the writes of mailbox(agent) + message."""
        watch = self.watch(agent)
        mail = (
            list(zip(self.mailbox(agent), watch.mailbox, strict=True))
            if watch
            else [(m, NOTHING) for m in self.mailbox(agent)]
        )
        return self._mail(agent, [*mail, (message, rests_on)])

    def taking(self, agent: Name, position: int) -> Changes:
        """Return the writes of mailbox(agent) without the message at a position."""
        watch = self.watch(agent)
        kept = watch.mailbox if watch else (NOTHING,) * len(self.mailbox(agent))
        mail = list(zip(self.mailbox(agent), kept, strict=True))
        return self._mail(agent, mail[:position] + mail[position + 1 :])

    def _mail(self, agent: Name, mail: list[tuple[Value, Provenance]]) -> Changes:
        mail.sort(key=lambda item: (order_key(item[0]), sorted(map(str, item[1]))))
        changes: Changes = {mailbox_cell(agent): tuple(message for message, _ in mail)}
        watch = self.watch(agent)
        if watch is not None:
            changes[watch_cell(agent)] = replace(watch, mailbox=tuple(kept for _, kept in mail))
        return changes
