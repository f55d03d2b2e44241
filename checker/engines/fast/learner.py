"""The learner: runs a rule once for each way in which it reads cells, and adds the result to the trees.

An actor is what serves an agent's requests, or what the agent does itself, or a clause of the environment. Each has a
tree whose leaves hold its transitions. What a transition writes name by name (a pointwise definition) is learned in a
tree for each mobile name, walked by itself: the answers of one observation do not multiply.
"""

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from checker.engines.fast.columns import Columns, Packing, Place, Writes
from checker.engines.fast.leaves import ALIKE, CROWDED, NO_TURN, STEP, UNLIKE, Effect, Leaves, Step
from checker.engines.fast.lessons import Exchange, Kin, Outcome, Parts
from checker.engines.fast.likeness import Likeness
from checker.engines.fast.recording import Ask, Edited, Recorder, Scope, Source
from checker.engines.fast.sharing import Learned, Sharing
from checker.engines.fast.skeletons import agents_of, mobile_names, settled
from checker.engines.fast.trees import Trees
from checker.engines.fast.writing import Concluded, Relearn, Varies, Writing
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import Fact, Observation
from semantics.environment import Clause
from semantics.races.monitor import marked
from semantics.state.agents import mailbox_cell
from semantics.state.cells import Cell, Row
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import Received
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.successors import remembered, served, turn_of


class Actor(NamedTuple):
    """Some rules, and whom they are about."""

    rules: Callable[[Configuration, Any], Iterable[Transition | Fault]]
    about: Name | Clause


Question = Callable[[Configuration], Hashable]
"""A pure function of a configuration: its tree tells rows apart by the answer."""

NOTHING_RECEIVED = Received(Observation.of())

PREDICTED = ("code", "store", "line")
"""What varies in every mission; that other cells do is found out when something is written there."""


@dataclass(slots=True, eq=False)
class Run:
    """One run of an actor's rules; what was learned without it is run where a part of it is not known.

    Attributes:
        actor: Whose rules.
        recorder: What they were recorded with; it may look at any configuration that comes to the same leaf.
        concluded: Their transitions.
    """

    actor: Actor
    recorder: Recorder | None = None
    concluded: list[Concluded] = field(default_factory=list)


@dataclass(frozen=True, slots=True, eq=False)
class PartOf:
    """What the tree of a part is about.

    Attributes:
        run: The run of the rules.
        step: Which of its transitions.
        name: About whom the part is.
        kin: What is known of those that are like it; None where nobody is.
    """

    run: Run
    step: int
    name: Name
    kin: Kin | None


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
    sharing: Sharing = field(init=False)
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
        self.likeness = Likeness(self.setting, self.still, mobile, self.columns.apart)
        self.sharing = Sharing(self.likeness, self.columns, self.varying, self.still)
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
                self._learn_part(tree, owner, source)
                return True
            if isinstance(owner, Actor):
                self._learn_root(tree, owner, source)
            elif isinstance(owner, Edited):
                self._learn_edit(tree, owner, source)
            else:
                self._learn_answer(tree, owner, source)
        except Relearn as news:
            self.relearn(news)
            return False
        return True

    def relearn(self, news: Relearn) -> None:
        """Forget what rests on what a cell was taken for, of all whose cells are alike."""
        self.sharing.forgotten += 1
        for cell in dict.fromkeys((news.cell, *self.likeness.alike(news.cell))):
            if isinstance(news, Varies):
                self.varying.add(cell)
                self.forget_those(self.taken, cell)
            elif cell in self.varying:
                self.columns.dig(cell, self.columns.holes[news.cell])
                self.forget_those(self.writers, cell)

    def forget(self) -> None:
        """Forget everything."""
        for tree in range(len(self.owners)):
            self.trees.forget(tree)

    def forget_those(self, trees: dict[Cell, set[int]], cell: Cell) -> None:
        """Forget what some trees know: those that took a cell for something that it is not."""
        for tree in trees.pop(cell, ()):
            self.trees.forget(tree)

    def _learn_root(self, tree: int, actor: Actor, source: CodedSource) -> None:
        kin, run = self.sharing.kin_of(actor.rules, actor.about), Run(actor)
        exchange = self.likeness.nobody if kin is None else kin.exchange
        found = self.sharing.known(kin, source)
        if found is None:
            found = self._run(run, source, exchange)
            self.sharing.teach(kin, found)
        steps, parts = [], []
        for number, outcome in enumerate(found.outcomes):
            effect = self._effect(outcome)
            trees = [self._plant(self._part(run, number, name, outcome, kin)) for name in outcome.apart]
            effect.parts = [*trees, *map(self.tree, outcome.edits)]
            self._note_writer(tree, effect.writes)
            parts += trees
            steps.append(effect)
        leaf = self.leaves.add(self._steps(actor, found.outcomes, steps), found.flags)
        self.whose |= dict.fromkeys(self.leaves.steps_of(leaf), actor)
        self.reads[leaf] = tuple((self.columns.asked(ask), ask, said) for ask, said in found.asked.items())
        self._grow(tree, found, leaf)
        for part in parts:
            self.learn(part, source)

    def _run(self, run: Run, source: CodedSource, exchange: Exchange) -> Learned:
        """Run an actor's rules on a configuration; which parts are alike is said under an exchange."""
        self.runs += 1
        actor, recorder = run.actor, self._recorder(source)
        c = Configuration(self.setting, recorder)
        found = [
            step if isinstance(step, Fault) else remembered(c, marked(c, step))
            for step in actor.rules(c, actor.about)
        ]
        run.concluded = [self.writing.conclude(step) for step in found if isinstance(step, Transition)]
        run.recorder, scope = recorder, recorder.scopes[0]
        is_full = actor.rules is served and is_crowded(c, str(actor.about), self.pending)
        outcomes = [self._outcome(each, scope, exchange) for each in run.concluded]
        return self._found(scope, source, outcomes, CROWDED if is_full else 0)

    def _recorder(self, source: CodedSource) -> Recorder:
        return Recorder(source, self.still, self.varying.__contains__, self.columns.mobile)

    def _outcome(self, each: Concluded, scope: Scope, exchange: Exchange) -> Outcome:
        columns, models = self.columns.all, self.likeness.models(each.apart, scope)
        return Outcome(
            general(each.step.label),
            each.step.shown,
            _turn(each.step),
            self._written(each.effect.writes),
            tuple((columns[to].place, columns[of].place) for to, of in each.effect.copies),
            tuple(each.edits),
            each.apart,
            Parts({exchange.name(name): exchange.name(model) for name, model in models.items()}),
        )

    def _written(self, writes: Writes) -> tuple[tuple[Place, Any], ...]:
        columns = self.columns.all
        return tuple((columns[number].place, columns[number].values[code]) for number, code in writes)

    def _effect(self, outcome: Outcome) -> Effect:
        number = self.columns.number
        writes = [
            (number(place), self.columns.all[number(place)].code(held)) for place, held in outcome.writes
        ]
        return Effect(writes, [(number(to), number(of)) for to, of in outcome.copies])

    def _part(self, run: Run, step: int, name: Name, outcome: Outcome, kin: Kin | None) -> PartOf:
        assert outcome.parts is not None
        if kin is None and not outcome.parts.has_like(name):
            return PartOf(run, step, name, None)
        exchange = self.likeness.nobody if kin is None else kin.exchange
        return PartOf(run, step, name, outcome.parts.of(name, exchange))

    def _learn_answer(self, tree: int, question: Question, source: CodedSource) -> None:
        self.runs += 1
        recorder = self._recorder(source)
        answer = settled(question(Configuration(self.setting, recorder)))
        leaf = self.leaves.add(())
        self.answers[leaf] = answer
        self._grow(tree, self._found(recorder.scopes[0], source), leaf)

    def _learn_part(self, tree: int, part: PartOf, source: CodedSource) -> None:
        found = self.sharing.known(part.kin, source)
        if found is None:
            run = part.run
            if run.recorder is None:
                self._run(run, source, self.likeness.nobody)
            self.runs += 1
            recorder, concluded = run.recorder, run.concluded[part.step]
            assert recorder is not None
            recorder.source = source  # it agrees on all that the rules themselves asked
            writes, scope = recorder.apart(lambda: self.writing.part(concluded, part.name))
            found = self._found(scope, source, [Outcome(writes=self._written(writes))])
            self.sharing.teach(part.kin, found)
        self._grow_one(tree, found, self._effect(found.outcomes[0]).writes)

    def _learn_edit(self, tree: int, edited: Edited, source: CodedSource) -> None:
        self.runs += 1
        scope = Scope({Ask(edited.cell): source.skeleton(edited.cell)})
        writes = self.writing.edit(edited, source.skeleton(edited.cell))
        self._grow_one(tree, self._found(scope, source), writes)

    def _found(
        self, scope: Scope, source: CodedSource, outcomes: Sequence[Outcome] = (), flags: int = 0
    ) -> Learned:
        codes = {ask: source.code(self.columns.asked(ask)) for ask in scope.asked if ask.question is None}
        return Learned(scope.asked, codes, scope.taken, flags, outcomes)

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

    def _grow_one(self, tree: int, found: Learned, writes: Writes) -> None:
        """Let a tree know that what was asked leads to some writes."""
        self._note_writer(tree, writes)
        self._grow(tree, found, self.leaves.add([Step(Effect(writes))]))

    def _grow(self, tree: int, found: Learned, leaf: int) -> None:
        """Let a tree know that what was asked leads to a leaf."""
        for cell in found.taken:
            self.taken[cell].add(tree)
        path: list[tuple[Ask, Any]] = []
        columns = []
        for ask, answer in found.asked.items():
            number = self.columns.asked(ask)
            columns.append((self.columns.all[number], number))
            path.append((ask, found.codes[ask] if ask.question is None else answer))
        self.trees.grow(tree, path, leaf, columns)

    def _steps(self, actor: Actor, outcomes: Sequence[Outcome], effects: Sequence[Effect]) -> list[Step]:
        keys = [(each.label, each.shown) for each in outcomes]
        first, steps = len(self.leaves.rule), []
        for number, (key, outcome, effect) in enumerate(zip(keys, outcomes, effects, strict=True), first):
            assert outcome.label is not None
            self.steps[number] = outcome.label
            rule = self.rules.setdefault(outcome.label.rule, len(self.rules))
            steps.append(Step(effect, rule, outcome.turn, self._alike(actor, key, keys, number)))
        return steps

    def _alike(self, actor: Actor, key: Hashable, beside: Sequence[Hashable], number: int) -> int:
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


def general(label: Label) -> Label:
    """Return a label without what is received: receiving equal observations ends alike."""
    return replace(label, about=NOTHING_RECEIVED) if isinstance(label.about, Received) else label


def is_crowded(c: Configuration, a: Name, most: int) -> bool:
    """Tell whether an agent has more pending requests or messages than are explored."""
    return c.eta.count(a) > most or c.test(mailbox_cell(a), is_longer, most)


def is_longer(value: tuple[object, ...] | None, most: int) -> bool:
    """Ask whether a cell holds more than so many."""
    return value is not None and len(value) > most
