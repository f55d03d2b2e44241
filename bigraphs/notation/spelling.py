"""Suggestions for misspelt words, only if so few letters differ that the suggestion is probably right.

A merely similar word (`Lake` and `Tanker`) would mislead. Then `did_you_mean` returns nothing, and the caller lists the
known words or explains the declaration.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

_LONGEST: Final = 60
_MOST_COMPARED: Final = 2_000
_MOST_LISTED: Final = 8
_DIGITS: Final = re.compile(r"[0-9]+")


def did_you_mean(word: str, among: Iterable[str]) -> str:
    """Return `did you mean '...'?`, or an empty string.

    >>> did_you_mean("chekc", ["check", "show"]), did_you_mean("Lake", ["Tanker"])
    ("did you mean 'check'?", '')
    """
    near = nearest(word, among)
    return f"did you mean '{near[0]}'?" if near else ""


def nearest(word: str, among: Iterable[str]) -> tuple[str, ...]:
    """Return the probable corrections of a word, the nearest first.

    One letter in three may be missing, added, changed or swapped with its neighbour, or all letters may be permuted.
    Case is ignored. Numbers must be equal: `uav1` is no correction of `uav7`.

    >>> nearest("serchArea0", ["searchArea0", "searchArea1"]), nearest("uav7", ["uav1"]), nearest("see", ["sea"])
    (('searchArea0',), (), ('sea',))
    """
    if len(word) > _LONGEST:
        return ()
    found = []
    for other in sorted(set(among))[:_MOST_COMPARED]:
        away = _distance(word.lower(), other.lower(), len(word) // 3)
        if away is not None and not (other != word and _differ_in_number(word, other)):
            found.append((away, other))
    return tuple(other for _, other in sorted(found))


def listed(names: Iterable[str], many: str) -> str:
    """Return a list of the known names, cut after the first eight.

    >>> listed(["vhf", "r"], "channels"), listed(["vhf"], "channels"), listed([], "channels")
    ('the channels are r and vhf', 'the only channel is vhf', 'there are no channels')
    """
    known = sorted(set(names))
    if not known:
        return f"there are no {many}"
    if len(known) == 1:
        return f"the only {_one(many)} is {known[0]}"
    if len(known) > _MOST_LISTED:
        return f"the {many} are {', '.join(known[:_MOST_LISTED])} and {len(known) - _MOST_LISTED:,} more"
    return f"the {many} are {', '.join(known[:-1])} and {known[-1]}"


def _one(many: str) -> str:
    return f"{many[:-3]}y" if many.endswith("ies") else many.removesuffix("s")


def _differ_in_number(word: str, other: str) -> bool:
    here, there = ([int(digits) for digits in _DIGITS.findall(each)] for each in (word, other))
    return bool(here and there and here != there)


def _distance(word: str, other: str, most: int) -> int | None:
    """Return the number of edits (Damerau and Levenshtein, one per position), or None above `most`."""
    if sorted(word) == sorted(other):
        return int(word != other)
    if abs(len(word) - len(other)) > most:
        return None
    before, last = [0] * (len(other) + 1), list(range(len(other) + 1))
    for row, letter in enumerate(word, 1):
        new = [row]
        for column, its in enumerate(other, 1):
            cost = min(last[column] + 1, new[-1] + 1, last[column - 1] + (letter != its))
            if row > 1 and column > 1 and letter == other[column - 2] and word[row - 2] == its:
                cost = min(cost, before[column - 2] + 1)
            new.append(cost)
        before, last = last, new
        if min(last) > most:
            return None
    return last[-1] if last[-1] <= most else None
