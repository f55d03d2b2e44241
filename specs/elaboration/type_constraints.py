"""Required types of values: collected while statements are elaborated, and checked when all types are known."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from physical.wordings import counted
from semantics.behaviours.expressions import Expression, Literal, Variable
from semantics.behaviours.patterns import Pattern
from semantics.behaviours.statements import React, Send
from semantics.behaviours.values import Value, show
from semantics.state.signature import NO_ENTITIES
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.mission_mistakes import Findings, shorten
from specs.elaboration.value_types import (
    COLLECTIONS,
    EVERY,
    HOLDERS,
    NAMES,
    NOTHING,
    Inference,
    Sorts,
    Type,
    Types,
    ValueSort,
    compared,
    may_take,
    members_of,
)


@dataclass(frozen=True, slots=True)
class Need:
    """The types that an operand accepts.

    Attributes:
        sorts: The accepted sorts.
        remedy: The hint for a value of another sort.
        members: If it accepts sets or routes, the accepted sorts of their members.
        filled: Whether they must have a member.
    """

    sorts: Sorts
    remedy: str
    members: Sorts = EVERY
    filled: bool = False

    def met(self, given: Type) -> bool:
        """Whether some value of a type may be accepted; a type without values is accepted."""
        taken = given.sorts & self.sorts
        fits = given.members & self.members if given.members else not self.filled
        return bool(taken - HOLDERS or (taken & HOLDERS and fits) or not given.sorts)


MOST_MESSAGES: Final = 50
"""The most types of messages whose lines are reported; each is compared with the cases of every react."""

CONDITIONAL: Final = "a condition"
_NAME_IT: Final = "write its name, or a variable that holds it"
_NODES: Final = HOLDERS | {ValueSort.ENTITY}

CONDITION: Final = Need(
    Sorts({ValueSort.TRUTH}), "compare it, or ask something of it: x == 3, uav0 in obs, not empty(seen)"
)
COLLECTION: Final = Need(
    COLLECTIONS, "write a set, {a0, b0}, a route, [a0, b0], or a variable that holds one"
)
FILLED: Final = Need(COLLECTIONS, COLLECTION.remedy, filled=True)
SEEN: Final = Need(
    Sorts({ValueSort.OBSERVATION}), "give it what a react received: case obs: Observation => ..."
)
NUMBER: Final = Need(Sorts({ValueSort.NUMBER}), "write a whole number, or count: size(obs)")
TUPLE: Final = Need(
    Sorts({ValueSort.TUPLE, ValueSort.ROUTE}), "write a tuple, (a0, 3), or a route, [a0, b0]", filled=True
)
NODE: Final = Need(_NODES, _NAME_IT, Sorts({ValueSort.ENTITY}), filled=True)
NODES: Final = Need(_NODES, _NAME_IT, Sorts({ValueSort.ENTITY}))
AGENT: Final = Need(
    HOLDERS | {ValueSort.AGENT},
    f"{_NAME_IT}: send message to bigActor",
    Sorts({ValueSort.AGENT}),
    filled=True,
)
ENTITY: Final = Need(Sorts({ValueSort.ENTITY}), _NAME_IT)
NAME: Final = Need(NAMES, _NAME_IT)
MEMBER: Final = Need(
    Sorts({ValueSort.ENTITY, ValueSort.NUMBER}), "a member is called by its entity or its number"
)

OPERANDS: Final[Mapping[str, tuple[Need | None, ...]]] = {
    **dict.fromkeys(("<", "<=", ">", ">="), (NUMBER, NUMBER)),
    **dict.fromkeys(("union", "minus", "intersect"), (COLLECTION, COLLECTION)),
    **dict.fromkeys(("size", "empty"), (COLLECTION,)),
    "first": (FILLED,),
    **dict.fromkeys(("nodes", "agents"), (SEEN,)),
    **dict.fromkeys(("parent", "children"), (NAME, SEEN)),
    "linked": (NAME, NAME, SEEN),
    "of": (COLLECTION, None),
    "in": (None, COLLECTION),
    "not": (CONDITION,),
    "kind": (ENTITY,),
    "element": (TUPLE, NUMBER),
}
"""The accepted types of operators whose operands are checked one by one; None for any."""


@dataclass(frozen=True, slots=True)
class Use:
    """An expression used as an operand.

    Attributes:
        where: The written expression.
        value: The elaborated expression.
        need: The types that the operand accepts.
        by: The operator or statement, for messages.
    """

    where: s.Node
    value: Expression
    need: Need
    by: str


@dataclass(frozen=True, slots=True)
class OperandPair:
    """Two operands that are checked together."""

    operator: str
    left: s.Node
    right: s.Node
    values: tuple[Expression, Expression]


@dataclass(frozen=True, slots=True)
class CaseDistinction:
    """The cases of a `match`, one of which must accept the subject, or of a `react`, which has no subject."""

    where: s.Node
    subject: Expression | None
    cases: tuple[tuple[s.Pattern, Pattern], ...]


Demand = Use | OperandPair | CaseDistinction


def check_types(demands: list[Demand], inference: Inference, findings: Findings) -> Types:
    """Report values of the wrong type, warn of doubtful ones, and return the types of variables."""
    known = inference.variables()
    judge = _Judge(inference, known, _gifts(inference, known), findings)
    for demand in demands:
        if isinstance(demand, Use):
            judge.use(demand)
        elif isinstance(demand, CaseDistinction):
            judge.choice(demand)
        elif demand.operator == "element":
            judge.item(demand)
        elif demand.operator in ("+", "-"):
            judge.sum(demand)
        else:
            judge.comparison(demand)
    return known


def _gifts(inference: Inference, known: Types) -> Mapping[str, list[tuple[int, Type]]]:
    """Return the lines that assign each variable, with the types; for a received message, the line of the `send`."""
    program, found = inference.program, dict[str, list[tuple[int, Type]]]()
    sent: list[tuple[int, Type]] = []
    for number, each in enumerate(program.statements):
        if isinstance(each, Send) and len(sent) < MOST_MESSAGES:
            message = inference.type(each.message, known)
            if all(message != other for _, other in sent):
                sent.append((program.line(number), message))
    seen = Sorts({ValueSort.OBSERVATION})
    for number, statement in enumerate(program.statements):
        here = program.line(number)
        for line, message in [*(sent if isinstance(statement, React) else ()), (here, NOTHING)]:
            for name, given in inference.given(statement, known, message):
                if given.sorts and (line == here or given.sorts != seen):
                    found.setdefault(name, []).append((line, given))
    return found


@dataclass(frozen=True, slots=True)
class _Judge:
    inference: Inference
    known: Types
    gifts: Mapping[str, list[tuple[int, Type]]]
    findings: Findings

    def use(self, use: Use) -> None:
        given = self.inference.type(use.value, self.known)
        if not use.need.met(given):
            self.report(use, given)
        elif isinstance(use.value, Variable) and given.sorts != EVERY:
            self.doubt(use, use.value.name)

    def report(self, use: Use, given: Type) -> None:
        needs = f"{use.by} {'is' if use.by == CONDITIONAL else 'needs'} {_words(use.need)}"
        message = f"{needs}, and {_shown(use.where)} is {_said(given, use.need)}"
        origin = self.origin(use.value, use.need) if isinstance(use.value, Variable) else ""
        if use.need is COLLECTION and use.by != "'for'" and given.sorts == {ValueSort.ENTITY}:
            asked = " if x in obs" if use.by == "'in'" else ""
            react = f"react {{ case obs: Observation{asked} => ... }}"
            remedy = f"observe it first: observe(CHILDREN({write(use.where)})) {react}"
            self.findings.add(Code.WRONG_VALUE, use.where, message, remedy)
            return
        several = use.need in (NODE, AGENT) and bool(use.need.members & members_of(given))
        hint = f"take one: choose x in {write(use.where)} {{ ... }}" if several else use.need.remedy
        if use.need.sorts & NAMES and ValueSort.TEXT in given.sorts | given.members:
            hint = self.unquoted(use.where) or "a name is written without quotes"
        if isinstance(use.where, s.TupleLiteral) and use.need.sorts >= COLLECTIONS:
            hint = f"in this order it is a route: {write(s.RouteLiteral(use.where.items))}"
        self.findings.add(Code.WRONG_VALUE, use.where, message + origin, hint)

    def doubt(self, use: Use, variable: str) -> None:
        """Warn of a variable to which some statement assigns a value that is not accepted here."""
        for line, given in self.gifts.get(variable, ()):
            if not use.need.met(given):
                message = (
                    f"{use.by} needs {_words(use.need)}, and {_shown(use.where)} may be "
                    f"{_said(given, use.need)}: line {line} gives it that"
                )
                hint = "use a variable of its own for each"
                self.findings.warn(Code.TWO_TYPES, use.where, message, hint)
                return

    def origin(self, variable: Variable, need: Need) -> str:
        lines = (line for line, given in self.gifts.get(variable.name, ()) if not need.met(given) and line)
        first = min(lines, default=0)
        return f" (line {first})" if first else ""

    def choice(self, choice: CaseDistinction) -> None:
        if choice.subject is None:
            given = self.inference.messages(self.known)
        else:
            given = self.inference.type(choice.subject, self.known)
            taken = (may_take(pattern, given, self.inference) for _, pattern in choice.cases)
            if given.sorts and not any(taken):
                message = f"no case takes {_shown(choice.where)}, which is {_listed(given.sorts)}"
                hint = next((hint for where, _ in choice.cases if (hint := self.unquoted(where, "="))), "")
                self.findings.add(
                    Code.WRONG_VALUE, choice.where, message, hint or "add one that does: case _ => ..."
                )
                return
        for where, pattern in choice.cases:
            self.quotes(where, pattern, given)

    def quotes(self, where: s.Pattern, pattern: Pattern, given: Type) -> None:
        """Warn of a case with a text where only names occur, or with a name where only texts do."""
        for constant, there in compared(pattern, given):
            own = self.inference.constant(constant).sorts
            if own.isdisjoint(there) and ValueSort.TEXT in own | there <= NAMES | {ValueSort.TEXT}:
                what = f"{show(constant)} is {_listed(own)}, and the value is {_listed(there)}"
                message = f"this case is never taken: {what}"
                hint = self.unquoted(where, "=") or requoted(constant)
                self.findings.warn(Code.ALWAYS_THE_SAME, where, message, hint)
                return

    def item(self, pair: OperandPair) -> None:
        """Report the index of an item that no tuple has."""
        given, index = self.inference.type(pair.values[0], self.known), pair.values[1]
        if given.tuples and isinstance(index, Literal) and isinstance(index.value, int):
            longest = max(length for length, _ in given.tuples)
            if not 0 <= index.value < longest and given.sorts == {ValueSort.TUPLE}:
                items = counted(longest, "item")
                message = f"{_shown(pair.left)} has {items}, counted from 0, and no item {index.value}"
                self.findings.add(Code.WRONG_VALUE, pair.right, message, f"write 0 to {longest - 1}")

    def sum(self, pair: OperandPair) -> None:
        left, right = (self.inference.type(value, self.known) for value in pair.values)
        numbers = ValueSort.NUMBER in left.sorts and ValueSort.NUMBER in right.sorts
        routes = ValueSort.ROUTE in left.sorts and ValueSort.ROUTE in right.sorts
        joined = left.sorts & (COLLECTIONS if pair.operator == "-" else {ValueSort.SET})
        if numbers or routes or (joined and right.sorts & COLLECTIONS) or not (left.sorts and right.sorts):
            return
        alone = ValueSort.ROUTE in left.sorts and not joined
        need = (
            NUMBER if ValueSort.NUMBER in left.sorts else _SETS if joined else _ROUTE if alone else _ADDENDS
        )
        blamed = (pair.right, pair.values[1]) if need is not _ADDENDS else (pair.left, pair.values[0])
        self.use(Use(*blamed, need, f"'{pair.operator}'"))

    def comparison(self, pair: OperandPair) -> None:
        left, right = (self.inference.type(value, self.known) for value in pair.values)
        others = members_of(right) if pair.operator == "in" else right.sorts
        if not left.sorts or not others or left.sorts & others:
            return
        outcome = "true" if pair.operator == "!=" else "false"
        verb = "holds" if pair.operator == "in" else "is"
        those = f"{_shown(pair.right)} {verb} {_listed(others)}"
        message = f"this is always {outcome}: {_shown(pair.left)} is {_listed(left.sorts)}, and {those}"
        span = pair.left.span.to(pair.right.span)
        hint = self.unquoted(pair.left) or self.unquoted(pair.right)
        observed = ValueSort.OBSERVATION in left.sorts | right.sorts and pair.operator != "in"
        remedy = (
            f"a message is taken by {_MESSAGE}" if observed else "compare it with a value of the same type"
        )
        self.findings.warn(Code.ALWAYS_THE_SAME, span, message, hint or remedy)

    def unquoted(self, node: s.Node, sign: str = "") -> str:
        """Return the hint for a text that spells a name, anywhere in a node; a pattern writes `sign` before a name."""
        known = self.inference.entities | self.inference.agents
        return next((hint for part in s.walk(node) if (hint := unquoted(part, known, sign))), "")


_MESSAGE: Final = 'case m: Message, or by its value: case ("found", x)'
_SETS: Final = Need(COLLECTIONS, COLLECTION.remedy)
_ROUTE: Final = Need(Sorts({ValueSort.ROUTE}), "routes are joined with routes: [a0] + [b0, a0]")
_ADDENDS: Final = Need(HOLDERS | {ValueSort.NUMBER}, "add numbers, or join sets or routes: {a0} + {b0}")


def operands(
    operator: str, nodes: tuple[s.Expression, ...], values: tuple[Expression, ...]
) -> Iterator[Demand]:
    """Yield the required types of an operator's operands."""
    if operator in ("+", "-", "==", "!=", "in", "element"):
        yield OperandPair(operator, nodes[0], nodes[1], (values[0], values[1]))
    for node, value, need in zip(nodes, values, OPERANDS.get(operator, ()), strict=False):
        if need is not None:
            yield Use(node, value, need, f"'{operator}'")


def requoted(value: Value) -> str:
    """Return the hint for a name in the place of a text, or for a text that spells no name."""
    is_name = isinstance(value, str)
    return f'a text is written in quotes: "{value}"' if is_name else "a name is written without quotes"


def unquoted(node: s.Node, names: Container[str], sign: str = "") -> str:
    """Return the hint for a text that spells a name, written with `sign` before it."""
    spells = isinstance(node, s.TextLiteral) and (node.value in names or node.value in NO_ENTITIES)
    return f"write the name without quotes: {sign}{write(node)[1:-1]}" if spells else ""


def _words(need: Need) -> str:
    return _listed(need.sorts - HOLDERS if need in (NODE, NODES, AGENT) else need.sorts)


def _said(given: Type, need: Need) -> str:
    what = _listed(given.sorts)
    if not (given.sorts <= HOLDERS and given.sorts <= need.sorts):
        return what
    return f"{what} that holds {_listed(given.members)}" if given.members else what.replace("a ", "an empty ")


def _listed(sorts: Sorts) -> str:
    words = [sort.value for sort in ValueSort if sort in sorts]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _shown(node: s.Node) -> str:
    return f"'{shorten(write(node))}'"
