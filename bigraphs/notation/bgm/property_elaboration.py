"""Elaboration of BigMC's properties to formulas."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from typing import Final

from bigraphs.bigraph import Bigraph
from bigraphs.notation.bgm.syntax import Ask, Count, Operation, Query, Scoped, Wide
from bigraphs.notation.bgm.terms import Terms, holes
from bigraphs.notation.big.solidity import pattern_of
from bigraphs.notation.lalr import Span
from bigraphs.properties import (
    Both,
    Compare,
    Either,
    Equal,
    Formula,
    IfElse,
    Matches,
    Not,
    Size,
    StateScope,
    TerminalState,
)
from bigraphs.properties import Scoped as Within

_COMPARISONS: Final = frozenset({"==", "!=", "<", "<=", ">", ">="})


def formula(query: Query, terms: Terms, declared: frozenset[str]) -> Formula | None:
    """Return the formula of a query, or None after a recorded mistake; names in `declared` match only themselves."""
    reader = _Queries(terms, declared)
    return reader.formula(query)


class _Queries:
    """The elaboration of queries over the terms of one file."""

    def __init__(self, terms: Terms, declared: frozenset[str]) -> None:
        self.terms = terms
        self.declared = declared

    def wrong(self, message: str, query: Query, hint: str = "") -> None:
        self.terms.findings.add("property", message, Span(query.offset, query.offset + 1), hint)

    def formula(self, query: Query) -> Formula | None:
        match query:
            case Operation(symbol, operands) if symbol in _COMPARISONS:
                return self.comparison(symbol, operands)
            case Operation(symbol, operands):
                known = [self.formula(operand) for operand in operands]
                found = [each for each in known if each is not None]
                return _joined(symbol, found) if len(found) == len(known) else None
            case Ask(scope=None):
                return self.asked(query)
            case Ask(predicate, term, scope):
                return self.scoped(str(scope), Ask(predicate, term, None, query.offset))
            case Scoped(scope, operand):
                return self.scoped(scope, operand)
            case Count():
                self.wrong("a number is neither true nor false", query, "compare it: size() < 5")
                return None

    def comparison(self, symbol: str, operands: Sequence[Query]) -> Formula | None:
        left, right = (self.number(operand) for operand in operands)
        return None if left is None or right is None else Compare(symbol, left, right)

    def number(self, query: Query) -> Size | int | None:
        match query:
            case Count(value):
                return value
            case Ask("size", None, scope):
                return Size(StateScope(scope or "this"))
            case _:
                self.wrong("only numbers and size() can be compared", query)
                return None

    def scoped(self, scope: str, operand: Query) -> Formula | None:
        found = self.formula(operand)
        if found is None:
            return None
        if scope in ("pred", "succ") and _looks_further(operand):
            self.wrong(f"${scope} takes only patterns and sizes", operand)
            return None
        return Within(StateScope(scope), found)

    def asked(self, ask: Ask) -> Formula | None:
        wants = ask.predicate in ("matches", "equal")
        if wants != (ask.term is not None):
            self.wrong(f"'{ask.predicate}' takes {'a term' if wants else 'nothing'}", ask)
            return None
        match ask.predicate:
            case "terminal":
                return TerminalState()
            case "empty":
                return Compare("==", Size(), 0)
            case "size":
                self.wrong("a size is neither true nor false", ask, "compare it: size() < 5")
                return None
            case _:
                return self.of_term(ask, ask.term or ())

    def of_term(self, ask: Ask, term: Wide) -> Formula | None:
        if ask.predicate == "equal":
            if holes(term):
                self.wrong("a state has no holes", ask)
                return None
            state = self.terms.bigraph(term, {}, self.declared)
            return None if state is None else Equal(state)
        sites = {hole.index: site for site, (_, hole) in enumerate(holes(term))}
        found = self.terms.bigraph(term, sites, ())
        return None if found is None else self.matches(ask, found)

    def matches(self, ask: Ask, found: Bigraph) -> Formula | None:
        pattern = pattern_of(found)
        if not pattern.nodes:
            self.wrong("this has no node, so it would always match", ask)
            return None
        return Matches(pattern, self.declared & set(pattern.outer_names))


def _joined(symbol: str, operands: Sequence[Formula]) -> Formula:
    match symbol:
        case "!":
            return Not(operands[0])
        case "if":
            return IfElse(*operands)
        case "&&":
            return reduce(Both, operands)
        case _:
            return reduce(Either, operands)


def _looks_further(query: Query) -> bool:
    match query:
        case Ask(predicate, _, scope):
            return predicate == "terminal" or scope not in (None, "this")
        case Operation(_, operands):
            return any(map(_looks_further, operands))
        case Scoped():
            return True
        case Count():
            return False
