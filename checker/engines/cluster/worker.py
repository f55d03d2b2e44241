"""A worker: explores with the others; answers surveys, edges and checkpoints for its rows, which it numbers itself."""

import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.cluster import checkpoints
from checker.engines.cluster.links import Links
from checker.engines.cluster.rounds import Mark, Stage, kept, mark
from checker.engines.cluster.shard import Shard, Standing
from checker.engines.cluster.transfer import Parcel
from checker.engines.contract import CheckpointError, Inspect
from checker.engines.fast import kernel as loops
from checker.engines.fast.graph import pending_in_space
from checker.engines.fast.inspecting import inspect_fast, is_still, truths
from checker.engines.fast.kernel import AT, GATHERED
from checker.engines.fast.survey import Survey
from checker.properties.inspections import Invariant
from checker.properties.vacuity import asked
from checker.properties.visited import Visited
from semantics.properties.propositions import Atom, Proposition, atoms_of
from semantics.state.cells import Row
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import Request

Edges = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int64], tuple[Label, ...]]
"""Of some transitions the rows they leave, the numbers of their labels, whose rows they lead to, and to which of those
(less than 0: to none); and the labels."""


class Worker:
    """One of the processes that explore together; what has `links` in it is asked of all at once.

    Attributes:
        shard: Its rows, and what it learned.
        links: Its links to the others.
    """

    def __init__(self, initial: Configuration, pending: int, me: int, workers: int, links: Links) -> None:
        self.initial = initial
        self.links = links
        self.shard = Shard(initial, pending, me, workers)

    def told(self, news: Any) -> list[Any]:
        """Tell all the same, and return what each tells."""
        return self.links.exchange([news] * self.shard.workers)

    # --- rounds ---------------------------------------------------------------------------------------------------

    def start(self) -> Standing:
        """Begin anew with the initial configuration."""
        self.shard.start()
        return self.shard.standing()

    def explore(self, layer: int, stage: Stage) -> tuple[int, Standing]:
        """Go on from a layer for a round at least; return the layer, and how far it has come.

        In a round some rows of the layer are expanded, and what the others have reached is taken in. The next layer
        begins when nobody has rows of this one, so distances are those of a breadth-first search.
        """
        shard, end = self.shard, time.monotonic() + stage.seconds
        marks = self._marks()
        while True:
            if all(each.expanded == each.end for each in marks):
                layer += 1
            before = [each.size for each in marks]
            shard.take(*self.links.exchange(shard.expand(layer, stage.rows)))
            marks = self._marks(is_late=time.monotonic() >= end)
            sizes = [each.size for each in marks]
            if stage.configurations is not None and sum(sizes) > stage.configurations:
                sizes = kept(before, sizes, stage.configurations)
                shard.keep(sizes[shard.me])
                marks = [each._replace(size=size) for each, size in zip(marks, sizes, strict=True)]
            if stage.is_over(marks):
                return layer, shard.standing()

    def _marks(self, *, is_late: bool = False) -> list[Mark]:
        shard = self.shard
        return self.told(mark(shard.size, shard.expanded, shard.end, is_late=is_late))

    # --- checkpoints ----------------------------------------------------------------------------------------------

    def save(self, folder: str, number: int, digest: str) -> None:
        """Write a checkpoint."""
        checkpoints.save(self.shard, Path(folder), number, digest)

    def drop(self, folder: str, number: int) -> None:
        """Remove a checkpoint, if there is one."""
        checkpoints.path_of(Path(folder), number, self.shard.me).unlink(missing_ok=True)

    def load(self, folder: str, number: int, digest: str, layer: int) -> Standing:
        """Go back to a checkpoint, in which some layer was expanded; all tell each other what they have forgotten.

        Raises:
            CheckpointError: It is damaged, or of something else.
        """
        loading, shard = checkpoints.Loading(self.shard, Path(folder), number, digest), self.shard
        recalled: list[tuple[int, int]] = []
        while True:
            loading.recall()
            shard.hear(self.links.exchange(shard.parcels(always=True)))
            before, recalled = recalled, self.told((loading.missing(), len(shard.keys.keys)))
            if not any(missing for missing, _ in recalled):
                break
            if recalled == before:
                raise CheckpointError(
                    f"{folder}: what is learned from this checkpoint is not what was learned"
                )
        loading.finish()
        if not all(self.told(self._fits(layer, self.told(shard.boundaries)))):
            raise CheckpointError(f"{folder}: the workers' parts of this checkpoint don't fit together")
        return shard.standing()

    def _fits(self, layer: int, boundaries: list[tuple[int, ...]]) -> bool:
        """Tell whether what it went back to fits to a layer, and to where all workers' layers begin."""
        whole = all(
            len(each) == layer + 3 for each in boundaries
        )  # layers as far as that, its end, and the next's
        return whole and self.shard.has_origins_in(boundaries)

    # --- what was found -------------------------------------------------------------------------------------------

    def standing(self) -> Standing:
        """Return how far it has come."""
        return self.shard.standing()

    def summary(self) -> tuple[tuple[int, ...], dict[str, int]]:
        """Return where its layers begin and end, and how many transitions each rule has."""
        return self.shard.boundaries, dict(self.shard.rules())

    def rows(self, numbers: list[int]) -> list[Row]:
        """Return some of its configurations' cells."""
        return [self.shard.row(number) for number in numbers]

    def origin(self, row: int) -> tuple[int, int]:
        """Return the worker and the row that a row was first reached from."""
        row, worker = divmod(self.shard.rows.origins.origin(row, self.shard.size), self.shard.workers)
        return worker, row

    def inspect(self, inspections: tuple[Inspect, ...]) -> tuple[Inspect, ...]:
        """Return inspections that have looked at its rows."""
        shard = self.shard
        inspect_fast(Survey(shard), inspections)
        for each in inspections:
            if isinstance(each, Visited):
                each.happened |= shard.happened_before
            if isinstance(each, Invariant) and shard.expanded and each.valuations.still is not None:
                each.valuations.still = {} if self._answers_as_first(tuple(atoms_of(each.formula))) else None
        return inspections

    def _answers_as_first(self, atoms: tuple[Atom, ...]) -> bool:
        return asked(atoms, self.initial) == asked(atoms, self.shard.configuration(0))

    # --- what temporal properties ask -----------------------------------------------------------------------------

    def truths(self, formulas: Iterable[Proposition]) -> list[NDArray[np.bool_]]:
        """Return where propositions are true."""
        survey = Survey(self.shard)
        return [truths(survey, each, self.shard.size) for each in formulas]

    def is_still(self, atoms: tuple[Atom, ...]) -> bool:
        """Tell whether atoms ask all its configurations what the first one answers alike."""
        if not self.shard.expanded:
            return True
        return is_still(Survey(self.shard), atoms) and self._answers_as_first(atoms)

    def pending(self) -> dict[Request, NDArray[Any]]:
        """Return where each request is pending."""
        return pending_in_space(Survey(self.shard))

    def edges(self, first: int, most: int) -> Edges:
        """Return the transitions of some of its rows."""
        shard = self.shard
        until = min(first + most, shard.expanded)
        shard.state[AT], found = min(first, until), []
        while shard.state[AT] < until:
            known = loops.gather(
                shard.model, shard.rows.words, shard.rows.folded, shard.batch, shard.state, until
            )
            found.append(self._point())
            if not known:
                shard.go_on()
        edges = self._edges(found)
        _, _, owners, targets, _ = edges
        answers = self.links.exchange(self._find(self.links.exchange(shard.parcels())))
        for owner, answer in enumerate(answers):
            if owner != shard.me:
                targets[owners == owner] = answer
        return edges

    def _point(self) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int64]]:
        """Return the transitions of a batch; lay out those of their targets to be sent that are others' rows."""
        shard, count = self.shard, int(self.shard.state[GATHERED])
        shard.state[GATHERED] = 0
        batch, width = shard.batch, shard.packing.words
        owners = shard.owners_of(batch.words, batch.origins[:count])
        targets = self._found(count)
        others = np.flatnonzero(owners != shard.me)
        shard.outbox.add(batch.words.reshape(-1, width)[others], batch.origins[others], owners[others])
        return batch.origins[:count].copy(), batch.steps[:count].copy(), owners, targets

    def _found(self, count: int) -> NDArray[np.int64]:
        """Return which of its rows each of the batch is, less than 0 where it is none."""
        shard, found = self.shard, np.zeros(count, np.int64)
        loops.look_up(shard.rows.words, shard.table.room, None, None, shard.batch, found, shard.state)
        return found

    def _edges(self, found: Sequence[tuple[NDArray[Any], ...]]) -> Edges:
        numbers: dict[Label, int] = {}
        learner = self.shard.learner
        action_of = np.zeros(len(learner.leaves.rule), np.int32)
        for step, label in learner.steps.items():
            action_of[step] = numbers.setdefault(label, len(numbers))
        nothing = (np.zeros(0, np.int64), np.zeros(0, np.int32), np.zeros(0, np.int32), np.zeros(0, np.int64))
        rows, steps, owners, targets = (np.concatenate(each) for each in zip(nothing, *found, strict=True))
        return rows, action_of[steps], owners, targets, tuple(numbers)

    def _find(self, parcels: Sequence[Parcel]) -> list[NDArray[np.int64]]:
        """Return for each worker which of one's own rows those in its parcel are, less than 0 where they are none."""
        self.shard.hear(parcels)
        found = []
        for peer, parcel in enumerate(parcels):
            parts = [self._found(count) for count in self.shard.translated(peer, parcel)]
            found.append(np.concatenate([np.zeros(0, np.int64), *parts]))
        return found
