"""A worker: explores with the others, and answers surveys, edges and checkpoints for its own rows."""

import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from checker.engines.cluster import checkpoints
from checker.engines.cluster.rounds import Mark, RoundLimits, kept, mark
from checker.engines.cluster.shard import Shard, ShardProgress
from checker.engines.cluster.transfer import RowParcel
from checker.engines.cluster.worker_links import Links
from checker.engines.contract import CheckpointError, Inspect, sample
from checker.engines.fast.model.learned_model import AT
from checker.engines.fast.search.crosscheck import crosscheck, in_batch
from checker.engines.fast.survey.row_graph import actions_of, pending_in_rows
from checker.engines.fast.survey.row_inspection import inspect_fast, is_still, truths
from checker.properties.inspections import Invariant
from checker.properties.invariant_vacuity import asked
from checker.properties.visited_statements import Visited
from checker.reduction.reducer import Reduced
from semantics.properties.propositions import Atom, Proposition, atoms_of
from semantics.state.cell_values import Row
from semantics.state.configuration import Configuration, Label
from semantics.state.requests import Request

Edges = tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int64], tuple[Label, ...]]
"""Transitions: their rows, the numbers of their labels, the workers and rows of their targets (less than 0: none), and
the labels."""


class Worker:
    """One of the processes that explore together.

    A method that uses `links` must be called on all workers at once.

    Attributes:
        shard: Its rows, and the rules that it has learned.
        links: Its links to the others.
    """

    def __init__(
        self,
        initial: Configuration,
        pending: int,
        me: int,
        workers: int,
        links: Links,
        reduce: Reduced | None = None,
    ) -> None:
        self.initial = initial
        self.links = links
        self.shard = Shard(initial, pending, me, workers, reduce)

    def told(self, news: Any) -> list[Any]:
        """Send the same to all workers, and return the items received from each."""
        return self.links.exchange([news] * self.shard.workers)

    # --- rounds ---------------------------------------------------------------------------------------------------

    def start(self) -> ShardProgress:
        """Begin with the initial configuration."""
        self.shard.start()
        return self.shard.standing()

    def explore(self, layer: int, stage: RoundLimits) -> tuple[int, ShardProgress]:
        """Explore from a layer for at least one round; return the layer and the worker's progress.

        In a round each worker expands rows of the layer and stores the successors that the others send. The next layer
        begins when no worker has rows of this one left. So distances are those of a breadth-first search.
        """
        shard, end = self.shard, time.monotonic() + stage.seconds
        marks = self._marks()
        while True:
            if all(each.expanded == each.end for each in marks):
                layer += 1
            before = [each.size for each in marks]
            shard.take(*self.links.exchange(shard.expand(layer, stage.rows)))
            if shard.choosing is not None:
                shard.lead_on(self.links)
                shard.take(*self.links.exchange(shard.parcels()))
            marks = self._marks(is_late=time.monotonic() >= end)
            sizes = [each.size for each in marks]
            if stage.configurations is not None and sum(sizes) > stage.configurations:
                sizes = kept(before, sizes, stage.configurations)
                shard.store.keep(sizes[shard.me])
                marks = [each._replace(size=size) for each, size in zip(marks, sizes, strict=True)]
            if stage.is_over(marks):
                return layer, shard.standing()

    def _marks(self, *, is_late: bool = False) -> list[Mark]:
        shard = self.shard
        return self.told(mark(shard.size, shard.expanded, shard.end, is_late=is_late))

    def spill(self, folder: str) -> tuple[str, ShardProgress]:
        """Move the rows to files in a folder of this machine; return why that failed, if it did, and the progress."""
        failure = ""
        try:
            self.shard.store.spill(Path(folder))
        except OSError as error:
            failure = str(error.strerror)
        return failure, self.shard.standing()

    # --- checkpoints ----------------------------------------------------------------------------------------------

    def save(self, folder: str, number: int, digest: str) -> None:
        """Write a checkpoint."""
        checkpoints.save(self.shard, Path(folder), number, digest)

    def drop(self, folder: str, number: int) -> None:
        """Remove a checkpoint, if there is one."""
        checkpoints.path_of(Path(folder), number, self.shard.me).unlink(missing_ok=True)

    def load(self, folder: str, number: int, digest: str, layer: int) -> ShardProgress:
        """Return to a checkpoint with a layer in expansion; the workers exchange the values of their rows again.

        Raises:
            CheckpointError: It is damaged, or of another exploration.
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
                    f"{folder}: the rules learned from this checkpoint differ from those recorded in it"
                )
        loading.finish()
        if not all(self.told(self._fits(layer, self.told(shard.boundaries)))):
            raise CheckpointError(f"{folder}: the workers' parts of this checkpoint don't fit together")
        return shard.standing()

    def _fits(self, layer: int, boundaries: list[tuple[int, ...]]) -> bool:
        """Return whether the loaded rows fit the layer, and the boundaries of all workers' layers."""
        whole = all(
            len(each) == layer + 3 for each in boundaries
        )  # the layers so far, the end of this one, and that of the next
        return whole and self.shard.has_origins_in(boundaries)

    # --- results ----------------------------------------------------------------------------------------------------

    def standing(self) -> ShardProgress:
        """Return the worker's progress."""
        return self.shard.standing()

    def summary(self) -> tuple[tuple[int, ...], dict[str, int], int]:
        """Return the boundaries of its layers, the number of transitions of each rule, and of all enabled ones."""
        return self.shard.boundaries, dict(self.shard.rules()), self.shard.allowed

    def rows(self, numbers: list[int]) -> list[Row]:
        """Return the cells of some configurations."""
        return [self.shard.model.row(number) for number in numbers]

    def origin(self, row: int) -> tuple[int, int]:
        """Return the worker and the row from which a row was first reached."""
        row, worker = divmod(self.shard.store.origin(row), self.shard.workers)
        return worker, row

    def crosscheck(self, expanded: list[int], doubted: int) -> None:
        """Check a sample of all workers' expanded rows again, those that are its own (`--paranoid`)."""
        begin, shard = sum(expanded[: self.shard.me]), self.shard
        rows = [number - begin for number in sample(sum(expanded), doubted)]
        mine = [row for row in rows if 0 <= row < shard.expanded]
        crosscheck(shard.expander, mine, shard.reduce, in_batch)

    def inspect(self, inspections: tuple[Inspect, ...]) -> tuple[Inspect, ...]:
        """Return the inspections, with the findings in its rows."""
        shard = self.shard
        inspect_fast(shard.survey(), inspections)
        for each in inspections:
            if isinstance(each, Visited):
                each.happened |= shard.happened_before
            if isinstance(each, Invariant) and shard.expanded and each.valuations.still is not None:
                each.valuations.still = {} if self._answers_as_first(tuple(atoms_of(each.formula))) else None
        return inspections

    def _answers_as_first(self, atoms: tuple[Atom, ...]) -> bool:
        return asked(atoms, self.initial) == asked(atoms, self.shard.model.configuration(0))

    # --- temporal properties ----------------------------------------------------------------------------------------

    def truths(self, formulas: Iterable[Proposition]) -> list[NDArray[np.bool_]]:
        """Return the truth of propositions in each row."""
        survey = self.shard.survey()
        return [truths(survey, each, self.shard.size) for each in formulas]

    def is_still(self, atoms: tuple[Atom, ...]) -> bool:
        """Return whether everything that the atoms read equals its value in the initial configuration, in all rows."""
        if not self.shard.expanded:
            return True
        return is_still(self.shard.survey(), atoms) and self._answers_as_first(atoms)

    def pending(self) -> dict[Request, NDArray[Any]]:
        """Return the rows in which each request is pending."""
        return pending_in_rows(self.shard.survey())

    def edges(self, first: int, most: int) -> Edges:
        """Return the transitions of a range of rows."""
        shard, expander, state = self.shard, self.shard.expander, self.shard.store.state
        until = min(first + most, shard.expanded)
        state[AT], found = min(first, until), []
        while state[AT] < until:
            known = expander.gather(until)
            found.append(self._point())
            if not known:
                expander.learn()
        edges = self._edges(found)
        _, _, owners, targets, _ = edges
        answers = self.links.exchange(self._find(self.links.exchange(shard.parcels())))
        for owner, answer in enumerate(answers):
            if owner != shard.me:
                targets[owners == owner] = answer
        return edges

    def _point(self) -> tuple[NDArray[np.int64], NDArray[np.int32], NDArray[np.int32], NDArray[np.int64]]:
        """Return the transitions of a batch; put their targets on other workers into the outbox."""
        shard, batch = self.shard, self.shard.expander.batch
        count = shard.expander.gathered()
        owners = shard.owners_of(batch.kept, batch.origins[:count])
        targets = self._found(count)
        others = np.flatnonzero(owners != shard.me)
        shard.send(batch, others, owners[others])
        return batch.origins[:count].copy(), batch.steps[:count].copy(), owners, targets

    def _found(self, count: int) -> NDArray[np.int64]:
        """Return the row number of each successor in the batch, less than 0 for none."""
        shard = self.shard
        return shard.store.look_up(shard.expander.batch, count, shard.model.making)

    def _edges(self, found: Sequence[tuple[NDArray[Any], ...]]) -> Edges:
        action_of, labels = actions_of(self.shard.model.learner)
        nothing = (np.zeros(0, np.int64), np.zeros(0, np.int32), np.zeros(0, np.int32), np.zeros(0, np.int64))
        rows, steps, owners, targets = (np.concatenate(each) for each in zip(nothing, *found, strict=True))
        return rows, action_of[steps], owners, targets, labels

    def _find(self, parcels: Sequence[RowParcel]) -> list[NDArray[np.int64]]:
        """Return, for each worker, the own row numbers of the rows in its parcel, less than 0 for none."""
        self.shard.hear(parcels)
        found = []
        for peer, parcel in enumerate(parcels):
            parts = [self._found(count) for count in self.shard.translated(peer, parcel)]
            found.append(np.concatenate([np.zeros(0, np.int64), *parts]))
        return found
