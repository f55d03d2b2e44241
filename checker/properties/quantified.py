"""Formulas as they were written: quantifiers are elaborated into one operand for each entity of a kind.

What is said of a formula's parts is said of the body of a quantifier once, and not of each of its instances.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

from semantics.properties.propositions import Always
from semantics.state.signature import Name

Path = tuple[int, ...]
"""Where a part stands in a formula: which operand of which operand."""


def is_quantified(operands: Sequence[Any], kinds: Mapping[Name, str]) -> bool:
    """Tell whether operands of a connective differ in one name only, which goes through all entities of a kind."""
    if len(operands) < 2:
        return False
    names = _varying([list(_words(part)) for part in operands])
    if names is None or not isinstance(names[0], str) or names[0] not in kinds:
        return False
    return set(names) == {name for name, kind in kinds.items() if kind == kinds[names[0]]}


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
