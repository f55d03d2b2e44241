"""The images of clocks and windows under exchanges of members, for the loops.

A clock with a number, or a window, mentions some members. Its image under an exchange depends only on the images of
these. Images are learned when they are needed.
"""

# mypy: disable-error-code="return-value, assignment, arg-type, no-any-return"
# (numba infers the types of compiled functions; mypy takes its integers for Python's)

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from checker.engines.fast.compiled.jit_decorators import inner
from checker.engines.fast.compiled.table import Words
from checker.engines.fast.store.canonicalise import led
from checker.engines.zones.location_views import (
    ACTORS,
    ANSWER,
    CLOCK,
    RESTORING,
    RUNNING,
    LearnedClocks,
    LocationView,
)

Ints = NDArray[np.int32]


class ClockImages(NamedTuple):
    """The learned images. Subjects are numbered: first the windows, then the clocks.

    Attributes:
        windows: The number of windows.
        roots: For each subject the root of its images.
        mentions_from, mentions: For each subject the members that it mentions.
        keys, values: The edges from a node by the image of a member, as a hash table.
        images: For each node the image plus one, or 0.
    """

    windows: int
    roots: Ints
    mentions_from: Ints
    mentions: Ints
    keys: Words
    values: Ints
    images: Ints


class FormerNames(NamedTuple):
    """How a row's clocks and windows were called before its representative replaced it.

    Attributes:
        members: For each member the one that it replaced.
        clocks: For each clock of the representative the number that it had.
        windows: For each window of the row its number in the representative.
        restored: For each vehicle with an endurance its clock RESTORED in the representative.
    """

    members: Ints
    clocks: Ints
    windows: Ints
    restored: Ints


UNNAMED = -6
"""A code in NODE: the image of a clock or window is not learned yet."""


@inner(cache=True)
def image_of(x: ClockImages, subject: int, members: Ints) -> int:
    """Return the image of a subject if each member is replaced by another one; -1 if it is not learned yet."""
    node = np.int64(x.roots[subject])
    for k in range(x.mentions_from[subject], x.mentions_from[subject + 1]):
        node = led(x.keys, x.values, node, members[x.mentions[k]])
        if node == 0:
            return -1
    return np.int64(x.images[node]) - 1


@inner(cache=True)
def note_windows(x: ClockImages, place: Ints, n: FormerNames, restored: Ints) -> bool:
    """Note the windows, and the clocks RESTORED, under the names of a representative; False if one is unknown."""
    for window in range(x.windows):
        image = image_of(x, window, place)
        if image < 0:
            return False
        n.windows[window] = image
    for vehicle in range(len(restored) // RESTORING):
        image = image_of(x, x.windows + restored[RESTORING * vehicle], place)
        if image < 0:
            return False
        n.restored[vehicle] = image - x.windows
    return True


@inner(cache=True)
def note_members(place: Ints, n: FormerNames) -> None:
    """Note for each member the one that it replaced."""
    for k in range(len(place)):
        n.members[place[k]] = k


@inner(cache=True)
def note_clock(x: ClockImages, n: FormerNames, clock: int) -> bool:
    """Note the former name of a clock of the representative; False if it is unknown."""
    former = image_of(x, x.windows + clock, n.members)
    if former >= 0:
        n.clocks[clock] = former - x.windows
    return former >= 0


@inner(cache=True)
def note_names(t: LearnedClocks, x: ClockImages, n: FormerNames, place: Ints, v: LocationView) -> bool:
    """Note how the clocks and windows of a representative were called; False if an image is not learned yet."""
    note_members(place, n)
    if not note_windows(x, place, n, t.restored):
        return False
    for clock in t.lasting:
        if not note_clock(x, n, clock):
            return False
    for k in range(len(t.vehicles) + v.counts[ACTORS]):
        record = ANSWER * v.answers[k]
        for run in range(t.answers[record], t.answers[record + 1]):
            if not note_clock(x, n, t.running[RUNNING * run + CLOCK]):
                return False
    return True
