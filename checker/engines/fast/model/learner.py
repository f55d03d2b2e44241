"""The learner: runs a rule once for each distinct sequence of answers to its reads, and stores the result in a tree.

An actor is the server of an agent's requests, an agent's own steps, or a clause of the environment. Each actor has a
decision tree with its transitions at the leaves. A pointwise definition has one part for each mobile name, and each
part has a tree of its own. So the answers of an observation for different names do not multiply.
"""

from collections import defaultdict
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from checker.engines.fast.model.columns import Columns, Packing, Place, Writes
from checker.engines.fast.model.decision_leaves import (
    ALIKE,
    CROWDED,
    NO_TURN,
    STEP,
    UNLIKE,
    Effect,
    LeafStep,
    LeafTables,
)
from checker.engines.fast.model.decision_trees import UNKNOWN, Trees
from checker.engines.fast.model.effects import EffectWriter, RecordedEffect, Relearn, Varies
from checker.engines.fast.model.interchangeable import Likeness
from checker.engines.fast.model.rule_cache import CachedOutcome, Exchange, Kin, PartLessons
from checker.engines.fast.model.rule_cache_lookup import Learned, SharedLessons
from checker.recording.access_recording import (
    CellRecorder,
    CellSource,
    ColumnQuestion,
    Edited,
    QuestionScope,
)
from checker.recording.value_templates import agents_of, mobile_names, settled
from semantics.behaviours.expressions import Fault
from semantics.behaviours.observations import Fact, Observation
from semantics.environment import Clause
from semantics.races.monitor import marked
from semantics.state.agents import mailbox_cell
from semantics.state.cell_values import Cell, Row
from semantics.state.configuration import Configuration, Label, Transition
from semantics.state.requests import Received
from semantics.state.setting import Setting
from semantics.state.signature import Name
from semantics.successors import remembered, served, turn_of


class TransitionGroup(NamedTuple):
    """Some rules, and the agent or clause to which they apply."""

    rules: Callable[[Configuration, Any], Iterable[Transition | Fault]]
    about: Name | Clause


Question = Callable[[Configuration], Hashable]
"""A pure function of a configuration; its tree classifies rows by the answer."""

NOTHING_RECEIVED = Received(Observation.of())

PREDICTED = ("code", "store", "line")
"""Cells that vary in every mission; other cells are marked as varying at their first write."""


@dataclass(slots=True, eq=False)
class RuleRun:
    """One run of an actor's rules; after a shared lesson it happens only when one of its parts is unknown.

    Attributes:
        actor: The actor.
        recorder: The recorder of the run; its source may be any configuration of the same leaf.
        concluded: The transitions.
    """

    actor: TransitionGroup
    recorder: CellRecorder | None = None
    concluded: list[RecordedEffect] = field(default_factory=list)


@dataclass(frozen=True, slots=True, eq=False)
class PartOf:
    """The owner of a part's tree.

    Attributes:
        run: The run of the rules.
        step: The index of its transition.
        name: The name that the part is about.
        kin: The lessons of interchangeable parts; None if there are none.
    """

    run: RuleRun
    step: int
    name: Name
    kin: Kin | None


@dataclass(slots=True)
class LabelEntry:
    """A label: its number, the first actor with it, and all transitions with it."""

    number: int
    first: TransitionGroup
    steps: list[int] = field(default_factory=list)


@dataclass(slots=True)
class CodedSource(CellSource):
    """A configuration as a packed row; only the requested columns are decoded."""

    columns: Columns
    packing: Packing
    words: list[int]

    def skeleton(self, cell: Cell) -> Any:
        """Return the skeleton of a cell's value, None if there is no such cell."""
        return self._value((cell,))

    def fact(self, cell: Cell, number: int, name: Name) -> Fact:
        """Return the fact about a mobile name in a hole of a cell."""
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
    """Everything learned about a mission's rules.

    Attributes:
        setting: The mission.
        still: The initial configuration, with the value of every constant cell.
        pending: The number of requests or messages beyond which an agent is crowded, and its row not expanded.
        runs: The number of runs of an actor's rules in Python.
        owners: The owner of each tree.
        taken: For each cell, the trees that assume it to be constant.
        writers: For each cell, the trees that write it.
        homes: For each cell and each name, the first tree of the first actor that writes the cell, or a cell of the
            name.
        answers: The answer of each leaf of a question.
        reads: For each leaf of an actor, the columns and questions on its path, with the answers.
        steps: The label of each transition.
        whose: The actor of each transition.
        paths: For each leaf the columns on its path.
        writing_trees: The trees of parts with a transition that writes.
        awoken: The number of trees of parts that had none of these transitions, until they learned one.
    """

    setting: Setting
    still: Row
    pending: int
    columns: Columns = field(init=False)
    writing: EffectWriter = field(init=False)
    likeness: Likeness = field(init=False)
    sharing: SharedLessons = field(init=False)
    trees: Trees = field(default_factory=Trees)
    leaves: LeafTables = field(default_factory=LeafTables)
    owners: list[TransitionGroup | PartOf | Edited | Question] = field(default_factory=list)
    taken: defaultdict[Cell, set[int]] = field(default_factory=lambda: defaultdict(set))
    writers: defaultdict[Cell, set[int]] = field(default_factory=lambda: defaultdict(set))
    homes: dict[Cell | Name, int] = field(default_factory=dict)
    planted: dict[TransitionGroup | Edited, int] = field(default_factory=dict)
    varying: set[Cell] = field(default_factory=set)
    rules: dict[str, int] = field(default_factory=dict)
    labels: dict[Hashable, LabelEntry] = field(default_factory=dict)
    steps: dict[int, Label] = field(default_factory=dict)
    whose: dict[int, TransitionGroup] = field(default_factory=dict)
    answers: dict[int, Hashable] = field(default_factory=dict)
    reads: dict[int, tuple[tuple[int, ColumnQuestion, Any], ...]] = field(default_factory=dict)
    paths: dict[int, tuple[int, ...]] = field(default_factory=dict)
    writing_trees: set[int] = field(default_factory=set)
    awoken: int = 0
    runs: int = 0

    def __post_init__(self) -> None:
        mobile = mobile_names(self.setting, self.still)
        self.columns = Columns(mobile, agents_of(self.setting, self.still))
        self.writing = EffectWriter(self.columns, self.still, self.varying)
        self.likeness = Likeness(self.setting, self.still, mobile, self.columns.apart)
        self.sharing = SharedLessons(self.likeness, self.columns, self.varying, self.still)
        for cell, value in self.still.items():
            self.columns.start(cell, value)
            if cell[0] in PREDICTED or (cell[0] in ("placement", "parent") and cell[-1] in mobile):
                self.varying.add(cell)

    def tree(self, actor: TransitionGroup | Edited) -> int:
        """Return the number of the tree of an actor, or of an edit; all transitions with that edit share its tree."""
        if actor not in self.planted:
            self.planted[actor] = self._plant(actor)
        return self.planted[actor]

    def question(self, question: Question) -> int:
        """Return the number of a new tree for a question."""
        return self._plant(question)

    def _plant(self, owner: TransitionGroup | PartOf | Edited | Question) -> int:
        self.owners.append(owner)
        return self.trees.plant()

    def learn(self, tree: int, source: CodedSource) -> None:
        """Run the rules of a tree's actor on a configuration, and add their reads and writes to the tree."""
        while not self._learned(tree, source):
            pass

    def _learned(self, tree: int, source: CodedSource) -> bool:
        """Learn the path of a configuration in a tree; return False if an assumption about a cell proved wrong."""
        owner = self.owners[tree]
        try:
            if isinstance(owner, PartOf):
                self._learn_part(tree, owner, source)
                return True
            if isinstance(owner, TransitionGroup):
                self._learn_root(tree, owner, source)
            elif isinstance(owner, Edited):
                self._learn_edit(tree, owner, source)
            else:
                self._learn_answer(tree, owner, source)
        except Relearn as news:
            self.relearn(news)
            return False
        return True

    def settle(self) -> None:
        """Answer the questions of all trees for new values of their columns."""
        self.trees.settle(self.columns.growth.valued)
        self.columns.growth.valued.clear()

    def relearn(self, news: Relearn) -> None:
        """Discard the trees that assumed this cell to be constant or shallower, for all interchangeable cells."""
        self.sharing.forgotten += 1
        for cell in dict.fromkeys((news.cell, *self.likeness.alike(news.cell))):
            if isinstance(news, Varies):
                self.varying.add(cell)
                self.forget_those(self.taken, cell)
            elif cell in self.varying:
                self.columns.dig(cell, self.columns.holes[news.cell])
                self.forget_those(self.writers, cell)

    def forget(self) -> None:
        """Discard all trees."""
        for tree in range(len(self.owners)):
            self.trees.forget(tree)
        self.trees.questioned.clear()

    def forget_those(self, trees: dict[Cell, set[int]], cell: Cell) -> None:
        """Discard the trees recorded for a cell."""
        for tree in trees.pop(cell, ()):
            self.trees.forget(tree)

    def _learn_root(self, tree: int, actor: TransitionGroup, source: CodedSource) -> None:
        kin, run = self.sharing.kin_of(actor.rules, actor.about), RuleRun(actor)
        exchange = self.likeness.nobody if kin is None else kin.exchange
        found = self.sharing.known(kin, source)
        if found is None:
            found = self._run(run, source, exchange)
            self.sharing.teach(kin, found)
        steps, parts = [], []
        for number, outcome in enumerate(found.outcomes):
            effect = self._effect(outcome, found.codes)
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

    def _run(self, run: RuleRun, source: CodedSource, exchange: Exchange) -> Learned:
        """Run an actor's rules on a configuration; `exchange` renames interchangeable parts as in the shared lesson."""
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

    def _recorder(self, source: CodedSource) -> CellRecorder:
        return CellRecorder(source, self.still, self.varying.__contains__, self.columns.mobile)

    def _outcome(self, each: RecordedEffect, scope: QuestionScope, exchange: Exchange) -> CachedOutcome:
        columns, models = self.columns.all, self.likeness.models(each.apart, scope)
        return CachedOutcome(
            general(each.step.label),
            each.step.shown,
            _turn(each.step),
            self._written(each.effect.writes),
            tuple((columns[to].place, columns[of].place) for to, of in each.effect.copies),
            tuple(each.edits),
            each.apart,
            PartLessons({exchange.name(name): exchange.name(model) for name, model in models.items()}),
        )

    def _written(self, writes: Writes) -> tuple[tuple[Place, Any], ...]:
        columns = self.columns.all
        return tuple((columns[number].place, columns[number].values[code]) for number, code in writes)

    def _effect(self, outcome: CachedOutcome, read: Mapping[ColumnQuestion, int]) -> Effect:
        """Return the effect of an outcome, without the writes of values that were read in the same column."""
        number = self.columns.number
        there = {self.columns.asked(ask): code for ask, code in read.items()}
        writes = [
            (number(place), self.columns.all[number(place)].code(held)) for place, held in outcome.writes
        ]
        writes = [(column, code) for column, code in writes if there.get(column) != code]
        return Effect(writes, [(number(to), number(of)) for to, of in outcome.copies])

    def _part(self, run: RuleRun, step: int, name: Name, outcome: CachedOutcome, kin: Kin | None) -> PartOf:
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
            recorder.source = source  # it gives the same answers to the rules' own questions
            writes, scope = recorder.apart(lambda: self.writing.part(concluded, part.name))
            found = self._found(scope, source, [CachedOutcome(writes=self._written(writes))])
            self.sharing.teach(part.kin, found)
        self._grow_one(tree, found, self._effect(found.outcomes[0], found.codes).writes)

    def _learn_edit(self, tree: int, edited: Edited, source: CodedSource) -> None:
        self.runs += 1
        scope = QuestionScope({ColumnQuestion(edited.cell): source.skeleton(edited.cell)})
        writes = self.writing.edit(edited, source.skeleton(edited.cell))
        self._grow_one(tree, self._found(scope, source), writes)

    def _found(
        self,
        scope: QuestionScope,
        source: CodedSource,
        outcomes: Sequence[CachedOutcome] = (),
        flags: int = 0,
    ) -> Learned:
        codes = {ask: source.code(self.columns.asked(ask)) for ask in scope.asked if ask.question is None}
        return Learned(scope.asked, codes, scope.taken, flags, outcomes)

    def _note_writer(self, tree: int, writes: Writes) -> None:
        cells = dict.fromkeys(self.columns.all[number].place[0] for number, _ in writes)
        owner = self.owners[tree]
        for cell in cells:
            self.writers[cell].add(tree)
            if isinstance(owner, TransitionGroup):
                home = self.homes.setdefault(cell, self._home(owner))
                self.homes.setdefault(cell[-1], home)

    def _home(self, actor: TransitionGroup) -> int:
        """Return the first tree of the agent or clause of an actor."""
        return min(
            tree
            for each, tree in self.planted.items()
            if isinstance(each, TransitionGroup) and each.about == actor.about
        )

    def by_home(self) -> list[int]:
        """Return all column numbers, grouped by the actor that writes the column."""
        last = len(self.owners)

        def home(number: int) -> tuple[int, int]:
            cell = self.columns.all[number].place[0]
            return self.homes.get(cell, self.homes.get(cell[-1], last)), number

        return sorted(range(len(self.columns)), key=home)

    def _grow_one(self, tree: int, found: Learned, writes: Writes) -> None:
        """Add a path with a single effect to a tree."""
        self._note_writer(tree, writes)
        if writes and tree not in self.writing_trees:
            self.awoken += int(self.trees.root.room[tree]) != UNKNOWN
            self.writing_trees.add(tree)
        self._grow(tree, found, self.leaves.add([LeafStep(Effect(writes))]))

    def _grow(self, tree: int, found: Learned, leaf: int) -> None:
        """Add a path to a leaf to a tree."""
        for cell in found.taken:
            self.taken[cell].add(tree)
        path: list[tuple[ColumnQuestion, Any]] = []
        columns = []
        for ask, answer in found.asked.items():
            number = self.columns.asked(ask)
            columns.append((self.columns.all[number], number))
            path.append((ask, found.codes[ask] if ask.question is None else answer))
        self.paths[leaf] = tuple(number for _, number in columns)
        self.trees.grow(tree, path, leaf, columns)

    def _steps(
        self, actor: TransitionGroup, outcomes: Sequence[CachedOutcome], effects: Sequence[Effect]
    ) -> list[LeafStep]:
        keys = [(each.label, each.shown) for each in outcomes]
        first, steps = len(self.leaves.rule), []
        for number, (key, outcome, effect) in enumerate(zip(keys, outcomes, effects, strict=True), first):
            assert outcome.label is not None
            self.steps[number] = outcome.label
            rule = self.rules.setdefault(outcome.label.rule, len(self.rules))
            steps.append(LeafStep(effect, rule, outcome.turn, self._alike(actor, key, keys, number)))
        return steps

    def _alike(self, actor: TransitionGroup, key: Hashable, beside: Sequence[Hashable], number: int) -> int:
        """Return the number of a label that two transitions of one configuration may share, else `UNLIKE`.

        They share it within one leaf, or in two clauses.
        """
        known = self.labels.setdefault(key, LabelEntry(len(self.labels), actor))
        if known.first != actor:  # earlier transitions with the label must be compared, too
            for other in known.steps:
                self.leaves.steps.room[STEP * other + ALIKE] = known.number
        known.steps.append(number)
        return known.number if known.first != actor or beside.count(key) > 1 else UNLIKE


def _turn(step: Transition) -> int:
    turn = turn_of(step)
    return NO_TURN if turn is None else turn


def general(label: Label) -> Label:
    """Return a label without the received observation: receiving equal observations ends alike."""
    return replace(label, about=NOTHING_RECEIVED) if isinstance(label.about, Received) else label


def is_crowded(c: Configuration, a: Name, most: int) -> bool:
    """Return whether an agent has more pending requests or messages than the exploration follows."""
    return c.eta.count(a) > most or c.test(mailbox_cell(a), is_longer, most)


def is_longer(value: tuple[object, ...] | None, most: int) -> bool:
    """Return whether a cell holds more than `most` elements."""
    return value is not None and len(value) > most
