"""Crowds on a map: markers that would hide each other are folded into one, or fanned out."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from typing import Final

from physical.map_labels import Spot

FEWEST: Final = 4
"""The smallest group of similar markers that is folded."""

HIDING: Final = 7.0
"""Points between two markers that hide each other."""

ROOM: Final = 14.0
"""Points between the centres of fanned-out markers."""


def folded(
    spots: Mapping[str, Spot], alike: Mapping[str, Hashable], reach: float
) -> tuple[dict[str, Spot], dict[str, tuple[str, ...]]]:
    """Return the remaining spots, and the folded names by the name that represents them.

    Names are folded if they are alike and within reach.

    >>> folded({name: (0.0, 1.0) for name in "abcdef"}, {name: "UAV" for name in "abcde"}, 5.0)
    ({'f': (0.0, 1.0), 'a': (0.0, 1.0)}, {'a': ('a', 'b', 'c', 'd', 'e')})
    """
    groups = [
        names
        for kind in dict.fromkeys(alike.values())
        for names in _groups({name: spots[name] for name in spots if alike.get(name) == kind}, reach)
        if len(names) >= FEWEST
    ]
    gone = {name for names in groups for name in names}
    left = {name: spot for name, spot in spots.items() if name not in gone}
    ordered = (sorted(names, key=lambda name: (len(name), name)) for names in groups)
    members = {names[0]: tuple(names) for names in ordered}
    return left | {name: _mean([spots[each] for each in names]) for name, names in members.items()}, members


def fanned(spots: Mapping[str, Spot]) -> dict[str, Spot]:
    """Return the spots; those that hide each other form a ring around their middle."""
    found = dict(spots)
    for names in _groups(spots, HIDING):
        if len(names) > 1:
            (x, y), turn = _mean([spots[name] for name in names]), 2 * math.pi / len(names)
            radius = ROOM / 2 / math.sin(math.pi / len(names))
            for rank, name in enumerate(names):
                # Two go left and right in order; of three or more, the first is on top.
                angle = math.pi / (1 if len(names) == 2 else 2) - turn * rank
                found[name] = (x + radius * math.cos(angle), y + radius * math.sin(angle))
    return found


def _groups(spots: Mapping[str, Spot], reach: float) -> list[list[str]]:
    """Return groups of names, each within reach of the first of its group."""
    groups: list[list[str]] = []
    for name, spot in spots.items():
        near = (group for group in groups if math.dist(spots[group[0]], spot) <= reach)
        group = next(near, None)
        if group is None:
            groups.append([name])
        else:
            group.append(name)
    return groups


def _mean(spots: Sequence[Spot]) -> Spot:
    xs, ys = zip(*spots, strict=True)
    return (sum(xs) / len(xs), sum(ys) / len(ys))
