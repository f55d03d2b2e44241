"""Occurrences of subformulas in state formulas and temporal formulas; and the unneeded ones (vacuity).

A subformula is *never needed* if the formula holds for any replacement. It suffices to replace a positive occurrence by
false, a negative one by true (Kupferman and Vardi, Vacuity detection in temporal model checking, 1999). A quantifier is
elaborated into one operand for each name of its range; a remark on its body is made once, not for each instance.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Final

from semantics.behaviours.program import VariableOf
from semantics.properties.property import Ranges
from semantics.properties.propositions import Always, And, Exists, Instances, Not, Or, Proposition
from semantics.properties.temporal import Both, Denied, Either, Now, Temporal, parts
from semantics.state.agents import written

Path = tuple[int, ...]
"""The position of a part in a formula: the ranks of operands, from the outermost."""

Formula = Proposition | Temporal
Operand = tuple[Path, Formula]

MOST_REMARKS: Final = 3

STILL: Final = "vacuous: none of its atoms ever changes"


@dataclass(frozen=True, slots=True)
class Subformula:
    """A part of a formula as it was written; in the body of a quantifier it has several occurrences.

    Attributes:
        formula: The part; in the body of a quantifier its first instance.
        paths: The positions of its occurrences.
        positive: Whether it occurs below an even number of negations.
    """

    formula: Formula
    paths: tuple[Path, ...] = ((),)
    positive: bool = True

    def parts(self, ranges: Ranges) -> Iterator["Subformula"]:
        """Yield its immediate parts."""
        operands = tuple(map(_said, operands_of(self.formula, ranges)))
        positive = self.positive is not isinstance(_bare(self.formula), Not | Denied)
        if _are_instances(operands, ranges):
            everywhere = tuple((*path, *at) for path in self.paths for at, _ in operands)
            yield Subformula(operands[0][1], everywhere, positive)
            return
        for at, operand in operands:
            yield Subformula(operand, tuple((*path, *at) for path in self.paths), positive)


def operands_of(formula: Formula, ranges: Ranges) -> tuple[Operand, ...]:
    """Return the operands of a formula, each with its position; all operands of a chain of `and` or `or`."""
    match formula:
        case Now(proposition):
            return tuple(((0, *at), operand) for at, operand in operands_of(proposition, ranges))
        case Not(inner):
            return (((0,), inner),)
        case And(formulas) | Or(formulas):
            return tuple(((rank,), operand) for rank, operand in enumerate(formulas))
        case Both() | Either():
            return _chain(formula, ranges)
    whole = parts(formula) if isinstance(formula, Temporal) else ()
    return tuple(((rank,), operand) for rank, operand in enumerate(whole))


def _chain(formula: Both | Either, ranges: Ranges) -> tuple[Operand, ...]:
    """Return the operands of a chain of equal connectives: all, or just those that form a quantifier's instances.

    A quantifier is elaborated in nested pairs, so the largest are divided first.
    """
    operands: tuple[Operand, ...] = (((0,), formula.left), ((1,), formula.right))
    while not _are_instances(operands, ranges):
        inner = [_size(each) for _, each in operands if isinstance(each, type(formula))]
        if not inner:
            break
        operands = tuple(one for each in operands for one in _halves(each, type(formula), max(inner)))
    return operands


def _halves(operand: Operand, sort: type[Both | Either], size: int) -> tuple[Operand, ...]:
    """Return both operands of a connective of some size; any other operand unchanged."""
    path, formula = operand
    if isinstance(formula, sort) and _size(formula) == size:
        return ((*path, 0), formula.left), ((*path, 1), formula.right)
    return (operand,)


def _size(formula: Formula) -> int:
    return 1 + sum(map(_size, parts(formula))) if isinstance(formula, Temporal) else 1


def _are_instances(operands: tuple[Operand, ...], ranges: Ranges) -> bool:
    return is_quantified(tuple(operand for _, operand in map(_said, operands)), ranges)


def _said(operand: Operand) -> Operand:
    """Return a quantifier's body for a name, without the implied condition that the name exists."""
    path, formula = operand
    match formula:
        case Or((Not(condition), said)) | And((condition, said)):
            pass
        case Either(Denied(condition), said) | Both(condition, said):
            pass
        case _:
            return operand
    return ((*path, 1), said) if _is_implied(condition) else operand


def _is_implied(condition: Formula) -> bool:
    return isinstance(bare := _bare(condition), Exists) and bare.implied


def _unsigned(formula: Formula) -> Formula:
    return formula.formula if isinstance(formula, Not | Denied) else formula


def _bare(formula: Formula) -> Formula:
    return formula.proposition if isinstance(formula, Now) else formula


def at(formula: Formula, path: Path) -> Formula:
    """Return the part at a position of a formula."""
    for rank in path:
        formula = formula.formulas[rank] if isinstance(formula, And | Or) else _field(formula, rank)
    return formula


def _field(formula: Formula, rank: int) -> Formula:
    found: Formula = getattr(formula, fields(formula)[rank].name)
    return found


def replaced(formula: Formula, path: Path, by: Always) -> Formula:
    """Return a formula with the part at a position replaced by `true` or `false`."""
    if not path:
        return Now(by) if isinstance(formula, Temporal) else by
    rank, rest = path[0], path[1:]
    if isinstance(formula, And | Or):
        operands: list[Any] = list(formula.formulas)
        operands[rank] = replaced(operands[rank], rest, by)
        return type(formula)(tuple(operands))
    whole: Any = formula
    inner = replaced(_field(formula, rank), rest, by)
    changed: Formula = replace(whole, **{fields(whole)[rank].name: inner})
    return changed


def strengthened(formula: Formula, part: Subformula) -> Formula:
    """Return a formula with all occurrences of a part replaced by the strongest constant."""
    for path in part.paths:
        formula = replaced(formula, path, Always(not part.positive))
    return formula


def few(remarks: Sequence[str]) -> tuple[str, ...]:
    """Return the first remarks on parts, and the number of the others."""
    rest = len(remarks) - MOST_REMARKS
    are = "is" if rest == 1 else "are"
    more = (f"{rest:,} more of its parts {are} never needed",) if rest > 0 else ()
    return (*remarks[:MOST_REMARKS], *more)


def never_needed(around: Subformula, part: Subformula) -> str:
    """Return the remark that a part is never needed."""
    shown = part.formula
    if isinstance(shown, Not | Denied) and isinstance(_bare(around.formula), Or | Either):
        shown = shown.formula  # the condition of an implication
    many = len(part.paths) > 1
    return f"'{shown}' and its like are never needed" if many else f"'{shown}' is never needed"


def unneeded(
    formula: Formula, ranges: Ranges, holds: Callable[[Formula], bool]
) -> Iterator[tuple[Subformula, Subformula]]:
    """Yield the outermost unneeded parts of a true formula, each with the part around it.

    Args:
        formula: The formula.
        ranges: The ranges of its quantifiers, to recognise the instances of a body.
        holds: Returns whether a formula with a replaced part holds.
    """
    yield from _unneeded(formula, Subformula(formula), ranges, holds)


def _unneeded(
    formula: Formula, around: Subformula, ranges: Ranges, holds: Callable[[Formula], bool]
) -> Iterator[tuple[Subformula, Subformula]]:
    found = tuple(around.parts(ranges))
    alone = len(found) == 1 and len(found[0].paths) == len(around.paths)
    for part in found:
        if isinstance(_bare(part.formula), Always) or _is_implied(_unsigned(part.formula)):
            continue
        # A single operand is needed if the part around it is.
        if not alone and holds(strengthened(formula, part)):
            yield around, part
        else:
            yield from _unneeded(formula, part, ranges, holds)


def is_quantified(operands: Sequence[Any], ranges: Ranges) -> bool:
    """Return whether the operands of a connective differ in a single name, which ranges over one of some ranges."""
    if len(operands) < 2:
        return False
    names = _varying([list(_words(part)) for part in operands])
    return names is not None and tuple(sorted(map(str, names))) in ranges


def _varying(operands: list[list[Any]]) -> list[Any] | None:
    """Return the word in which each operand differs from the others, None if they differ in more."""
    first = operands[0]
    if any(len(words) != len(first) for words in operands):
        return None
    places = [at for at in range(len(first)) if len({repr(words[at]) for words in operands}) > 1]
    found = [{repr(words[at]): words[at] for at in places} for words in operands]
    if not all(len(each) == 1 for each in found):
        return None
    return [next(iter(each.values())) for each in found]


def _words(formula: Any) -> Iterator[Any]:
    """Yield the words of a formula from left to right; `true` and `false` alike.

    Comparisons of names have become either.
    """
    if isinstance(formula, Always):
        yield "always"
    elif isinstance(formula, VariableOf):  # each member of a family has its own variables
        yield formula.agent
        yield written(formula.variables[0])
    elif isinstance(formula, Instances):
        yield formula.range.names
        yield from _words(formula.body)
    elif isinstance(formula, tuple):
        yield len(formula)
        for each in formula:
            yield from _words(each)
    elif hasattr(formula, "__dataclass_fields__"):
        yield type(formula)
        for each in fields(formula):
            yield from _words(getattr(formula, each.name))
    else:
        yield formula
