"""Covering arrays: few rows of choices in which every two choices meet."""

import random
from itertools import combinations

Row = dict[str, str]


def covering_array(factors: dict[str, tuple[str, ...]], seed: int) -> list[Row]:
    """Return rows in which every pair of choices of every two factors is in some row (greedy, as AETG does)."""
    draw = random.Random(seed)
    left = {
        frozenset({(one, a), (other, b)})
        for one, other in combinations(factors, 2)
        for a in factors[one]
        for b in factors[other]
    }
    rows = []
    while left:
        candidates = [_row(factors, left, draw) for _ in range(20)]
        best = max(candidates, key=lambda row: len(left & pairs_of(row)))
        rows.append(best)
        left -= pairs_of(best)
    return rows


def pairs_of(row: Row) -> set[frozenset[tuple[str, str]]]:
    """Return the pairs of choices that meet in a row."""
    return {frozenset(pair) for pair in combinations(row.items(), 2)}


def spread(rows: list[Row], most: int) -> list[Row]:
    """Return so many of some rows, each with as many pairs as possible that are in none before it."""
    chosen: list[Row] = []
    met: set[frozenset[tuple[str, str]]] = set()
    for _ in range(most):
        chosen.append(max(rows, key=lambda row: len(pairs_of(row) - met)))
        met |= pairs_of(chosen[-1])
    return chosen


def _row(
    factors: dict[str, tuple[str, ...]], left: set[frozenset[tuple[str, str]]], draw: random.Random
) -> Row:
    row: Row = dict(draw.choice(sorted(map(sorted, left))))
    others = [factor for factor in factors if factor not in row]
    draw.shuffle(others)
    for factor in others:
        choices = draw.sample(factors[factor], len(factors[factor]))
        row[factor] = max(choices, key=lambda choice: _gain(row, factor, choice, left))
    return row


def _gain(row: Row, factor: str, choice: str, left: set[frozenset[tuple[str, str]]]) -> int:
    return sum(frozenset({(factor, choice), other}) in left for other in row.items())
