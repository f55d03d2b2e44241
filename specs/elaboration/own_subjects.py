"""Warnings about `empty(obs)`, and the like, of observations that always show their own subject.

`LINKED_TO(x)` shows x, `CHILDREN(PARENT(x))` shows x, and `HOSTED_AT(HOST)` shows the bigActor that asks. So an answer
to such a query has a member, unless its subject may be absent or missed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, pairwise

from semantics.analysis.traversal import bindings, reachable
from semantics.behaviours.expressions import Apply, Expression, Host, Literal, QueryOf, Variable
from semantics.behaviours.observations import QueryOperator
from semantics.behaviours.patterns import Anything
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Block, Observe, React, Send, inner_blocks
from semantics.environment import Clause, Says, Vanishes
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.bodies import Bodies, hosts_of, running
from specs.elaboration.names import Names
from specs.elaboration.size_tests import SizeTest
from specs.elaboration.world import InitialWorld


@dataclass(frozen=True, slots=True)
class _Subject:
    """A member of every answer to a query.

    Attributes:
        word: The word for it in the mission.
        kinds: The kinds that it may have; empty for a bigActor.
        query: The query as written.
        line: Its line.
    """

    word: str
    kinds: frozenset[str]
    query: str
    line: int


@dataclass(frozen=True, slots=True)
class _Asker:
    """One bigActor that may take answers at a `react`.

    Attributes:
        agent: The bigActor.
        observes: The statements whose answers it may take there.
        waits: Whether it waits for each answer at once, so that it is still where it was when it asked.
    """

    agent: str
    observes: tuple[int, ...]
    waits: bool


def warn_of_own_subjects(
    names: Names,
    bodies: Bodies,
    program: Program,
    world: InitialWorld,
    clauses: Sequence[Clause],
    missable: Sequence[str],
) -> None:
    """Warn of each test of an observation's size whose outcome its own subject decides."""
    if not names.sizes:
        return
    sends = any(isinstance(each, Send) for each in program.statements)
    is_silent = not sends and not any(isinstance(each, Says) for each in clauses)
    _Judge(names, bodies, program, _always_seen(names, world, clauses, missable), is_silent).warn()


def _always_seen(
    names: Names, world: InitialWorld, clauses: Sequence[Clause], missable: Sequence[str]
) -> frozenset[str]:
    """Return the entities that are never absent and never missed; none if one may vanish with what it carries."""
    vanishing = {each.entity for each in clauses if isinstance(each, Vanishes)}
    if any(names.signature[names.kinds[name]].holds for name in vanishing if name in names.kinds):
        return frozenset()
    return frozenset(names.kinds).difference(world.absent, vanishing, missable)


@dataclass(frozen=True, slots=True)
class _Judge:
    names: Names
    bodies: Bodies
    program: Program
    seen: frozenset[str]
    is_silent: bool

    def warn(self) -> None:
        """Warn of each written test; the members of a family share it."""
        written: dict[s.Span, list[SizeTest]] = defaultdict(list)
        for test in self.names.sizes:
            written[test.where.span].append(test)
        takers, askers = self.takers(), self.askers()
        for tests in written.values():
            found = [self.subject(test.collection, takers, askers) for test in tests]
            first, subject = tests[0], found[0]
            if subject is not None and all(each is not None and each.word == subject.word for each in found):
                always = "always" if first.outcome else "never"
                message = f"this is {always} true: {subject.query} in line {subject.line} always shows {subject.word}"
                hint = f"ask for the others: {_without(first, subject.word)}"
                self.names.findings.warn(Code.SHOWS_ITSELF, first.where, message, hint)

    def subject(
        self, collection: Expression, takers: Mapping[str, set[int]], askers: Mapping[int, list[_Asker]]
    ) -> _Subject | None:
        """Return what a collection always has as a member, None if that is not known."""
        kind = None
        if isinstance(collection, Apply) and collection.operator == "of":
            collection, of = collection.arguments
            kind = of.value if isinstance(of, Literal) else ""
        if not isinstance(collection, Variable):
            return None
        asked = [asker for react in takers.get(collection.name, ()) for asker in askers.get(react, ())]
        found = {self.of_query(each, number) for each in asked for number in each.observes}
        subjects = [each for each in found if each is not None]
        fits = kind is None or all(each.kinds == {kind} for each in subjects)
        alike = len({each.word for each in subjects}) == 1
        return min(subjects, key=lambda each: each.line) if fits and alike and None not in found else None

    def of_query(self, asker: _Asker, number: int) -> _Subject | None:
        """Return the subject of the answers to an `observe` of a bigActor."""
        statement, written = self.program.statements[number], self.bodies.nodes[number]
        if not isinstance(statement, Observe) or not isinstance(written, s.Observe):
            return None
        query = statement.query
        line = self.program.line(number)
        if query.operator == QueryOperator.HOSTED_AT:
            at_home = (
                asker.waits and isinstance(query.argument, Host) and self.kinds(asker, Host()) is not None
            )
            return _Subject("SELF", frozenset(), write(written.query), line) if at_home else None
        leaf = _leaf(query)
        kinds = None if leaf is None else self.kinds(asker, leaf)
        return None if kinds is None else _Subject(_word(written.query), kinds, write(written.query), line)

    def kinds(self, asker: _Asker, leaf: Expression) -> frozenset[str] | None:
        """Return the kinds of the entities that the subject of a query may be, None if one may not be seen."""
        if isinstance(leaf, Host):
            hosts = hosts_of(asker.agent, self.bodies, self.names)
        else:
            hosts = {leaf.value} if isinstance(leaf, Literal) and isinstance(leaf.value, str) else None
        return frozenset(self.names.kinds[each] for each in hosts) if hosts and hosts <= self.seen else None

    def takers(self) -> dict[str, set[int]]:
        """Return the statements at which each variable takes an observation; none for one bound otherwise, too."""
        found: dict[str, set[int]] = defaultdict(set)
        others: set[str] = set()
        for number, statement in enumerate(self.program.statements):
            for each in bindings(self.program, statement):
                if isinstance(each.pattern, Anything) and each.pattern.variable is not None:
                    takes = isinstance(statement, React) and self.takes_observations(each.pattern)
                    found[each.pattern.variable].add(number)
                    others |= set() if takes else {each.pattern.variable}
        return {variable: numbers for variable, numbers in found.items() if variable not in others}

    def takes_observations(self, pattern: object) -> bool:
        """Whether a case takes nothing but observations."""
        return isinstance(pattern, Anything) and (
            pattern.of == "observation" or (self.is_silent and pattern.of is None)
        )

    def askers(self) -> dict[int, list[_Asker]]:
        """Return the bigActors that may come to each `react`."""
        follows, found = dict(self.pairs()), dict[int, list[_Asker]]()
        for agent, block in running(self.bodies):
            inside = sorted(reachable(self.program, block))
            observes = [number for number in inside if isinstance(self.program.statements[number], Observe)]
            waits = all(self.takes_answer(follows.get(number)) for number in observes)
            for number in inside:
                if isinstance(self.program.statements[number], React):
                    own = tuple(each for each in observes if not waits or follows[each] == number)
                    found.setdefault(number, []).append(_Asker(agent, own, waits))
        return found

    def takes_answer(self, number: int | None) -> bool:
        """Whether a statement goes on with an observation only."""
        statement = None if number is None else self.program.statements[number]
        return (
            isinstance(statement, React)
            and statement.after is None
            and all(self.takes_observations(case.pattern) for case in statement.cases)
        )

    def pairs(self) -> Iterator[tuple[int, int]]:
        """Yield each statement with the one that follows it in its block."""
        begun: list[Block] = [each.block for each in self.bodies.all()]
        inner = (each.block for statement in self.program.statements for each in inner_blocks(statement))
        for block in chain(begun, inner):
            yield from pairwise(block)


def _leaf(query: QueryOf) -> Expression | None:
    """Return the expression of the node that a query always shows, if it is there; None if it need not show it."""
    match query:
        case QueryOf(None, argument) | QueryOf(
            QueryOperator.CHILDREN, QueryOf(QueryOperator.PARENT, argument)
        ):
            return None if isinstance(argument, QueryOf) else argument
        case QueryOf(QueryOperator.LINKED_TO, argument):
            return (_leaf(argument) or _around(argument)) if isinstance(argument, QueryOf) else argument
    return None


def _around(query: QueryOf) -> Expression | None:
    """Return the node whose children a query shows: a query about its answer is about that node, too."""
    if query.operator != QueryOperator.CHILDREN or isinstance(query.argument, QueryOf):
        return None
    return query.argument


def _word(query: s.Query) -> str:
    """Return the innermost word of a query."""
    return _word(query.argument) if isinstance(query, s.QueryApplication) else write(query)


def _without(test: SizeTest, word: str) -> str:
    """Return the question about all members but one."""
    match test.asked:
        case s.OfKind(operand, kind):
            return f"{test.function}(({write(operand)} - {{{word}}}) of {kind.text})"
        case asked:
            return f"{test.function}({write(asked)} - {{{word}}})"
