"""What the inspections find, by sets: all configurations that give an answer to a question are one set.

Only what is shown needs a run: the nearest configuration of a set is looked for, and the inspection itself is asked
there what to say. What was found good has no witness: the nearest may be far.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator
from functools import partial, reduce
from operator import and_, or_
from typing import Any

from checker.bounding import look
from checker.exploration import Inspect
from checker.fast.questions import (
    Key,
    computations,
    controls_in_line,
    what_is_served,
    what_moves,
    where_it_stands,
)
from checker.findings import Collected
from checker.inspections import Computation, DeadlockFreedom, Invariant, LocalConsistency, Reachability
from checker.symbolic.diagrams import Set
from checker.symbolic.reaching import Reach
from checker.symbolic.rings import Rings
from checker.vacuity import atoms_of, truth
from checker.visited import Visited
from semantics.configuration import Configuration
from semantics.propositions import Always, And, Not, Or, Proposition, holds
from semantics.successors import expand

ALL = 1 << 62
"""More different findings than there are."""


class View:
    """Puts questions to all that was reached.

    Attributes:
        reach: What was reached.
        rings: How far things are.
        steps: How many transitions there are, by their steps, once they were counted.
    """

    def __init__(self, reach: Reach) -> None:
        self.reach = reach
        self.rings = Rings(reach)
        self.steps: Counter[int] = Counter()
        self._known: dict[Proposition, Set] = {}

    def rule(self, name: str) -> int:
        """Return how many transitions a rule has."""
        return sum(count for step, count in self.steps.items() if self.reach.learner.steps[step].rule == name)

    def leaves(self, question: Callable[[Configuration], Hashable]) -> dict[int, Set]:
        """Return who gives an answer, and finds it by asking the same."""
        reach = self.reach
        tree = reach.learner.question(question)
        found: dict[int, Set] = {}
        missing = reach.reached
        while missing.satisfiable():
            look()
            leaf, who = reach.paths.path(tree, reach.coding.codes(missing))
            found[leaf] = found.get(leaf, reach.diagrams.none) | (who & reach.reached)
            missing &= ~who
        return found

    def answers(self, question: Callable[[Configuration], Hashable]) -> list[tuple[Any, Set]]:
        """Return each answer with who gives it."""
        found: dict[Hashable, Set] = {}
        for leaf, who in self.leaves(question).items():
            value = self.reach.learner.answers[leaf]
            found[value] = found.get(value, self.reach.diagrams.none) | who
        return list(found.items())

    def where(self, formula: Proposition) -> Set:
        """Return where a proposition is true."""
        diagrams = self.reach.diagrams
        match formula:
            case Not(inner):
                return self.reach.reached & ~self.where(inner)
            case And(parts):
                return reduce(and_, map(self.where, parts), self.reach.reached)
            case Or(parts):
                return reduce(or_, map(self.where, parts), diagrams.none)
            case Always(value):
                return self.reach.reached if value else diagrams.none
        if formula not in self._known:
            told = self.answers(partial(holds, formula))
            self._known[formula] = diagrams.join(who for yes, who in told if yes)
        return self._known[formula]

    def collect(
        self, collected: Collected, bad: Iterable[tuple[Key, Set]], again: Callable[[int], Collected]
    ) -> None:
        """Add what was found wrong; `again` looks at one configuration once more. Only what is kept needs a run."""
        sets: dict[Key, Set] = {}
        for key, who in bad:
            collected.count += self.reach.diagrams.count(who)
            sets[key] = sets.get(key, self.reach.diagrams.none) | who
        kept: dict[str, int] = defaultdict(int)
        for key, number in self.rings.nearest(dict(sorted(sets.items()))):
            kept[key[0]] += 1
            collected.count -= 1  # adding it counts it
            collected.add(again(number).first[key])
            if all(kept[kind] >= collected.most for kind, _ in sets):
                break
        collected.different.update(sets)

    def again(self, make: Callable[[], Any], number: int) -> Any:
        """Return an inspection that has looked at one configuration."""
        c = self.rings.configurations[number]
        inspection = make()
        inspection(number, c, expand(c))
        return inspection


def inspect_symbolic(view: View, inspections: Iterable[Inspect]) -> None:
    """Let each inspection have found what it would have found by looking at every configuration."""
    view.steps = view.reach.transitions()
    for each in inspections:
        HOW[type(each)](view, each)


def look_at_consistency(view: View, inspection: LocalConsistency) -> None:
    """Collect what local consistency finds."""
    told = [
        (key, who)
        for a, _ in view.reach.agents()
        for keys, who in view.answers(partial(controls_in_line, a))
        for key in keys
    ]
    inspection.collected.examined += sum(view.reach.diagrams.count(who) for key, who in told if key is None)

    def again(number: int) -> Collected:
        found: Collected = view.again(lambda: LocalConsistency(ALL), number).collected
        return found

    view.collect(inspection.collected, [(key, who) for key, who in told if key is not None], again)


def look_at_computation(view: View, inspection: Computation) -> None:
    """Collect what fails or diverges."""
    told = [each for a, _ in view.reach.agents() for each in view.answers(partial(computations, a))]
    inspection.collected.examined += view.rule("fun")

    def again(number: int) -> Collected:
        found: Collected = view.again(lambda: Computation(ALL), number).collected
        return found

    view.collect(inspection.collected, [(key, who) for (_, keys), who in told for key in keys], again)


def look_at_deadlocks(view: View, inspection: DeadlockFreedom) -> None:
    """Collect deadlocks, and flights that need never end."""
    agents = [a for a, _ in view.reach.agents()]
    asked = [partial(question, a) for question in (what_is_served, what_moves) for a in agents]
    told = [view.answers(question) for question in asked]
    may_stay = reduce(
        lambda left, answers: left & ~view.reach.diagrams.join(who for (must, *_), who in answers if must),
        told,
        view.reach.reached,
    )
    deadlocks: list[tuple[Key, Set]] = []
    late: list[tuple[Key, Set]] = []
    inspection.arrival.examined += view.rule("commit")
    for who in _apart(may_stay, told):
        c = view.reach.configuration(view.reach.coding.codes(who))
        seen = DeadlockFreedom(ALL)
        seen(0, c, expand(c))
        deadlocks += [(key, who) for key in seen.collected.first]
        late += [(key, who) for key in seen.arrival.first]
        inspection.collected.examined += view.reach.diagrams.count(who) * seen.collected.examined

    def again(number: int) -> DeadlockFreedom:
        found: DeadlockFreedom = view.again(lambda: DeadlockFreedom(ALL), number)
        return found

    view.collect(inspection.collected, deadlocks, lambda number: again(number).collected)
    view.collect(inspection.arrival, late, lambda number: again(number).arrival)


def _apart(configurations: Set, told: list[list[tuple[Any, Set]]]) -> Iterator[Set]:
    """Yield configurations in sets that give the same answers to all questions."""
    apart = [configurations] if configurations.satisfiable() else []
    for answers in told:
        apart = [both for each in apart for _, who in answers if (both := each & who).satisfiable()]
    yield from apart


def look_at_invariant(view: View, inspection: Invariant) -> None:
    """Collect where an invariant is violated, and which valuations of its atoms there are."""
    valuations, reached = inspection.valuations, view.reach.reached
    atoms = valuations.atoms or tuple(atoms_of(inspection.formula))
    changing = any(len(view.leaves(partial(holds, atom))) > 1 for atom in atoms)
    valuations.begun, valuations.still = True, None if changing else {}
    met = {0: reached}
    for rank, atom in enumerate(valuations.atoms):
        true = view.where(atom)
        yes = {value | 1 << rank: who & true for value, who in met.items()}
        no = {value: who & ~true for value, who in met.items()}
        met = {value: who for value, who in (yes | no).items() if who.satisfiable()}
    if valuations.atoms:
        valuations.met.update(met)
        columns = {value: {atom: value >> k & 1 for k, atom in enumerate(valuations.atoms)} for value in met}
        good = view.reach.diagrams.join(
            who for value, who in met.items() if truth(inspection.formula, columns[value], 1) == 1
        )
    else:
        good = view.where(inspection.formula)
    bad = reached & ~good
    inspection.collected.examined += view.reach.diagrams.count(good)

    def again(number: int) -> Collected:
        seen: Collected = view.again(lambda: Invariant(inspection.formula), number).collected
        return seen

    view.collect(inspection.collected, [(("invariant", ""), bad)] if bad.satisfiable() else [], again)


def look_at_reachability(view: View, inspection: Reachability) -> None:
    """Collect where a proposition is true."""
    true = view.where(inspection.formula)
    if true.satisfiable():
        inspection.collected.examined = view.reach.diagrams.count(true)
        inspection.collected.example = next(view.rings.nearest({"": true}))[1]


def look_at_visited(view: View, inspection: Visited) -> None:
    """Collect where agents stood, what they passed over, and what the environment did."""
    for a, _ in view.reach.agents():
        for value, _ in view.answers(partial(where_it_stands, a)):
            if value is not None:
                code, passed = value
                inspection.codes.setdefault(a, set()).add(code)
                inspection.passed |= passed
    for step in view.steps:
        label = view.reach.learner.steps[step]
        if label.agent is None:
            inspection.happened.add(str(label.about))


HOW: dict[type, Callable[[View, Any], None]] = {
    Computation: look_at_computation,
    DeadlockFreedom: look_at_deadlocks,
    Invariant: look_at_invariant,
    LocalConsistency: look_at_consistency,
    Reachability: look_at_reachability,
    Visited: look_at_visited,
}
"""How each inspection looks at sets; races are looked for configuration by configuration, by other engines."""
