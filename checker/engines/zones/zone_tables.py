"""The tables of the loops over zones: the automaton, the zones that are kept, and those that steps enter.

Zones are expanded layer by layer: a layer holds the zones that a number of steps reaches and fewer don't. Within a
layer, the zones of one row are expanded together, step by step, and rows in the order of discovery. A zone included in
another one of its location is dropped. A zone that includes others replaces them in later inclusion tests; those of its
own layer are dropped.

The search for the first run to a goal (`checker.engines.timed.first_runs`) proceeds by groups instead, depth first. A
group is the set of zones that one sequence of steps reaches. A zone is dropped if another one that as many steps or
fewer reached includes it; it drops no kept zone.

There is one clock for all processes, or a date for each. A *dated* zone bounds the differences between these dates and
the starts of clocks. Its index i below the number of processes stands for a process, the following ones for clocks. A
step makes the dates of its participants equal; then each of them waits by itself. The *ages* of a zone are its clocks
where all dates are equal: they are compared and kept. With one clock both matrices are the same.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.zones.difference_bounds import FREE as MISSING
from checker.engines.zones.difference_bounds import Matrix

Ints = NDArray[np.int32]
State = NDArray[np.int64]


class CompiledAutomaton(NamedTuple):
    """A timed automaton for the loops; see `Automaton`.

    Attributes:
        left: For each location the least number of steps to the goal, 0 where it is unknown.
        takes_from, takes: For each footprint the range of its participants, and those.
        processes: The number of processes with a date; 1 for one clock.
    """

    locations: Ints
    edges: Ints
    tests: Ints
    sources: Ints
    deadlines: Ints
    clocks: Ints
    lower: Ints
    upper: Ints
    rows: Ints
    left: Ints
    takes_from: Ints
    takes: Ints
    processes: int


class Zones(NamedTuple):
    """The reached zones.

    Attributes:
        bounds: The matrices of ages, one after the other.
        begins: The start of each zone's matrix.
        dated, dated_from: With several processes, the dated matrices of the last two layers, and their starts.
        sums: The sum of its bounds; an including zone has at least the same sum.
        places: Its location.
        depths: In a search for a run, the number of steps that reached it; else 0.
        following: The next zone of its location in the list for inclusion tests; `COVERED` for a zone included in
            another one of its layer.
        heads: For each location the first zone of that list.
        ranks: For each row its rank in the order of discovery; -1 before it.
        order: The rows in the order of discovery, each with the rank of its predecessor.
        groups: In a search for a run, three numbers for each group: its predecessor, its step, and its first zone. The
            first zone of the next group ends it.
    """

    bounds: Ints
    begins: State
    dated: Ints
    dated_from: State
    sums: State
    places: Ints
    depths: Ints
    following: Ints
    heads: Ints
    ranks: Ints
    order: Ints
    groups: Ints


COVERED = -2

GROUP, RANK = 3, 2
BEFORE, BY, BEGIN = range(GROUP)

AT, LAYER, DEPTH, COUNT, USED, FOUND, MISSED, GROUPS, RANKED, LONGEST, DATED, FAR, STATE = range(13)
"""Indices of the state of a search.

`AT` is the next zone, or group, to expand; -1 after the last group. `LAYER` is the first zone of the layer under
construction. `DEPTH` is the number of steps to it, or to the successors of the group. `COUNT`, `USED`, `GROUPS` and
`RANKED` count zones, bounds, groups and discovered rows. `FOUND` is the depth of the goal, -1 before. `MISSED` is the
number of zones without room, and `LONGEST` the most steps. `DATED` counts the bounds of dated matrices; `FAR` is 1 once
dates are too far apart to be counted.
"""

FARTHEST = MISSING >> 1
"""The largest finite bound of a dated matrix."""

MOST_LATE = 4
"""The most participants of a step that may be past a deadline after it; with more, dates are given up (`FAR`)."""

DONE, MISS, FULL = range(3)
"""Why the loops return; at a MISS the edges of the next location are unknown."""


class ZoneBatch(NamedTuple):
    """The zones that the steps of some zones enter, in order, before they are kept.

    Attributes:
        records: `RECORD` numbers for each entered zone, and for each of the other events in `TAKEN` to `DROPPED`.
        ages, dated: The matrices of the entered zones; dated ones with several processes only.
        state: Where the batch stands; see `NEXT`.
        d, e, f, bounds, late: Scratch space for one step.
    """

    records: Ints
    ages: Ints
    dated: Ints
    state: State
    d: Matrix
    e: Matrix
    f: Matrix
    bounds: Matrix
    late: Ints


RECORD = 4
WHAT, ABOUT, AGES, DATES = range(RECORD)
"""The fields of a record: the location of an entered zone, or an event; what the event is about; and the numbers of
bounds before it in `ages` and `dated`."""

TAKEN, ROW, TOO_FAR, DROPPED = -1, -2, -3, -4
"""The events: an edge can be taken; a row is expanded, up to a zone; dates are too far apart; a zone that was entered
is included in a kept one."""

NEXT, GATHERED, STORED, AGED, DATED_TO, WANTED, BATCH_STATE = range(7)
"""Indices of the state of a batch: the next zone to expand; the numbers of records, and of stored ones; the numbers of
bounds in `ages` and `dated`; the zones for which it had no room."""


def new_batch(zones: int, largest: int, processes: int) -> ZoneBatch:
    """Return an empty batch with room for so many zones, of matrices with at most `largest` rows."""
    bounds = zones * largest * largest
    dated = bounds if processes > 1 else 1
    records = RECORD * (EVENTS * zones + 1)
    shape = (largest, largest)
    return ZoneBatch(
        np.empty(records, np.int32),
        np.empty(bounds, np.int32),
        np.empty(dated, np.int32),
        np.zeros(BATCH_STATE, np.int64),
        *(np.zeros(each, np.int32) for each in (shape, shape, shape, (2, largest), processes)),
    )


EVENTS = 3
"""The most records for each zone that the steps of a row may enter, but for the record of the row."""
