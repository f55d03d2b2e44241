"""Control points: the code that a bigActor may have left to run, according to the nesting of its text."""

from collections.abc import Iterable, Iterator
from itertools import chain

from semantics.analysis.traversal import blocks
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Block, ForEach, Loop, Statement, While
from semantics.fixpoints import closure

Point = tuple[Block, int]
"""A block, and the number of its statements that have been taken or entered."""

STAYING = (Loop, While, ForEach)
"""Statements that stay next in the code while their body runs."""


def is_point(program: Program, starts: Iterable[Block], code: tuple[int, ...]) -> bool:
    """Whether a run that starts with one of these blocks can have this code left to run.

    The code is read backwards: first the rest of the outermost block, then that of the block entered in it, and so on.
    """
    if code and isinstance(_statement(program, code[0]), Loop | None):
        return False  # the jump of a loop belongs to the step before it
    points = _entered(program, {(block, len(block)) for block in starts})
    for number in reversed(code):
        before = {(block, at - 1) for block, at in points if at and block[at - 1] == number}
        points = _entered(program, before)
    return bool(points)


def _statement(program: Program, number: int) -> Statement | None:
    return program.statements[number] if 0 <= number < len(program.statements) else None


def _entered(program: Program, points: set[Point]) -> frozenset[Point]:
    """Return the points, and the ends of all blocks that may have been entered from them."""
    return closure(points, lambda point: ((block, len(block)) for block in _entered_from(program, *point)))


def _entered_from(program: Program, block: Block, at: int) -> Iterator[Block]:
    """Yield the blocks whose code may precede the rest of a block."""
    taken = program.statements[block[at - 1]] if at else None
    if taken is not None and not isinstance(taken, STAYING):
        yield from blocks(program, taken)
    staying = program.statements[block[at]] if at < len(block) else None
    if isinstance(staying, STAYING):
        yield staying.body


def once(program: Program, starts: Iterable[Block]) -> frozenset[int]:
    """Return the statements that no run takes twice: outside every loop, and in no behaviour with two calls."""
    again: set[int] = set()
    seen: set[int] = set()
    waiting = [number for block in starts for number in block]
    while waiting:
        number = waiting.pop()
        statement = program.statements[number]
        if number in seen:
            if number not in again:
                again.add(number)
                waiting.extend(chain.from_iterable(blocks(program, statement)))
            continue
        seen.add(number)
        inside = tuple(chain.from_iterable(blocks(program, statement)))
        waiting.extend(inside * 2 if isinstance(statement, STAYING) else inside)
    return frozenset(seen - again)
