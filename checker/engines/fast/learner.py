"""The learner: runs a rule once for each way in which it reads cells, and adds the result to the trees.

An actor is what serves an agent's requests, or what the agent does itself, or a clause of the environment. Each has a
tree whose leaves hold its transitions. What a transition writes name by name (a pointwise definition) is learned in a
tree for each mobile name, walked by itself: the answers of one observation do not multiply.
"""

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from checker.engines.fast.columns import Columns, Packing, Writes
from checker.engines.fast.leaves import ALIKE, CROWDED, NO_TURN, STEP, UNLIKE, Effect, Leaves, Step
from checker.engines.fast.likeness import Images, Learned, Likeness, Mentioned, Swap
from checker.engines.fast.recording import Ask, Edited, Recorder, Scope, Source
from checker.engines.fast.skeletons import agents_of, mobile_names, settled
from checker.engines.fast.trees import Trees
from checker.engines.fast.writing import Concluded, Relearn, Varies, Writing
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import Fact
from semantics.environment import Clause
from semantics.races.monitor import marked
from semantics.state.agents import mailbox_cell
from semantics.state.cells import Cell, Row
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import Received
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.successors import remembered, served, turn_of

Found = list[Transition | Fault]


class Actor(NamedTuple):
    """Some rules, and whom they are about."""

    rules: Callable[[Configuration, Any], Iterable[Transition | Fault]]
    about: Name | Clause


Question = Callable[[Configuration], Hashable]
"""A pure function of a configuration: its tree tells rows apart by the answer."""

PREDICTED = ("code", "store", "line")
"""What varies in every mission; that other cells do is found out when something is written there."""


@dataclass(frozen=True, slots=True, eq=False)
class PartOf:
    """What the tree of a part is about.

    Attributes:
        recorder: What the rules of the leaf were recorded with; it may look at any configuration that comes there.
        concluded: The transition of the leaf.
        name: About whom the part is.
        model: The part about the first name that is like that; None where it is itself the first, or like nobody.
        tree: The number of its tree.
        taken: The cells that were taken to be never written wherever it was learned.
    """

    recorder: Recorder
    concluded: Concluded
    name: Name
    model: "PartOf | None"
    tree: int
    taken: set[Cell] = field(default_factory=set)


@dataclass(slots=True)
class Known:
    """A label that was met: its number, the actor that had it first, and the transitions that have it."""

    number: int
    first: Actor
    steps: list[int] = field(default_factory=list)


@dataclass(slots=True)
class CodedSource(Source):
    """A configuration given by a packed row: of its many columns only those are read that are asked for."""

    columns: Columns
    packing: Packing
    words: list[int]

    def skeleton(self, cell: Cell) -> Any:
        """Return the skeleton of a cell's value, None where there is no such cell."""
        return self._value((cell,))

    def fact(self, cell: Cell, number: int, name: Name) -> Fact:
        """Return what a hole of a cell says of a mobile name."""
        fact: Fact = self._value((cell, number, name))
        return fact

    def code(self, number: int) -> int:
        """Return the code of a column."""
        return self.packing.code(self.words, number)

    def _value(self, place: Any) -> Any:
        number = self.columns.number(place)
        return self.columns.all[number].value(self.code(number))


@dataclass(slots=True)
class Learner:
    """What is known of a mission's rules.

    Attributes:
        setting: The mission.
        still: The initial configuration's cells: what never varies has its value there.
        pending: How many requests or messages an agent may have before it is not followed further.
        runs: How many times an actor's rules were run in Python.
        owners: What each tree is about.
        taken: For each cell that was taken to be never written, the trees that did so.
        writers: For each cell the trees that write it.
        homes: For each cell, and for each name, which actor was met first that writes it, or cells about it.
        answers: What a question is answered with, leaf by leaf.
        reads: For each leaf of an actor what was asked of which column to come there, with the answer.
        steps: The label of each transition, as it was when it was learned.
        whose: The actor of each transition.
    """

    setting: Setting
    still: Row
    pending: int
    columns: Columns = field(init=False)
    writing: Writing = field(init=False)
    likeness: Likeness = field(init=False)
    images: Images = field(init=False)
    trees: Trees = field(default_factory=Trees)
    leaves: Leaves = field(default_factory=Leaves)
    owners: list[Actor | PartOf | Edited | Question] = field(default_factory=list)
    taken: defaultdict[Cell, set[int]] = field(default_factory=lambda: defaultdict(set))
    writers: defaultdict[Cell, set[int]] = field(default_factory=lambda: defaultdict(set))
    homes: dict[Cell | Name, int] = field(default_factory=dict)
    planted: dict[Actor | Edited, int] = field(default_factory=dict)
    varying: set[Cell] = field(default_factory=set)
    rules: dict[str, int] = field(default_factory=dict)
    labels: dict[Hashable, Known] = field(default_factory=dict)
    steps: dict[int, Label] = field(default_factory=dict)
    whose: dict[int, Actor] = field(default_factory=dict)
    answers: dict[int, Hashable] = field(default_factory=dict)
    reads: dict[int, tuple[tuple[int, Ask, Any], ...]] = field(default_factory=dict)
    runs: int = 0

    def __post_init__(self) -> None:
        mobile = mobile_names(self.setting, self.still)
        self.columns = Columns(mobile, agents_of(self.setting, self.still))
        self.writing = Writing(self.columns, self.still, self.varying)
        self.likeness = Likeness(self.setting, self.still, self.columns.apart)
        self.images = Images(self.columns, self.trees, self.leaves, self.still, self.varying)
        for cell, value in self.still.items():
            self.columns.start(cell, value)
            if cell[0] in PREDICTED or (cell[0] in ("placement", "parent") and cell[-1] in mobile):
                self.varying.add(cell)

    def tree(self, actor: Actor | Edited) -> int:
        """Return the number of the tree of an actor, or of an edit, which whoever makes it shares."""
        if actor not in self.planted:
            self.planted[actor] = self._plant(actor)
        return self.planted[actor]

    def question(self, question: Question) -> int:
        """Return the number of a new tree for a question."""
        return self._plant(question)

    def _plant(self, owner: Actor | PartOf | Edited | Question) -> int:
        self.owners.append(owner)
        return self.trees.plant()

    def learn(self, tree: int, source: CodedSource) -> None:
        """Run the rules of a tree's actor on a configuration, and let the tree know what they asked and wrote."""
        while not self._learned(tree, source):
            pass

    def _learned(self, tree: int, source: CodedSource) -> bool:
        """Learn a tree's way for a configuration; False where something was not what it was taken for till now."""
        owner = self.owners[tree]
        try:
            if isinstance(owner, PartOf):
                self._learn_part(owner, source)
                return True
            self.runs += 1
            if isinstance(owner, Edited):
                self._learn_edit(tree, owner, source)
                return True
            recorder = Recorder(source, self.still, self.varying.__contains__, self.columns.mobile)
            if isinstance(owner, Actor):
                self._learn_root(tree, owner, recorder, source)
            else:
                self._learn_answer(tree, owner, recorder, source)
        except Relearn as news:
            self.forget_those(self.taken if isinstance(news, Varies) else self.writers, news.cell)
            return False
        return True

    def forget(self) -> None:
        """Forget everything."""
        for tree in range(len(self.owners)):
            self.trees.forget(tree)

    def forget_those(self, trees: dict[Cell, set[int]], cell: Cell) -> None:
        """Forget what some trees know: those that took a cell for something that it is not."""
        for tree in trees.pop(cell, ()):
            self.trees.forget(tree)

    def _learn_root(self, tree: int, actor: Actor, recorder: Recorder, source: CodedSource) -> None:
        c = Configuration(self.setting, recorder)
        found = [
            step if isinstance(step, Fault) else remembered(c, marked(c, step))
            for step in actor.rules(c, actor.about)
        ]
        concluded = [self.writing.conclude(step) for step in found if isinstance(step, Transition)]
        is_full = actor.rules is served and is_crowded(c, str(actor.about), self.pending)
        parts = [self._plant_parts(recorder, each) for each in concluded]
        for each, trees in zip(concluded, parts, strict=True):
            each.effect.parts = [*trees, *map(self.tree, each.edits)]
        for each in concluded:
            self._note_writer(tree, each.effect.writes)
        leaf = self.leaves.add(self._steps(actor, concluded), CROWDED if is_full else 0)
        self.whose |= dict.fromkeys(self.leaves.steps_of(leaf), actor)
        self.reads[leaf] = tuple(
            (self.columns.asked(ask), ask, said) for ask, said in recorder.scopes[0].asked.items()
        )
        self._grow(tree, recorder.scopes[0], leaf, self._codes(recorder.scopes[0], source))
        for part in (part for trees in parts for part in trees):
            self.learn(part, source)

    def _plant_parts(self, recorder: Recorder, concluded: Concluded) -> list[int]:
        models = self.likeness.models(concluded.apart, recorder.scopes[0])
        parts: dict[Name, PartOf] = {}
        for name in concluded.apart:
            model = parts[models[name]] if name in models else None
            parts[name] = PartOf(recorder, concluded, name, model, len(self.owners))
            self._plant(parts[name])
        return [part.tree for part in parts.values()]

    def _learn_answer(self, tree: int, question: Question, recorder: Recorder, source: CodedSource) -> None:
        answer = settled(question(Configuration(self.setting, recorder)))
        leaf = self.leaves.add(())
        self.answers[leaf] = answer
        self._grow(tree, recorder.scopes[0], leaf, self._codes(recorder.scopes[0], source))

    def _learn_part(self, part: PartOf, source: CodedSource) -> None:
        """Let a part know what is known of its model under the same answers, else run it, and tell the model."""
        model, known = part.model, None
        try:
            if model is not None:
                known = self.images.known(model.tree, model.taken, Swap(model.name, part.name), source)
        except Mentioned:
            model = None
        if known is not None:
            self._know(part, known)
            return
        self.runs += 1
        part.recorder.source = source  # it agrees on all that the rules themselves asked
        writes, scope = part.recorder.apart(lambda: self.writing.part(part.concluded, part.name))
        learned = Learned(scope, writes, self._codes(scope, source))
        self._know(part, learned)
        if model is not None:
            with suppress(Mentioned):
                self._know(model, self.images.of(learned, Swap(part.name, model.name)))

    def _know(self, part: PartOf, learned: Learned) -> None:
        part.taken.update(learned.scope.taken)
        self._note_writer(part.tree, learned.writes)
        leaf = self.leaves.add([Step(Effect(learned.writes))])
        self._grow(part.tree, learned.scope, leaf, learned.codes)

    def _learn_edit(self, tree: int, edited: Edited, source: CodedSource) -> None:
        scope = Scope({Ask(edited.cell): source.skeleton(edited.cell)})
        writes = self.writing.edit(edited, source.skeleton(edited.cell))
        self._note_writer(tree, writes)
        leaf = self.leaves.add([Step(Effect(writes))])
        self._grow(tree, scope, leaf, self._codes(scope, source))

    def _note_writer(self, tree: int, writes: Writes) -> None:
        cells = dict.fromkeys(self.columns.all[number].place[0] for number, _ in writes)
        owner = self.owners[tree]
        for cell in cells:
            self.writers[cell].add(tree)
            if isinstance(owner, Actor):
                home = self.homes.setdefault(cell, self._home(owner))
                self.homes.setdefault(cell[-1], home)

    def _home(self, actor: Actor) -> int:
        """Return the number of whom an actor is about: its first tree."""
        return min(
            tree
            for each, tree in self.planted.items()
            if isinstance(each, Actor) and each.about == actor.about
        )

    def by_home(self) -> list[int]:
        """Return the numbers of all columns, those together that one actor writes."""
        last = len(self.owners)

        def home(number: int) -> tuple[int, int]:
            cell = self.columns.all[number].place[0]
            return self.homes.get(cell, self.homes.get(cell[-1], last)), number

        return sorted(range(len(self.columns)), key=home)

    def _grow(self, tree: int, scope: Scope, leaf: int, codes: Mapping[Ask, int]) -> None:
        """Let a tree know that what was asked leads to a leaf, given the codes of the values that were read."""
        for cell in scope.taken:
            self.taken[cell].add(tree)
        path: list[tuple[Ask, Any]] = []
        columns = []
        for ask, answer in scope.asked.items():
            number = self.columns.asked(ask)
            columns.append((self.columns.all[number], number))
            path.append((ask, codes[ask] if ask.question is None else answer))
        self.trees.grow(tree, path, leaf, columns)

    def _codes(self, scope: Scope, source: CodedSource) -> dict[Ask, int]:
        return {ask: source.code(self.columns.asked(ask)) for ask in scope.asked if ask.question is None}

    def _steps(self, actor: Actor, concluded: list[Concluded]) -> list[Step]:
        keys = [_key(each.step) for each in concluded]
        return [
            Step(
                each.effect,
                self._rule(each.step),
                _turn(each.step),
                self._alike(actor, key, keys, number),
            )
            for number, (key, each) in enumerate(zip(keys, concluded, strict=True), len(self.leaves.rule))
            if self.steps.setdefault(number, each.step.label)
        ]

    def _rule(self, step: Transition) -> int:
        return self.rules.setdefault(step.label.rule, len(self.rules))

    def _alike(self, actor: Actor, key: Hashable, beside: list[Hashable], number: int) -> int:
        """Number a label that two transitions of one configuration may have: of one leaf, or of two clauses."""
        known = self.labels.setdefault(key, Known(len(self.labels), actor))
        if known.first != actor:  # whatever has it already must be compared, too
            for other in known.steps:
                self.leaves.steps.room[STEP * other + ALIKE] = known.number
        known.steps.append(number)
        return known.number if known.first != actor or beside.count(key) > 1 else UNLIKE


def _turn(step: Transition) -> int:
    turn = turn_of(step)
    return NO_TURN if turn is None else turn


def _key(step: Transition) -> Hashable:
    """Return what tells two labels of a configuration apart; receiving equal observations ends alike."""
    label = step.label
    return (label.rule, label.agent, None if isinstance(label.about, Received) else label.about, step.shown)


def is_crowded(c: Configuration, a: Name, most: int) -> bool:
    """Tell whether an agent has more pending requests or messages than are explored."""
    return c.eta.count(a) > most or c.test(mailbox_cell(a), is_longer, most)


def is_longer(value: tuple[object, ...] | None, most: int) -> bool:
    """Ask whether a cell holds more than so many."""
    return value is not None and len(value) > most
