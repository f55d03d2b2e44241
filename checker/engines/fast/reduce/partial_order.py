"""The tables of partial-order reduction for the compiled loops: footprints as bit sets, actors as numbers.

The loops choose the same ample sets as `checker.reduction.ample`, configuration by configuration.
"""

from collections.abc import Callable
from itertools import islice
from typing import Any, NamedTuple

import numpy as np

from checker.engines.fast.compiled.arrays import Growing
from checker.engines.fast.compiled.bits import WORD
from checker.engines.fast.model.columns import Packing
from checker.engines.fast.model.decision_leaves import LEAF
from checker.engines.fast.model.learner import Learner
from checker.engines.fast.reduce.actor_tables import (
    AGENTS_OWN,
    FAIR,
    KINDS,
    MOST_HERE,
    NAMED,
    PARTS,
    RECORD,
)
from checker.engines.fast.reduce.proviso_paths import EDGES, FORWARD, SINGLE, SearchPaths
from checker.recording.value_templates import agents_of
from checker.reduction.actor_footprints import Acting, Actor
from checker.reduction.ample import Ample
from checker.reduction.footprint_slots import SlotFootprint
from checker.reduction.visible_slots import VisiblePart
from semantics.state.configuration import Configuration, Label
from semantics.state.signature import Name
from semantics.timing.arrivals import never_ends

NOBODY = -1

AGENT_PARTS = ("program", "line", "request")


class Here(NamedTuple):
    """An answer of a tree: the actors of one agent or clause, with their footprints."""

    actors: tuple[tuple[Actor, Acting], ...]


class Choosing:
    """The tables of a mission's actors; they grow with learning.

    Attributes:
        learned: The tables in the form that the loops read: the first fields of `Members`.
        movers: For each transition the number of its agent, plus 1; 0 for a clause (see `Trails.movers`).
        paths: The paths of the search so far.
    """

    learned: tuple[Any, ...]

    def __init__(self, learner: Learner, ample: Ample) -> None:
        self.learner = learner
        self.ample = ample
        self.agents: dict[Name, int] = {}
        self.groups: list[tuple[Name, ...]] = []
        self.trees = (np.zeros(1, np.int32), np.zeros(0, np.int32))
        actors = ample.actors
        self.clauses = [
            learner.question(_of_clause(ample, number)) for number in range(len(actors.setting.environment))
        ]
        self.numbers: dict[Actor, int] = {}
        self.everyone = {name: k for k, name in enumerate(sorted(agents_of(learner.setting, learner.still)))}
        self.part = Growing(np.int32)
        self.footprints: dict[SlotFootprint, int] = {}
        self.begins = Growing(np.int32)
        self.actors = Growing(np.int32)
        self.step_actor = Growing(np.int32)
        self.step_flags = Growing(np.int32)
        self.movers = Growing(np.int64)
        asked = {FORWARD: ample.forward, SINGLE: ample.single, EDGES: ample.stored}
        self.paths = SearchPaths(len(self.everyone), self.wide, sum(bit for bit in asked if asked[bit]))
        self.stride = self.width = 0
        self.looked: tuple[object, ...] = ()

    @property
    def wide(self) -> int:
        """The number of words for a bit set of the parts of all agents and clauses."""
        return -(-(KINDS * len(self.everyone) + len(self.clauses)) // WORD) or 1

    def see(self, groups: list[tuple[Name, ...]], where: Packing, successors: int) -> None:
        """Rebuild the tables from everything learned; `groups` has the agents for each value of their cell."""
        if groups != self.groups:
            self.groups = list(groups)
            trees = [[*map(self._agent, group), *self.clauses] for group in groups]
            begins = np.cumsum([0, *map(len, trees)])
            self.trees = (
                begins.astype(np.int32),
                np.array([tree for group in trees for tree in group], np.int32),
            )
        self._take_leaves()
        self._take_steps()
        self._take_footprints()
        self._look(where)
        self.paths.most = successors
        self.learned = (
            *self.trees,
            self.begins.room,
            self.actors.room,
            self.part.room,
            self.words,
            self.disturbed,
            self.step_actor.room,
            self.step_flags.room,
            np.flatnonzero(self.seen_masks),
            self.seen_masks,
            self.seen_whole,
            self.seen,
            self.seen_answers,
            len(self.everyone),
            self.stride,
        )

    def new_room(self, successors: int) -> tuple[Any, ...]:
        """Return scratch space for a row with at most `successors` transitions: the last fields of `Members`."""
        sets, words = MOST_HERE * MOST_HERE // WORD, MOST_HERE // WORD
        return (
            np.zeros(MOST_HERE, np.int32),
            np.zeros(MOST_HERE, np.int32),
            np.zeros(len(self.part.room), np.int32),
            np.zeros(successors, np.int32),
            np.zeros(successors, np.uint8),
            np.zeros(successors, np.uint8),
            np.zeros(sets, np.uint64),
            np.zeros(sets, np.uint64),
            np.zeros(MOST_HERE, np.int64),
            *(np.zeros(words, np.uint64) for _ in range(3)),
            np.zeros(MOST_HERE, np.int32),
            np.zeros(MOST_HERE, np.int32),
            np.zeros(self.wide, np.uint64),
            np.zeros(self.wide, np.uint64),
        )

    # --- actors -----------------------------------------------------------------------------------------------------

    def _agent(self, agent: Name) -> int:
        if agent not in self.agents:
            self.agents[agent] = self.learner.question(_of_agent(self.ample, agent))
        return self.agents[agent]

    def _number(self, actor: Actor) -> int:
        if actor not in self.numbers:
            self.numbers[actor] = len(self.numbers)
            self.part.append(self._part(actor))
        return self.numbers[actor]

    def _part(self, actor: Actor) -> int:
        if actor.kind == "clause":
            return KINDS * len(self.everyone) + int(actor.owner)
        return KINDS * self.everyone[str(actor.owner)] + AGENT_PARTS.index(actor.kind)

    def _footprint(self, footprint: SlotFootprint) -> int:
        return self.footprints.setdefault(footprint, len(self.footprints))

    def _take_leaves(self) -> None:
        for leaf in range(len(self.begins) // 2, len(self.learner.leaves.leaves) // LEAF):
            told = self.learner.answers.get(leaf)
            begin = len(self.actors)
            for actor, acting in told.actors if isinstance(told, Here) else ():
                behind = actor.kind == "line"
                self.actors.append(
                    self._number(actor),
                    *map(self._footprint, acting),
                    self._number(Actor("program", actor.owner)) if behind else NOBODY,
                )
            self.begins.append(begin // RECORD, len(self.actors) // RECORD)

    def _take_steps(self) -> None:
        learner = self.learner
        for number in range(len(self.step_actor), len(learner.leaves.rule)):
            whose = learner.whose.get(number)
            if whose is None:  # a part of a transition
                self.step_actor.append(NOBODY)
                self.step_flags.append(0)
                self.movers.append(0)
                continue
            label = learner.steps[number]
            actor = self._actor(label, whose.about)
            self.step_actor.append(self._number(actor))
            self.movers.append(0 if actor.kind == "clause" else 1 + self.everyone[str(actor.owner)])
            self.step_flags.append(_flags(label, learner) | (NAMED if self.ample.eyes.names(label) else 0))

    def _actor(self, label: Label, about: Any) -> Actor:
        if label.agent is not None:
            return self.ample.actors.actor_of(label)
        return Actor("clause", self.ample.actors.setting.environment.index(about))

    def _take_footprints(self) -> None:
        slots = max(1, -(-len(self.ample.actors.footprints.slots.numbers) // WORD))
        count = len(self.footprints)
        if count > self.stride or slots > self.width:
            self.stride, self.width = max(64, 2 * count), slots
            self.words = np.zeros(self.stride * PARTS * slots, np.uint64)
            self.disturbed = np.zeros(self.stride * self.stride, np.uint8)
            self.written = 0
        new = count - self.written
        for footprint, number in islice(reversed(self.footprints.items()), new):
            at = number * PARTS * slots
            self.words[at : at + PARTS * slots] = [
                word
                for bits in (footprint.reads, footprint.writes, footprint.merges)
                for word in _words(bits, slots)
            ]
        self.written = count

    # --- visible bits ----------------------------------------------------------------------------------------------

    def _look(self, where: Packing) -> None:
        """Compute the bits of a row that properties read, and the answers of their questions for each code."""
        columns = self.learner.columns
        looks = [(seen, number) for seen in self.ample.eyes.seen for number in self._columns(seen)]
        looked = (id(where), *((number, len(columns.all[number].values)) for _, number in looks))
        if looked == self.looked:
            return
        self.looked = looked
        self.kept = where  # keeps its id from being reused
        self.seen_masks = np.zeros(where.words, np.uint64)
        self.seen_whole = np.zeros(where.words, np.uint64)
        asked: list[int] = []
        answers: list[int] = []
        numbers: dict[object, int] = {}
        for seen, number in looks:
            bits = where.mask[number] << where.shift[number]
            self.seen_masks[where.word[number]] |= bits
            if seen.question is None:
                self.seen_whole[where.word[number]] |= bits
                continue
            column = columns.all[number]
            asked += [number, len(answers)]
            said = (seen.says(column.value(code)) for code in range(len(column.values)))
            answers += [numbers.setdefault(answer, len(numbers)) for answer in said]
        self.seen = np.array(asked, np.int32)
        self.seen_answers = np.array(answers, np.int32)

    def _columns(self, seen: VisiblePart) -> list[int]:
        """Return the columns of a cell: its skeleton, and the facts in its holes if its value counts."""
        columns = self.learner.columns
        number = columns.numbers.get((seen.cell,))
        holes = range(columns.holes.get(seen.cell, 0) if seen.question is None else 0)
        said = [column for hole in holes for _, column in columns.of_hole(seen.cell, hole)]
        return said if number is None else [number, *said]


def _flags(label: Label, learner: Learner) -> int:
    if label.agent is None:
        return 0
    return AGENTS_OWN | (0 if never_ends(learner.setting, label.about) else FAIR)


def _words(bits: int, count: int) -> list[int]:
    return [(bits >> (WORD * k)) & ((1 << WORD) - 1) for k in range(count)]


def _of_agent(ample: Ample, agent: Name) -> Callable[[Configuration], Here]:
    def told(c: Configuration) -> Here:
        return Here(tuple(ample.actors.of_agent(c, agent).items()))

    return told


def _of_clause(ample: Ample, number: int) -> Callable[[Configuration], Here]:
    def told(c: Configuration) -> Here:
        return Here(tuple(ample.actors.of_clause(c, number).items()))

    return told
