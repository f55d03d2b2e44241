"""Inspections of single configurations: local consistency, deadlock, invariants, reachability, computation."""

from checker.properties.findings import MOST_VIOLATIONS, Collected, Finding
from checker.properties.vacuity import Valuations
from semantics.behaviours.patterns import bind
from semantics.behaviours.reactions import moved
from semantics.behaviours.statements import Block, Call, Loop, React
from semantics.behaviours.stepping import next_statement
from semantics.control import Obstacle, obstacle
from semantics.environment import Says
from semantics.properties.propositions import Proposition, holds
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import CTR, FLY, MGR, OBS, SND
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.successors import Expansion

WORDS = {
    Obstacle.UNMATCHED: "its redex matches nothing in L",
    Obstacle.INCONSISTENT: "L believes what P no longer shows: nobody looked since",
    Obstacle.UNREALISABLE: "no physical change makes its reactum true",
}


class LocalConsistency:
    """For every control next in its agent's line some match is consistent and realisable (semantics.md, check 1)."""

    def __init__(self, most: int = MOST_VIOLATIONS) -> None:
        self.collected = Collected(most)

    def __call__(self, number: int, c: Configuration, expansion: Expansion) -> None:
        """Look at every control that is next in line."""
        served = {t.served.request: t for t in expansion.enabled if t.served is not None}
        for a in c.alpha.names():
            for pending in c.eta.in_line(a):
                request = pending.request
                if not isinstance(request, CTR | FLY):
                    continue
                hindered = None if request in served else obstacle(c, request)
                if hindered is None:
                    self.collected.looked(number, served.get(request))
                else:
                    message = f"{request} is {hindered.value}: {WORDS[hindered]}"
                    found = Finding(
                        hindered.value, message, number, None, disagreements(c, request), str(request)
                    )
                    self.collected.add(found)


def disagreements(c: Configuration, request: CTR | FLY) -> tuple[str, ...]:
    """Return in words what L believes and P shows of the nodes that a control names."""
    structure = c.structure
    lines = []
    for node in sorted({node for node in request.reaction.redex.nodes if isinstance(node, str)}):
        if node not in structure.physical:
            lines.append(
                f"{node}: L has it in {structure.logical.parent(node) or 'no place'}, P does not show it"
            )
            continue
        believed, actual = structure.logical.parent(node), structure.physical.abstract_parent(node)
        links, seen = structure.logical.links(node), structure.physical.links(node)
        if believed != actual:
            lines.append(f"{node}: L has it in {believed or 'no place'}, P shows it in {actual}")
        if links != seen:
            lines.append(
                f"{node}: L has it on {', '.join(links) or 'no link'}, P on {', '.join(seen) or 'none'}"
            )
    return tuple(lines)


class DeadlockFreedom:
    """Not: nothing but the environment can move, and a request is pending or an agent waits (check 3).

    Flights that need never end are collected apart, as *not arrived*.
    """

    def __init__(self, most: int = MOST_VIOLATIONS) -> None:
        self.collected = Collected(most)
        self.arrival = Collected(most)

    def __call__(self, number: int, c: Configuration, expansion: Expansion) -> None:
        """Look at every configuration in which no agent must move, and at every end of a flight."""
        for transition in expansion.by_agents:
            if transition.label.rule == "commit":
                self.arrival.looked(number, transition)
        if any(not is_unfair(c, transition) for transition in expansion.by_agents):
            return
        if expansion.by_agents:
            late = sorted({str(transition.label) for transition in expansion.by_agents})
            waits = ", ".join(late)
            message = f"a run may wait here for ever for {waits}"
            self.arrival.add(Finding("not arrived", message, number, subject=waits))
            return
        blocked = [
            *stuck_requests(c),
            *waiting_agents(c),
            *(f"{fault.agent} failed" for fault in expansion.faults),
        ]
        if blocked:
            who = "; ".join(blocked)
            message = f"nothing but the environment can move, and {who}"
            self.collected.add(Finding("deadlock", message, number, subject=who))
        else:
            self.collected.looked(number)


def is_unfair(c: Configuration, transition: Transition) -> bool:
    """Tell whether a transition is the end of a flight of which the mission doesn't say that it arrives."""
    return transition.served is not None and never_ends(c.setting, transition.served.request)


def never_ends(setting: Setting, request: object) -> bool:
    """Tell whether a request is a flight of which the mission doesn't say that it arrives."""
    if not isinstance(request, FLY):
        return False
    return not all(node in setting.arriving for node, _ in moved(request.reaction, request.match))


def stuck_requests(c: Configuration) -> list[str]:
    """Return in words the requests that wait, a received or forgotten READY apart."""
    kinds = OBS | CTR | SND | MGR | FLY
    return [f"{each.request} is pending" for each in c.eta.all() if isinstance(each.request, kinds)]


def waiting_agents(c: Configuration) -> list[str]:
    """Return in words the agents that wait and are not at rest."""
    return [f"{a} waits at a react" for a in c.alpha.names() if is_waiting(c, a) and not is_at_rest(c, a)]


def is_waiting(c: Configuration, a: Name) -> bool:
    """Tell whether an agent is at a react."""
    return isinstance(next_statement(c, a), React)


def is_at_rest(c: Configuration, a: Name) -> bool:
    """Tell whether an agent is at the react of an outermost loop, or at one with a case that someone may still say."""
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
    """Tell whether a statement stands in a block, or in that of a behaviour called there: in the call's place."""
    program, seen, waiting = c.setting.program, set[str](), [block]
    while waiting:
        within = waiting.pop()
        if number in within:
            return True
        calls = (each for each in map(program.statements.__getitem__, within) if isinstance(each, Call))
        called = sorted({call.behaviour for call in calls} - seen)
        seen.update(called)
        waiting += [program.behaviours[name].body for name in called]
    return False


class Computation:
    """No agent's internal computation fails or diverges."""

    def __init__(self, most: int = MOST_VIOLATIONS) -> None:
        self.collected = Collected(most)

    def __call__(self, number: int, _: Configuration, expansion: Expansion) -> None:
        """Look at every step of internal computation."""
        for transition in expansion.by_agents:
            if transition.label.rule == "fun":
                self.collected.looked(number, transition)
        for fault in expansion.faults:
            kind = "diverges" if fault.diverges else "fails"
            message = f"{fault.agent}: {fault}"
            self.collected.add(Finding(kind, message, number, subject=message))


class Invariant:
    """A proposition is true of every configuration."""

    def __init__(self, formula: Proposition) -> None:
        self.formula = formula
        self.collected = Collected()
        self.valuations = Valuations(formula)

    def __call__(self, number: int, c: Configuration, _: Expansion) -> None:
        """Look at every configuration."""
        if self.valuations.holds(c):
            self.collected.looked(number)
        else:
            self.collected.add(Finding("invariant", f"not true here: {self.formula}", number))


class Reachability:
    """A proposition is true of some configuration; its collected example is the witness."""

    def __init__(self, formula: Proposition) -> None:
        self.formula = formula
        self.collected = Collected()

    def __call__(self, number: int, c: Configuration, _: Expansion) -> None:
        """Look at every configuration."""
        if holds(self.formula, c):
            self.collected.looked(number)
