"""Occurrences of subformulas, in formulas of configurations and of runs; and those that are never needed.

A part is *never needed* if the formula holds whatever stands in its place: if it still holds with false there where it
stands positively, with true where negatively (Kupferman and Vardi, Vacuity detection in temporal model checking, 1999).
A quantifier is elaborated into one operand for each name of its range; what is said of its body is said once, and not
of each instance.
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
"""Where a part stands in a formula: which operand of which operand."""

Formula = Proposition | Temporal
Operand = tuple[Path, Formula]

MOST_REMARKS: Final = 3

STILL: Final = "vacuous: nothing that it speaks of ever changes"


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a formula as it was written: in the body of a quantifier it stands in many places.

    Attributes:
        formula: What it is; in the body of a quantifier its first instance.
        paths: Where it stands.
        positive: Whether it stands below an even number of negations.
    """

    formula: Formula
    paths: tuple[Path, ...] = ((),)
    positive: bool = True

    def parts(self, ranges: Ranges) -> Iterator["Part"]:
        """Yield the parts that it has itself."""
        operands = tuple(map(_said, operands_of(self.formula, ranges)))
        positive = self.positive is not isinstance(_bare(self.formula), Not | Denied)
        if _are_instances(operands, ranges):
            everywhere = tuple((*path, *at) for path in self.paths for at, _ in operands)
            yield Part(operands[0][1], everywhere, positive)
            return
        for at, operand in operands:
            yield Part(operand, tuple((*path, *at) for path in self.paths), positive)


def operands_of(formula: Formula, ranges: Ranges) -> tuple[Operand, ...]:
    """Return what a formula is made of, each with where it stands in it; of a chain of `and` or `or` all operands."""
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
    """Return the operands of a connective and of those like it within: all, or as many as make it a quantifier's.

    A quantifier is elaborated in pairs of pairs, so the largest are taken apart first.
    """
    operands: tuple[Operand, ...] = (((0,), formula.left), ((1,), formula.right))
    while not _are_instances(operands, ranges):
        inner = [_size(each) for _, each in operands if isinstance(each, type(formula))]
        if not inner:
            break
        operands = tuple(one for each in operands for one in _halves(each, type(formula), max(inner)))
    return operands


def _halves(operand: Operand, sort: type[Both | Either], size: int) -> tuple[Operand, ...]:
    """Return both operands of a connective that has some size, and of another operand only itself."""
    path, formula = operand
    if isinstance(formula, sort) and _size(formula) == size:
        return ((*path, 0), formula.left), ((*path, 1), formula.right)
    return (operand,)


def _size(formula: Formula) -> int:
    return 1 + sum(map(_size, parts(formula))) if isinstance(formula, Temporal) else 1


def _are_instances(operands: tuple[Operand, ...], ranges: Ranges) -> bool:
    return is_quantified(tuple(operand for _, operand in map(_said, operands)), ranges)


def _said(operand: Operand) -> Operand:
    """Return what a quantifier says of a name, without what it implies: that it is there."""
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
    """Return the part that stands somewhere in a formula."""
    for rank in path:
        formula = formula.formulas[rank] if isinstance(formula, And | Or) else _field(formula, rank)
    return formula


def _field(formula: Formula, rank: int) -> Formula:
    found: Formula = getattr(formula, fields(formula)[rank].name)
    return found


def replaced(formula: Formula, path: Path, by: Always) -> Formula:
    """Return a formula with `true` or `false` in the place of a part."""
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


def strengthened(formula: Formula, part: Part) -> Formula:
    """Return a formula with the worst that may stand there in all places of a part."""
    for path in part.paths:
        formula = replaced(formula, path, Always(not part.positive))
    return formula


def few(remarks: Sequence[str]) -> tuple[str, ...]:
    """Return the first remarks on parts, and how many more there are."""
    rest = len(remarks) - MOST_REMARKS
    more = (f"{rest:,} more of its parts are never needed",) if rest > 0 else ()
    return (*remarks[:MOST_REMARKS], *more)


def never_needed(around: Part, part: Part) -> str:
    """Say that a part is never needed."""
    shown = part.formula
    if isinstance(shown, Not | Denied) and isinstance(_bare(around.formula), Or | Either):
        shown = shown.formula  # the condition of an implication
    many = len(part.paths) > 1
    return f"'{shown}' and its like are never needed" if many else f"'{shown}' is never needed"


def unneeded(
    formula: Formula, ranges: Ranges, holds: Callable[[Formula], bool]
) -> Iterator[tuple[Part, Part]]:
    """Yield the outermost parts that are never needed of a formula that holds, each with the one around it.

    Args:
        formula: The formula.
        ranges: What its quantifiers go through, to know the instances of a body.
        holds: Tells of a formula with something replaced whether it holds.
    """
    yield from _unneeded(formula, Part(formula), ranges, holds)


def _unneeded(
    formula: Formula, around: Part, ranges: Ranges, holds: Callable[[Formula], bool]
) -> Iterator[tuple[Part, Part]]:
    found = tuple(around.parts(ranges))
    alone = len(found) == 1 and len(found[0].paths) == len(around.paths)
    for part in found:
        if isinstance(_bare(part.formula), Always) or _is_implied(_unsigned(part.formula)):
            continue
        # What stands alone is needed as what is around it is.
        if not alone and holds(strengthened(formula, part)):
            yield around, part
        else:
            yield from _unneeded(formula, part, ranges, holds)


def is_quantified(operands: Sequence[Any], ranges: Ranges) -> bool:
    """Tell whether operands of a connective differ in one name only, which goes through one of some ranges."""
    if len(operands) < 2:
        return False
    names = _varying([list(_words(part)) for part in operands])
    return names is not None and tuple(sorted(map(str, names))) in ranges


def _varying(operands: list[list[Any]]) -> list[Any] | None:
    """Return the word of each operand that the others have another for, None where they differ in more."""
    first = operands[0]
    if any(len(words) != len(first) for words in operands):
        return None
    places = [at for at in range(len(first)) if len({repr(words[at]) for words in operands}) > 1]
    found = [{repr(words[at]): words[at] for at in places} for words in operands]
    if not all(len(each) == 1 for each in found):
        return None
    return [next(iter(each.values())) for each in found]


def _words(formula: Any) -> Iterator[Any]:
    """Yield what a formula is made of, from left to right; `true` and `false` alike, as comparing names gives them."""
    if isinstance(formula, Always):
        yield "always"
    elif isinstance(formula, VariableOf):  # each member of a family has variables of its own
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
