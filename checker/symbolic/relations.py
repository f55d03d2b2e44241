"""What actors do, as relations between configurations and what they hold next, grown path by path."""

from dataclasses import dataclass, field
from functools import reduce

from checker.fast.learner import Actor
from checker.fast.leaves import CROWDED, FLAGS, LEAF
from checker.symbolic.diagrams import Image, Set
from checker.symbolic.paths import Path, Paths

Written = frozenset[int]


@dataclass(slots=True)
class Effect:
    """What a step writes whomever it is about: for each column the code, or the column (`copies`) that it gets."""

    codes: dict[int, int] = field(default_factory=dict)
    copies: dict[int, int] = field(default_factory=dict)


@dataclass(slots=True)
class Part:
    """What a step writes name by name, as far as it is known.

    Attributes:
        known: Of whom it is known.
        ways: For each leaf, who writes what.
    """

    known: Set
    ways: dict[int, tuple[Set, dict[int, int]]] = field(default_factory=dict)

    def add(self, path: Path, codes: dict[int, int]) -> None:
        """Take in a path, and what those who take it write."""
        self.known |= path.who
        before = self.ways.get(path.leaf)
        self.ways[path.leaf] = (path.who if before is None else before[0] | path.who, codes)

    def written(self) -> set[int]:
        """Return the columns that somebody writes."""
        return {column for _, codes in self.ways.values() for column in codes}


@dataclass(slots=True)
class Relation:
    """Steps that write the same columns."""

    steps: Set
    image: Image


class Relations:
    """The steps of one actor.

    Attributes:
        tree: The actor's tree.
        there: Where there is such an actor.
        known: Where its steps are known.
        crowded: Where more is pending than is followed.
        reached: The configurations of which all steps were taken.
        by_writes: The steps by the columns that they write.
    """

    def __init__(self, paths: Paths, actor: Actor, there: Set) -> None:
        self.paths = paths
        self.coding = paths.coding
        self.diagrams = paths.coding.diagrams
        self.learner = paths.learner
        self.tree = self.learner.tree(actor)
        self.there = there
        self.known = self.crowded = self.reached = self.diagrams.none
        self.by_writes: dict[Written, Relation] = {}
        self.leaves: dict[int, Set] = {}
        self.parts: dict[int, Part] = {}
        for path in paths.all_of(self.tree):
            self._add(
                path, [(part, each) for part in self._parts_of(path.leaf) for each in paths.all_of(part)]
            )

    def learn(self, configurations: Set) -> None:
        """Learn the steps of some configurations.

        Raises:
            Outgrown: What was learned asks for a new coding.
        """
        missing = configurations & self.there & ~self.known
        while missing.satisfiable():
            codes = self.coding.codes(missing)
            path = self.paths.path(self.tree, codes)
            parts = [(part, self.paths.path(part, codes)) for part in self._parts_of(path.leaf)]
            self._add(path, parts)
            missing &= ~self.known

    def leaf_steps(self, leaf: int) -> range:
        """Return the numbers of a leaf's transitions."""
        return self.learner.leaves.steps_of(leaf)

    def who(self, leaf: int) -> Set:
        """Return who comes to a leaf, and of whom all is known that its steps write."""
        return self.diagrams.meet(
            [self.leaves[leaf], *(self.parts[part].known for part in self._parts_of(leaf))]
        )

    def step(self, number: int, who: Set) -> tuple[Written, Set]:
        """Return what a transition of some configurations writes: the columns, and the relation."""
        leaves = self.learner.leaves
        effect = Effect(leaves.codes_of(number), leaves.copies_of(number))
        parts = [self.parts[part] for part in leaves.parts_of(number)]
        apart = {column for part in parts for column in part.written()}
        relation = reduce(lambda found, part: found & self._written_by(part, effect), parts, who)
        columns = {*effect.codes, *effect.copies}
        for column in sorted(columns - apart):
            relation &= self._assigned(column, effect)
        return frozenset(c for c in columns | apart if self.coding.bits[c]), relation

    def _add(self, path: Path, parts: list[tuple[int, Path]]) -> None:
        """Take in a path to a leaf, with paths of the parts of its steps."""
        for number, way in parts:
            part = self.parts.setdefault(number, Part(self.diagrams.none))
            part.add(way, self.learner.leaves.codes_of(self.leaf_steps(way.leaf)[0]))
        for number in self._parts_of(path.leaf):
            self.parts.setdefault(number, Part(self.diagrams.none))
        self.leaves[path.leaf] = self.leaves.get(path.leaf, self.diagrams.none) | path.who
        who = self.who(path.leaf)
        self.known |= who
        if self.learner.leaves.leaves.room[LEAF * path.leaf + FLAGS] & CROWDED:
            self.crowded |= who
            return
        for number in self.leaf_steps(path.leaf):
            self._take(*self.step(number, who & self.there))

    def _take(self, written: Written, relation: Set) -> None:
        known = self.by_writes.get(written)
        if known is None:
            image = self.diagrams.image_of(self.coding.pairs(sorted(written)))
            self.by_writes[written] = Relation(relation, image)
        else:
            known.steps |= relation

    def _parts_of(self, leaf: int) -> list[int]:
        return [part for number in self.leaf_steps(leaf) for part in self.learner.leaves.parts_of(number)]

    def _assigned(self, column: int, effect: Effect) -> Set:
        if column in effect.copies:  # copies come after what is written at once
            return self.coding.copied(column, effect.copies[column])
        if column in effect.codes:
            return self.coding.code(column, effect.codes[column], following=True)
        return self.coding.copied(column, column)

    def _written_by(self, part: Part, effect: Effect) -> Set:
        columns = sorted(part.written())
        return self.diagrams.join(self._way(who, codes, columns, effect) for who, codes in part.ways.values())

    def _way(self, who: Set, codes: dict[int, int], columns: list[int], effect: Effect) -> Set:
        for column in columns:
            who &= self._assigned(column, Effect(codes) if column in codes else effect)
        return who
