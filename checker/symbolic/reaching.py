"""All that is reachable, by images that are taken actor by actor until nothing is new; rules are learned on the way."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator

from checker.bounding import look
from checker.fast.learner import Actor, Learner
from checker.fast.leaves import ALIKE, STEP, UNLIKE
from checker.limits import Limits
from checker.symbolic.coding import Coding
from checker.symbolic.diagrams import Diagrams, Set
from checker.symbolic.order import Group, ordered
from checker.symbolic.paths import Outgrown, Paths
from checker.symbolic.relations import Relations
from semantics.cells import AGENTS
from semantics.configuration import Configuration
from semantics.signature import Name
from semantics.successors import by_clause, moves, served


class Reach:
    """The configurations reached so far.

    Attributes:
        learner: What is known of the rules.
        diagrams: Where sets are made.
        coding: How configurations are written in them.
        paths: What learns paths of trees.
        relations: What actors do.
        first: The initial configuration alone.
        reached: All that was reached.
        rounds: How often all actors were gone through.
    """

    def __init__(self, learner: Learner, limits: Limits) -> None:
        self.learner = learner
        self.diagrams = Diagrams(limits.memory)
        self.coding = Coding(self.diagrams, learner.columns)
        self.paths = Paths(learner, self.coding)
        self.coding.grow()
        self.first = self.coding.configuration(learner.columns.codes(learner.still))
        self.reached = self.first
        self.rounds = 0
        self.relations: list[Relations] = []
        self.build()

    @property
    def count(self) -> int:
        """How many configurations were reached."""
        return self.diagrams.count(self.reached)

    def run(self, told: Callable[[], None]) -> None:
        """Reach all there is; `told` is called after each image."""
        before = self.diagrams.none
        while before != self.reached:
            before = self.reached
            self.rounds += 1
            try:
                for each in self.relations:
                    self.close(each, told)
            except Outgrown:
                self.build()
                before = self.diagrams.none
            if len(self.relations) != len(list(self.actors())):  # somebody was spawned
                self.build()
                before = self.diagrams.none

    def close(self, each: Relations, told: Callable[[], None]) -> None:
        """Add what one actor reaches by as many steps as it can take alone."""
        while each.reached != self.reached:
            each.learn(self.reached)
            each.reached = self.reached
            for relation in each.by_writes.values():
                self.reached |= self.diagrams.step(self.reached, relation.steps, relation.image)
                look()
                told()
            self.diagrams.tidy()

    def build(self) -> None:
        """Make room for the values that are known now, order the columns, and make relations of what is known."""
        zeros = self.coding.grow()
        self.first &= zeros
        self.reached &= zeros
        self.relations = []
        self.coding.order(ordered(self.coding.varying(), self._groups()))
        self.relations = [Relations(self.paths, actor, there) for actor, there in self.actors()]

    # --- actors ---------------------------------------------------------------------------------------------------

    def agents(self) -> list[tuple[Name, Set]]:
        """Return every agent that there was so far, with where there is it."""
        learner = self.learner
        if AGENTS not in learner.varying:
            return [(a, self.diagrams.all) for a in learner.still.read(AGENTS)]
        number = learner.columns.numbers[(AGENTS,)]
        found: defaultdict[Name, Set] = defaultdict(lambda: self.diagrams.none)
        for code, group in enumerate(learner.columns.all[number].values):
            for a in group:
                found[a] |= self.coding.code(number, code)
        return list(found.items())

    def actors(self) -> Iterator[tuple[Actor, Set]]:
        """Yield the actors, each with where there is it."""
        agents = self.agents()
        yield from ((Actor(rules, a), there) for a, there in agents for rules in (served, moves))
        yield from (
            (Actor(by_clause, clause), self.diagrams.all) for clause in self.learner.setting.environment
        )

    def _groups(self) -> Counter[Group]:
        """Return the columns that are asked and written together, with how often."""
        found: Counter[Group] = Counter()
        varying = set(self.coding.varying())
        leaves = self.learner.leaves
        for actor, _ in self.actors():
            for leaf, asked in self.paths.groups(self.learner.tree(actor)):
                for step in leaves.steps_of(leaf):
                    for group in self._written_with(step, asked):
                        found[group & varying] += 1
        del found[frozenset()]
        return found

    def _written_with(self, step: int, asked: Group) -> Iterator[Group]:
        leaves = self.learner.leaves
        yield asked | leaves.columns_of(step)
        for part in leaves.parts_of(step):
            together: Group = frozenset()
            for leaf, more in self.paths.groups(part):
                together |= more | leaves.columns_of(leaves.steps_of(leaf)[0])
            yield together

    # --- counts ---------------------------------------------------------------------------------------------------

    @property
    def is_crowded(self) -> bool:
        """Whether some configurations were not followed, because an agent has too much pending."""
        return any((self.reached & each.crowded & each.there).satisfiable() for each in self.relations)

    def transitions(self) -> Counter[int]:
        """Return how many transitions there are by the first step of those that are alike.

        Transitions of one configuration with the same label and the same end are one.
        """
        found: Counter[int] = Counter()
        alike: defaultdict[int, list[tuple[int, Set, Relations]]] = defaultdict(list)
        crowded = self.diagrams.join(each.crowded & each.there for each in self.relations)
        followed = self.reached & ~crowded
        for each in self.relations:
            for leaf in each.leaves:
                look()
                who = followed & each.there & each.who(leaf)
                for step in each.leaf_steps(leaf) if who.satisfiable() else ():
                    label = int(self.learner.leaves.steps.room[STEP * step + ALIKE])
                    if label == UNLIKE:
                        found[step] += self.diagrams.count(who)
                    else:
                        alike[label].append((step, who, each))
        for steps in alike.values():
            found[steps[0][0]] += self._count_alike(steps)
        return found

    def _count_alike(self, steps: list[tuple[int, Set, Relations]]) -> int:
        relations = [each.step(step, who) for step, who, each in steps]
        written = sorted({column for columns, _ in relations for column in columns})
        same = (
            self.diagrams.meet([steps, *(self.coding.copied(c, c) for c in written if c not in columns)])
            for columns, steps in relations
        )
        return self.diagrams.count_steps(self.diagrams.join(same), len(self.coding.pairs(written)))

    def configuration(self, codes: list[int]) -> Configuration:
        """Return a configuration."""
        return Configuration(self.learner.setting, self.learner.columns.row(codes))
