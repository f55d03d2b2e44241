"""From a linear formula to a generalized Büchi automaton, by tableau.

A state is a set of obligations. Its formulas unfold into transitions, each with literals that the present must fulfil,
the remaining obligations, and the untils whose promise it postpones. A run is accepted if no until is postponed for
ever. Acceptance is on transitions (Couvreur, FM 1999), which needs fewer states than the same tableau with acceptance
on states (Gerth, Peled, Vardi and Wolper, PSTV 1995).
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

import networkx as nx

from checker.limits import look
from checker.properties.temporal.negation_normal_form import FALSE, TRUE, FormulaFactory, Literal, Number
from semantics.properties.temporal import Temporal

MOST_STATES = 128
MOST_TERMS = 512
MOST_UNTILS = 60
"""The limits of an automaton: untils are bits of a 64-bit word, the others bound time and memory."""


class AutomatonTooLargeError(Exception):
    """A formula whose automaton would be too large."""


@dataclass(frozen=True, slots=True)
class Move:
    """One transition: the literals to fulfil now, the next state, and the promises that it doesn't postpone."""

    literals: tuple[Number, ...]
    target: int
    marks: int


@dataclass(frozen=True, slots=True)
class BuchiAutomaton:
    """A generalized Büchi automaton.

    Attributes:
        moves: The transitions of each state; the first state is the initial one.
        literals: The literals of the moves by their numbers.
        marks: The number of promises. A run is accepted if its transitions have each mark infinitely often.
        whatever: The state from which every run is accepted, if there is one.
    """

    moves: tuple[tuple[Move, ...], ...]
    literals: Mapping[Number, Literal]
    marks: int
    whatever: int | None


def automaton_of(formula: Temporal, claimed: bool = True) -> BuchiAutomaton:
    """Return an automaton that accepts the runs of which a formula, or its negation, is true.

    Raises:
        AutomatonTooLargeError: It would have too many states.
    """
    formulas = FormulaFactory()
    return _Tableau(formulas, formulas.normal(formula, claimed)).automaton()


# --- the tableau ----------------------------------------------------------------------------------------------

State = tuple[Number, ...]
"""Obligations: numbers of formulas, sorted."""


@dataclass(frozen=True, slots=True)
class _Term:
    """One way to fulfil formulas: literals now, obligations for the next moment, postponed untils."""

    now: frozenset[Number] = frozenset()
    after: frozenset[Number] = frozenset()
    postponed: frozenset[Number] = frozenset()

    def joined(self, other: "_Term") -> "_Term":
        return _Term(self.now | other.now, self.after | other.after, self.postponed | other.postponed)

    def covers(self, other: "_Term") -> bool:
        """Return whether this term is implied by the other one."""
        return self.now <= other.now and self.after <= other.after and self.postponed <= other.postponed

    def key(self) -> tuple[list[Number], list[Number], list[Number]]:
        return sorted(self.now), sorted(self.after), sorted(self.postponed)


class _Tableau:
    def __init__(self, formulas: FormulaFactory, start: Number) -> None:
        self.formulas = formulas
        self.start = start
        self.terms: dict[Number, tuple[_Term, ...]] = {FALSE: (), TRUE: (_Term(),)}

    def automaton(self) -> BuchiAutomaton:
        states = self.states()
        untils = sorted({u for terms in states.values() for term in terms for u in term.postponed})
        if len(untils) > MOST_UNTILS:
            raise AutomatonTooLargeError(f"more than {MOST_UNTILS} promises")
        numbers = {state: number for number, state in enumerate(states)}
        moves = [
            tuple(
                Move(tuple(sorted(term.now)), numbers[self.state(term)], _marks(term, untils))
                for term in terms
            )
            for terms in states.values()
        ]
        final = _numbered(_merged(_useful(moves, len(untils))))
        literals = {number: self.literal(number) for out in final for move in out for number in move.literals}
        return BuchiAutomaton(final, literals, len(untils), _whatever(final, len(untils)))

    def states(self) -> dict[State, tuple[_Term, ...]]:
        first: State = self.state(_Term(after=frozenset({self.start})))
        found: dict[State, tuple[_Term, ...]] = {}
        waiting = [first]
        while waiting:
            look()
            state = waiting.pop(0)
            if state in found:
                continue
            if len(found) == MOST_STATES:
                raise AutomatonTooLargeError(f"its automaton has more than {MOST_STATES} states")
            found[state] = self.join(self.unfolded(each) for each in state)
            waiting += (self.state(term) for term in found[state])
        return found

    def state(self, term: _Term) -> State:
        """Return the obligations of a term: conjunctions are split, and `f` is dropped beside `[] f`."""
        found, waiting = set[Number](), sorted(term.after)
        while waiting:
            number = waiting.pop()
            operation = self.formulas.nodes[number]
            if operation.operator == "and":
                waiting += operation.operands
            elif number != TRUE:
                found.add(number)
        owed = (self.formulas.nodes[number] for number in found)
        ever = {each.operands[1] for each in owed if each.operator == "release" and each.operands[0] == FALSE}
        return tuple(sorted(found - ever))

    def literal(self, number: Number) -> Literal:
        literal = self.formulas.nodes[number].literal
        assert literal is not None
        return literal

    def unfolded(self, number: Number) -> tuple[_Term, ...]:
        """Return the ways to fulfil one formula, as disjuncts."""
        if number not in self.terms:
            self.terms[number] = self._unfold(number)
        return self.terms[number]

    def _unfold(self, number: Number) -> tuple[_Term, ...]:
        operation = self.formulas.nodes[number]
        operands = operation.operands
        here = frozenset({number})
        match operation.operator:
            case "lit":
                return (_Term(now=here),)
            case "and":
                return self.join(map(self.unfolded, operands))
            case "or":
                return least(term for each in operands for term in self.unfolded(each))
            case "next":
                return (_Term(after=frozenset(operands)),)
            case "until":
                later = self.join((self.unfolded(operands[0]), (_Term(after=here, postponed=here),)))
                return least((*self.unfolded(operands[1]), *later))
            case _:
                after = (*self.unfolded(operands[0]), _Term(after=here))
                return self.join((self.unfolded(operands[1]), after))

    def join(self, factors: Iterable[tuple[_Term, ...]]) -> tuple[_Term, ...]:
        """Return the ways to fulfil several formulas at once."""
        found: tuple[_Term, ...] = (_Term(),)
        for factor in factors:
            if len(found) * len(factor) > MOST_TERMS:
                raise AutomatonTooLargeError(f"it unfolds in more than {MOST_TERMS:,} ways")
            pairs = (one.joined(other) for one, other in product(found, factor))
            found = least(term for term in pairs if self.possible(term))
        return found

    def possible(self, term: _Term) -> bool:
        """Return whether no literal is both claimed and denied."""
        claims = dict[Temporal, bool]()
        literals = map(self.literal, term.now)
        return all(claims.setdefault(formula, claimed) is claimed for formula, claimed in literals)


def least(terms: Iterable[_Term]) -> tuple[_Term, ...]:
    """Return the terms that no other covers, in a fixed order."""
    found: list[_Term] = []
    for term in sorted(set(terms), key=lambda term: (len(term.now) + len(term.after), term.key())):
        if not any(other.covers(term) for other in found):
            found = [*(other for other in found if not term.covers(other)), term]
    return tuple(found)


def _marks(term: _Term, untils: list[Number]) -> int:
    return sum(1 << bit for bit, until in enumerate(untils) if until not in term.postponed)


# --- simplification -------------------------------------------------------------------------------------------

Moves = list[tuple[Move, ...]]


def _useful(moves: Moves, marks: int) -> Moves:
    """Remove the moves to states that accept nothing."""
    graph = nx.MultiDiGraph()
    graph.add_nodes_from(range(len(moves)))
    graph.add_edges_from(
        (state, move.target, {"marks": move.marks}) for state, out in enumerate(moves) for move in out
    )
    alive = set[int]()
    for component in nx.strongly_connected_components(graph):
        inner = graph.subgraph(component).edges(data="marks")
        if inner and _union(mark for *_, mark in inner) == (1 << marks) - 1:
            alive |= component | nx.ancestors(graph, next(iter(component)))
    return [tuple(move for move in out if move.target in alive) for out in moves]


def _union(marks: Iterable[int]) -> int:
    found = 0
    for mark in marks:
        found |= mark
    return found


def _merged(moves: Moves) -> dict[int, tuple[Move, ...]]:
    """Merge equivalent states by the coarsest bisimulation, the initial state in block 0."""
    blocks, count = [0] * len(moves), 1
    while True:
        shapes = [_shape(out, blocks) for out in moves]
        keys = list(zip(blocks, shapes, strict=True))
        numbers = {key: number for number, key in enumerate(dict.fromkeys(keys))}
        if len(numbers) == count:
            return dict(zip(blocks, shapes, strict=True))
        blocks, count = [numbers[key] for key in keys], len(numbers)


def _numbered(moves: dict[int, tuple[Move, ...]]) -> tuple[tuple[Move, ...], ...]:
    """Number the reachable blocks, nearest first."""
    order = {block: number for number, block in enumerate(_reached(moves))}
    return tuple(tuple(Move(m.literals, order[m.target], m.marks) for m in moves[block]) for block in order)


def _whatever(moves: tuple[tuple[Move, ...], ...], marks: int) -> int | None:
    """Return the state from which everything is accepted."""
    free = (Move((), number, (1 << marks) - 1) for number in range(len(moves)))
    return next((move.target for move, out in zip(free, moves, strict=True) if move in out), None)


def _shape(out: tuple[Move, ...], blocks: list[int]) -> tuple[Move, ...]:
    """Return the moves between blocks, without those that another one subsumes."""
    found: list[Move] = []
    for move in dict.fromkeys(Move(m.literals, blocks[m.target], m.marks) for m in out):
        if not any(_needless(move, other) for other in found):
            found = [*(other for other in found if not _needless(other, move)), move]
    return tuple(sorted(found, key=lambda m: (m.target, m.marks, m.literals)))


def _needless(move: Move, other: Move) -> bool:
    same = move.target == other.target and move.marks | other.marks == other.marks
    return same and set(other.literals) <= set(move.literals)


def _reached(moves: dict[int, tuple[Move, ...]]) -> Iterator[int]:
    """Yield the blocks that are reachable from the first, nearest first."""
    seen, waiting = {0}, [0]
    while waiting:
        block = waiting.pop(0)
        yield block
        new = [move.target for move in moves[block] if move.target not in seen]
        seen.update(new)
        waiting += dict.fromkeys(new)
