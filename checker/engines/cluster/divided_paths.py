"""The paths of the cycle proviso in a search that several workers divide (see `checker.reduction.cycle_proviso`).

A row has a number for all workers: row · workers + worker. A path continues from a row at its *lead*. A row whose steps
are all followed has none.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from checker.engines.cluster.worker_links import Links
from checker.engines.contract import CheckpointError
from checker.engines.fast.compiled.mapped_arrays import Pages

Numbers = NDArray[np.int64]

MOST_HOPS = 64
"""More rounds of shortening than a path without a circle needs: each doubles the length that it spans."""

NONE = np.zeros(0, np.int64)


@dataclass(slots=True)
class ReducedRound:
    """The rows that a worker expands in a round, and the steps that it follows.

    Attributes:
        rows: The rows.
        reduced: For each of them, whether some step is left out.
        followed: The origins, steps and workers of targets, and their places there (see `place_of`), in parts.
    """

    rows: range
    reduced: NDArray[np.bool_]
    followed: list[tuple[NDArray[np.int64], ...]] = field(default_factory=lambda: [(NONE, NONE, NONE, NONE)])

    def whole(self, answers: Sequence[Numbers]) -> tuple[NDArray[np.int64], ...]:
        """Return what was followed in one part, with the places that other workers answered."""
        origins, steps, owners, places = map(np.concatenate, zip(*self.followed, strict=True))
        for peer, told in enumerate(answers):
            places[owners == peer] = told if len(told) else places[owners == peer]
        return origins, steps, owners, places


def place_of(numbers: Numbers, end: int) -> Numbers:
    """Return the places of rows: twice the row, and 1 if it is in the next layer, from `end` on, or was left out."""
    return 2 * numbers + ((numbers < 0) | (numbers >= end))


class DividedPaths:
    """The leads of one worker's rows.

    Attributes:
        leads: For each row, the number plus 1 of a row further on its path; 0 at its end.
    """

    def __init__(self, me: int, workers: int) -> None:
        self.me = me
        self.workers = workers
        self.leads = Pages(np.int64, 1)

    def lead_on(self, links: Links, found: ReducedRound, answers: Sequence[Numbers]) -> Numbers:
        """Note the leads of a round's reduced rows; return those that have none. All workers call it at once.

        A row leads to the next layer, or else to a row whose path ends elsewhere: at a row that is not of this round,
        or has a smaller number. So no path comes back.
        """
        origins, _, owners, places = found.whole(answers)
        kept = found.reduced[origins - found.rows.start]
        origins, owners, places = origins[kept], owners[kept], places[kept]
        numbers, leads = places >> 1, self.leads.room
        ahead = np.flatnonzero(places & 1)[::-1]  # of several steps of a row, the first one leads on
        leads[origins[ahead]] = np.where(
            numbers[ahead] < 0, 0, numbers[ahead] * self.workers + owners[ahead] + 1
        )
        rest = ~np.isin(origins, origins[ahead])
        origins, owners, numbers = origins[rest], owners[rest], numbers[rest]
        ends = np.zeros(len(origins), np.int64)
        peers = range(self.workers)
        for peer, told in enumerate(self.ends(links, [numbers[owners == each] for each in peers])):
            ends[owners == peer] = told
        rounds = links.exchange([(found.rows.start, found.rows.stop)] * self.workers)
        begins, stops = np.array(rounds, np.int64).T
        row, worker = np.divmod(ends, self.workers)
        own = origins * self.workers + self.me
        is_elsewhere = (row < begins[worker]) | (row >= stops[worker]) | (ends < own)
        chosen = np.flatnonzero(is_elsewhere)[::-1]
        leads[origins[chosen]] = ends[chosen] + 1
        return np.setdiff1d(origins, origins[chosen])

    def ends(self, links: Links, rows: Sequence[Numbers]) -> list[Numbers]:
        """Return the ends of the paths from some rows of each worker, and shorten these paths.

        Raises:
            CheckpointError: A path has no end.
        """
        asked = links.exchange(rows)
        active = np.unique(np.concatenate(asked))
        for _ in range(MOST_HOPS):
            at = active[self.leads.room[active] > 0]
            beyond, met = self._leads_of(links, self.leads.room[at] - 1)
            self.leads.room[at] = np.where(beyond > 0, beyond, self.leads.room[at])
            active = np.union1d(active, met)
            if not any(links.exchange([bool(np.any(beyond > 0))] * self.workers)):
                break
        else:
            raise CheckpointError("a path of this checkpoint has no end")
        found = [self.leads.room[each] - 1 for each in asked]
        return links.exchange(
            [
                np.where(end < 0, each * self.workers + self.me, end)
                for each, end in zip(asked, found, strict=True)
            ]
        )

    def _leads_of(self, links: Links, numbers: Numbers) -> tuple[Numbers, Numbers]:
        """Return the leads of rows by their numbers, and the own rows for which others have asked."""
        rows, owners = np.divmod(numbers, self.workers)
        asked = links.exchange([rows[owners == peer] for peer in range(self.workers)])
        found = np.zeros(len(numbers), np.int64)
        for peer, told in enumerate(links.exchange([self.leads.room[each] for each in asked])):
            found[owners == peer] = told
        return found, np.unique(np.concatenate(asked))
