"""Compare two traces: the point of divergence, the steps still shared after it, and the differences of their ends."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from typing import Final

from checker.steps import Step
from checker.traces import Trace, print_step
from physical.wordings import counted
from semantics.state.differences import Difference, differences

MOST_ALIGNED: Final = 1_000
"""The most steps of each trace that are aligned after the divergence; the cost is quadratic."""


@dataclass(frozen=True, slots=True)
class AlignedSteps:
    """Aligned steps, by their numbers from 1; None where only the other trace has one."""

    one: int | None
    other: int | None


@dataclass(frozen=True, slots=True)
class Comparison:
    """The differences of two traces.

    Attributes:
        shared: The number of common steps from the start.
        pairs: The steps after those, aligned by their labels; at most `MOST_ALIGNED` of each trace.
        beyond: The number of further steps of each trace.
        ends: The differences between the last configurations; None if the missions have different entities.
    """

    shared: int
    pairs: tuple[AlignedSteps, ...]
    beyond: tuple[int, int]
    ends: tuple[Difference, ...] | None


def compare(one: Trace, other: Trace) -> Comparison:
    """Return the differences of two traces."""
    ways = [_ways(trace.steps) for trace in (one, other)]
    both = min(map(len, ways))
    shared = next((n for n in range(both) if ways[0][n] != ways[1][n]), both)
    kinds = [trace.initial.setting.kinds for trace in (one, other)]
    ends = (one.configurations[-1], other.configurations[-1])
    differ = differences(*ends) if dict(kinds[0]) == dict(kinds[1]) else None
    rests = [each[shared : shared + MOST_ALIGNED] for each in ways]
    left, right = (max(0, len(each) - shared - MOST_ALIGNED) for each in ways)
    return Comparison(shared, tuple(_aligned(rests[0], rests[1], shared)), (left, right), differ)


def _ways(steps: Sequence[Step]) -> list[tuple[str, int]]:
    return [(str(step.label), step.choice) for step in steps]


def _aligned(one: list[tuple[str, int]], other: list[tuple[str, int]], after: int) -> Iterator[AlignedSteps]:
    matcher = SequenceMatcher(
        None, [label for label, _ in one], [label for label, _ in other], autojunk=False
    )
    for what, start, end, first, last in matcher.get_opcodes():
        if what == "equal":
            ranks = zip(range(start, end), range(first, last), strict=True)
            yield from (AlignedSteps(after + a + 1, after + b + 1) for a, b in ranks)
            continue
        yield from (AlignedSteps(after + a + 1, None) for a in range(start, end))
        yield from (AlignedSteps(None, after + b + 1) for b in range(first, last))


def comparison_text(one: Trace, other: Trace, names: tuple[str, str]) -> Iterator[str]:
    """Yield the differences of two traces, line by line; `<` marks steps of the first only, `>` of the other only."""
    found = compare(one, other)
    steps = counted(found.shared, "step")
    yield f"< {names[0]}: {counted(len(one), 'step')}"
    yield f"> {names[1]}: {counted(len(other), 'step')}"
    if not found.pairs:
        yield f"they are the same: {steps}"
        return
    yield f"the same for {steps}, up to c{found.shared}; then"
    for pair in found.pairs:
        yield _pair(pair, one, other)
    if any(found.beyond):
        steps = counted(found.beyond[0], "step")
        yield f"  and {steps} more of the first, {found.beyond[1]:,} of the second, not compared"
    yield from _ends(found)


def _pair(pair: AlignedSteps, one: Trace, other: Trace) -> str:
    sign = "=" if pair.one and pair.other else "<" if pair.one else ">"
    number, trace = (pair.one, one) if pair.one else (pair.other, other)
    assert number is not None
    beside = f" (c{pair.other} there)" if pair.one and pair.other and pair.one != pair.other else ""
    return f"  {sign} {print_step(trace, number)}{beside}"


def _ends(found: Comparison) -> Iterator[str]:
    if found.ends is None:
        yield "their ends are not compared: the missions have different entities"
    elif not found.ends:
        yield "they end in the same configuration"
    else:
        yield "the end of the second differs from the end of the first:"
        yield from (f"  {each}" for each in found.ends)
