"""Inspections of single configurations: local consistency, deadlock, invariants, reachability, computation."""

from collections.abc import Callable, Iterable, Iterator
from enum import Enum, auto
from functools import partial
from itertools import chain
from operator import itemgetter
from typing import ClassVar, NamedTuple

from checker.properties.blocked_controls import lacking
from checker.properties.control_sites import common_sites
from checker.properties.deadlock_causes import causes
from checker.properties.findings import MOST_VIOLATIONS, Collected, Inspected, Key
from checker.properties.invariant_vacuity import Valuations
from semantics.behaviours.expressions import Fault
from semantics.behaviours.patterns import bind
from semantics.behaviours.process_conversion import next_statement
from semantics.behaviours.statements import Block, Call, Loop, React
from semantics.control import Obstacle, obstacle
from semantics.environment import Says
from semantics.fixpoints import closure
from semantics.properties.propositions import Proposition, counterexample_names, holds
from semantics.state.cell_values import QUEUE
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import CTR, FLY, MGR, OBS, SND
from semantics.state.setting import Control, Setting
from semantics.state.signature import Name
from semantics.successors import Expansion, moves, served
from semantics.timing.arrivals import is_unfair

Rules = Callable[[Configuration, Name], Iterable[Transition | Fault]]
"""A rule: yields the steps of an agent."""

Wait = tuple[int, str]
"""An awaited event in words, after its rank among those of all agents."""

WORDS = {
    Obstacle.UNMATCHED: "its redex matches nothing in L",
    Obstacle.INCONSISTENT: "L no longer agrees with P: no observation followed the change",
    Obstacle.UNREALISABLE: "no physical change makes its reactum true",
}


class Excerpt(NamedTuple):
    """Some agents of a configuration, and the transitions that the rules allow them."""

    c: Configuration
    agents: tuple[Name, ...]
    steps: Expansion


class InTime(Enum):
    """The view of a configuration that an inspection gets, for a mission with timing."""

    ENABLED = auto()
    """All transitions that the rules allow there, at any time."""
    TAKEN = auto()
    """The transitions that are taken there at some time."""
    TOGETHER = auto()
    """Pairs of controls that may be served at the same moment, one pair at a time."""


class Inspection:
    """Inspects configurations one by one, and collects the findings on one property.

    Its questions are written once, for excerpts. If each configuration is inspected, an excerpt has all agents.
    Explorers with rows ask about each agent separately, and inspect only the first configuration of each answer.

    Attributes:
        alone: The rules whose steps determine an agent's subjects (`seen`); empty for none.
        together: The rules whose steps determine whether an agent must move (`still`); empty if that is irrelevant.
        in_turn: Whether it depends on turns, which a single agent doesn't determine.
        in_time: Its view of configurations, for a mission with timing.
        collected: The findings.
    """

    alone: ClassVar[tuple[Rules, ...]] = ()
    together: ClassVar[tuple[Rules, ...]] = ()
    in_turn: ClassVar[bool] = False
    in_time: ClassVar[InTime] = InTime.ENABLED

    def __init__(self, most: int = MOST_VIOLATIONS) -> None:
        self.collected = Collected(most)

    def __call__(self, number: int, c: Configuration, expansion: Expansion) -> None:
        """Inspect a configuration."""
        whole = Excerpt(c, c.alpha.names(), expansion)
        still = self.still(whole)
        for seen in chain(self.seen(whole), () if still is None else self.judged(still, c)):
            self.collected.note(number, seen)

    def concerns(self, _: Setting) -> bool:
        """Return whether a mission may have any subject of the inspection."""
        return True

    def seen(self, _: Excerpt) -> Iterator[Inspected]:
        """Yield the subjects of some agents."""
        yield from ()

    def still(self, _: Excerpt) -> tuple[Wait, ...] | None:
        """Return the awaited events of some agents, None if one of them must move."""
        return None

    def judged(self, _: Iterable[Wait], __: Configuration | None = None, /) -> Iterator[Inspected]:
        """Yield the subjects of a configuration where no agent must move, from all awaited events."""
        yield from ()


class LocalConsistency(Inspection):
    """For every control next in its agent's line some match is consistent and realisable (semantics.md, check 1)."""

    alone = (served,)

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield every control that is next in line."""
        done = {t.served.request: t for t in of.steps.enabled if t.served is not None}
        for request in (each.request for a in of.agents for each in of.c.eta.in_line(a)):
            if isinstance(request, CTR | FLY):
                hindered = None if request in done else obstacle(of.c, request)
                yield (
                    Inspected(by=done.get(request))
                    if hindered is None
                    else _hindered(of.c, request, hindered)
                )


def _hindered(c: Configuration, request: CTR | FLY, by: Obstacle) -> Inspected:
    message = f"{request} is {by.value}: {WORDS[by]}"
    return Inspected(
        (by.value, str(request)),
        None,
        message,
        lambda: (*lacking(c, request, by), *disagreements(c, request)),
        lambda: common_sites(c, request),
    )


def disagreements(c: Configuration, request: CTR | FLY) -> tuple[str, ...]:
    """Return in words the differences between L and P about the nodes that a control names."""
    structure = c.structure
    lines = []
    for node in sorted({node for node in request.reaction.redex.nodes if isinstance(node, str)}):
        if node not in structure.physical:
            lines.append(f"{node}: believed in {structure.logical.parent(node) or 'no place'}, actually gone")
            continue
        believed, actual = structure.logical.parent(node), structure.physical.abstract_parent(node)
        links, seen = structure.logical.links(node), structure.physical.links(node)
        if believed != actual:
            lines.append(f"{node}: believed in {believed or 'no place'}, actually in {actual}")
        if links != seen:
            believed_on, on = (", ".join(each) or "no link" for each in (links, seen))
            lines.append(f"{node}: believed on {believed_on}, actually on {on}")
    return tuple(lines)


class DeadlockFreedom(Inspection):
    """No configuration where only the environment can move, and a request is pending or an agent waits (check 3)."""

    together = (served, moves)

    def still(self, of: Excerpt) -> tuple[Wait, ...] | None:
        """Return the pending requests, in the order of any queue, the waiting agents, and the failed ones."""
        if of.steps.by_agents:
            return None
        failed = ((2 * LAST, f"{fault.agent} failed") for fault in of.steps.faults)
        return (*stuck_requests(of), *waiting_agents(of), *failed)

    def judged(self, still: Iterable[Wait], c: Configuration | None = None, /) -> Iterator[Inspected]:
        """Yield a deadlock if anything is left to be done."""
        who = "; ".join(words for _, words in sorted(still, key=itemgetter(0)))
        message = f"only the environment can move, and {who}"
        left = tuple(sorted(who.split("; ")))
        yield (
            Inspected(("deadlock", who), None, message, partial(_causes, c), lambda: left)
            if who
            else Inspected()
        )


class Arrival(Inspection):
    """No run waits for ever for the end of a flight."""

    alone = (served,)
    together = (served, moves)

    def concerns(self, setting: Setting) -> bool:
        """Return whether there are flights."""
        return setting.control is Control.TIMED

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield every end of a flight."""
        yield from (Inspected(by=step) for step in of.steps.by_agents if step.label.rule == "commit")

    def still(self, of: Excerpt) -> tuple[Wait, ...] | None:
        """Return the awaited ends of flights."""
        fair = any(not is_unfair(of.c, step) for step in of.steps.by_agents)
        return None if fair else tuple((0, str(step.label)) for step in of.steps.by_agents)

    def judged(self, still: Iterable[Wait], _: Configuration | None = None, /) -> Iterator[Inspected]:
        """Yield a violation if flights are awaited that may never end."""
        waits = ", ".join(sorted({words for _, words in still}))
        if waits:
            yield Inspected(("not arrived", waits), None, f"a run may wait here for ever for {waits}")


LAST = 1 << 30
"""The rank after everything pending."""


def stuck_requests(of: Excerpt) -> Iterator[Wait]:
    """Yield in words the pending requests, except received or forgotten READY."""
    for pending in (each for a in of.agents for each in of.c.eta.of(a)):
        if isinstance(pending.request, OBS | CTR | SND | MGR | FLY):
            yield 1 + pending.position if pending.cell == QUEUE else 0, f"{pending.request} is pending"


def waiting_agents(of: Excerpt) -> Iterator[Wait]:
    """Yield in words the agents that wait and are not at rest."""
    yield from ((LAST, f"{a} waits at a react") for a in of.agents if is_stuck(of.c, a))


def _causes(c: Configuration | None) -> tuple[str, ...]:
    return () if c is None else tuple(causes(c, (a for a in c.alpha.names() if is_stuck(c, a))))


def is_stuck(c: Configuration, a: Name) -> bool:
    """Return whether an agent waits and is not at rest."""
    return is_waiting(c, a) and not is_at_rest(c, a)


def is_waiting(c: Configuration, a: Name) -> bool:
    """Return whether an agent is at a react."""
    return isinstance(next_statement(c, a), React)


def is_at_rest(c: Configuration, a: Name) -> bool:
    """Return whether an agent is at the react of an outermost loop, or at one that a message from outside may match."""
    code = c.alpha.code(a)
    statements = c.setting.program.statements
    around = statements[code[-1]]
    if isinstance(around, Loop) and around.outermost and stands_in(c, code[0], around.body):
        return True
    react = statements[code[0]]
    assert isinstance(react, React)
    sayings = [s for s in c.setting.environment if isinstance(s, Says) and s.agent == a and c.read(s.counter)]
    return any(bind(case.pattern, said.message) is not None for case in react.cases for said in sayings)


def stands_in(c: Configuration, number: int, block: Block) -> bool:
    """Return whether a statement is in a block, or in a behaviour called there."""
    program = c.setting.program

    def called(within: Block) -> Iterator[Block]:
        calls = (each for each in map(program.statements.__getitem__, within) if isinstance(each, Call))
        return (program.behaviours[call.behaviour].body for call in calls)

    return any(number in within for within in closure([block], called))


class Computation(Inspection):
    """No agent's internal computation fails or diverges."""

    alone = (moves,)

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield every step of internal computation, and every failure."""
        yield from (Inspected(by=step) for step in of.steps.by_agents if step.label.rule == "fun")
        for fault in of.steps.faults:
            message = f"{fault.agent}: {fault}"
            yield Inspected(("diverges" if fault.diverges else "fails", message), None, message)


class Invariant(Inspection):
    """A proposition is true of every configuration."""

    WRONG: ClassVar[Key] = ("invariant", "")

    def __init__(self, formula: Proposition, shown: str = "", most: int = MOST_VIOLATIONS) -> None:
        super().__init__(most)
        self.formula = formula
        self.shown = shown or str(formula)
        self.valuations = Valuations(formula)

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield the configuration as the single subject."""
        good = self.valuations.holds(of.c)
        details = partial(_names_told, self.formula, of.c)
        yield Inspected() if good else Inspected(self.WRONG, None, f"not true here: {self.shown}", details)


def _names_told(formula: Proposition, c: Configuration) -> tuple[str, ...]:
    names = ", ".join(f"{variable} = {name}" for variable, name in counterexample_names(formula, c))
    told = (f"where {names}",) if names else ()
    if c.setting.regions is None:
        return told
    from semantics.regions.region_report import region_lines  # noqa: PLC0415 - geometry takes its time to load

    return (*told, *region_lines(formula, c))


class Reachability(Inspection):
    """A proposition is true of some configuration; its collected example is the witness."""

    def __init__(self, formula: Proposition, most: int = MOST_VIOLATIONS) -> None:
        super().__init__(most)
        self.formula = formula

    def seen(self, of: Excerpt) -> Iterator[Inspected]:
        """Yield the configuration if the proposition is true there."""
        if holds(self.formula, of.c):
            yield Inspected()
