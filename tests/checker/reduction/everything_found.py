"""All that inspections find in an exploration, to be compared between the full search and a reduced one."""

from checker import Engine, Limits, explore
from checker.properties.findings import Collected
from checker.properties.inspections import Arrival, Computation, DeadlockFreedom, LocalConsistency
from checker.properties.races import ControlRaces, StaleObservationRaces
from semantics.properties.propositions import holds


class Messages(Collected):
    """Keeps the words of every finding, not only the first of a kind."""

    def __init__(self):
        super().__init__()
        self.words = set()

    def add(self, finding):
        self.words.add((finding.kind, finding.message))


class Everything:
    """Collects every message instead of the first, what is quiescent, and which formulas are true together."""

    def __init__(self, formulas=()):
        self.formulas = tuple(formulas)
        self.inspections = (LocalConsistency(), DeadlockFreedom(), Arrival(), Computation(), ControlRaces())
        for each in self.inspections:
            each.collected = Messages()
        self.still = set()
        self.truths = set()

    def __call__(self, number, c, expansion):
        for inspect in self.inspections:
            inspect(number, c, expansion)
        if not expansion.by_agents:
            self.still.add(c)
        self.truths.add(tuple(holds(formula, c) for formula in self.formulas))

    @property
    def messages(self):
        return set().union(*(each.collected.words for each in self.inspections))


def everything(initial, formulas=(), reduce=None, most=100_000, engine=Engine.REFERENCE):
    """Return what is found: messages, quiescent configurations, combinations of truths, rules; None if too large."""
    found = Everything(formulas)
    explored = explore(initial, (found,), Limits(configurations=most), engine=engine, reduce=reduce)
    if not explored.complete:
        return None, explored
    return (found.messages, found.still, found.truths, set(explored.rules)), explored


def stale_races(initial, reduce=None, most=100_000):
    """Return the messages of all stale-observation races, and how many configurations were visited; None if too large.

    Args:
        initial: Where to start; monitored.
        reduce: What lets the search visit less.
        most: Configurations.
    """
    inspect = StaleObservationRaces()
    inspect.collected = Messages()
    explored = explore(initial, (inspect,), Limits(configurations=most), reduce=reduce)
    return (inspect.collected.words, len(explored.configurations)) if explored.complete else None
