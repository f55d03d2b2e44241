"""The automorphisms of a mission: transpositions of names that preserve it, and why others don't."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, fields, is_dataclass
from itertools import product
from typing import Any

from checker.reduction.renaming import WORD, Renaming
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Fault, Literal, Variable
from semantics.behaviours.patterns import Anything, Exactly
from semantics.behaviours.program import Behaviour
from semantics.behaviours.statements import Assign, ChooseFrom, ControlBy, For, ForEach, Spawn
from semantics.environment import Says
from semantics.properties.propositions import And, Or, Proposition
from semantics.state.cells import Cell
from semantics.state.configuration import Configuration
from semantics.state.signature import Name

VARIABLES = {
    (Variable, "name"),
    (Assign, "variable"),
    (For, "rest"),
    (ForEach, "variable"),
    (ForEach, "rest"),
    (ChooseFrom, "variable"),
    (Anything, "variable"),
}
"""The members of statements, expressions and patterns that are names of variables."""

MOST_ARGUMENTS = 20_000
"""The most combinations of arguments with which a rule of the mission is tried."""


UNLIKE_TEXTS = "their texts differ"


class Unlike(Exception):
    """Two agents or entities are not interchangeable; says why."""


# --- pairing --------------------------------------------------------------------------------------------------


@dataclass
class Pairing:
    """A correspondence between two sides: names, statements, variables."""

    c: Configuration
    names: dict[str, str] = field(default_factory=dict)
    numbers: dict[int, int] = field(default_factory=dict)
    variables: dict[str, str] = field(default_factory=dict)

    def agents(self, one: Name, other: Name) -> None:
        """Pair two agents with their hosts, their programs, and the names in these."""
        self.pair(self.names, one, other)
        self.pair(self.names, self.c.alpha.host(one), self.c.alpha.host(other))
        self.unify(self.c.alpha.code(one), self.c.alpha.code(other))

    def pair(self, known: dict[Any, Any], one: Any, other: Any) -> bool:
        """Note that one thing corresponds to another; tell whether that is new."""
        if one == other or known.get(one) == other:
            return False
        if one in known or one in known.values() or other in known or other in known.values():
            raise Unlike(f"'{one}' and '{other}' stand for each other in one place and not in another")
        known[one] = other
        return True

    def unify(self, one: Any, other: Any) -> None:
        """Pair two pieces of text part by part."""
        if type(one) is not type(other):
            raise Unlike(UNLIKE_TEXTS)
        if isinstance(one, tuple | frozenset):
            self.unify_all(one, other)
        elif isinstance(one, bool) or not isinstance(one, int):
            self.unify_parts(one, other)
        elif self.pair(self.numbers, one, other):
            statements = self.c.setting.program.statements
            self.unify(statements[one], statements[other])

    def unify_all(self, one: Any, other: Any) -> None:
        """Pair the members of two tuples, in order."""
        if len(one) != len(other):
            raise Unlike(UNLIKE_TEXTS)
        ordered = zip(one, other, strict=True) if isinstance(one, tuple) else ()
        for each in ordered:
            self.unify(*each)

    def unify_parts(self, one: Any, other: Any) -> None:
        """Pair the members of two statements, expressions or patterns."""
        if isinstance(one, Literal | Exactly):
            self.unify_values(one.value, other.value)
        elif is_dataclass(one):
            for member in fields(one):
                first, second = getattr(one, member.name), getattr(other, member.name)
                if (type(one), member.name) in VARIABLES and None not in (first, second):
                    self.pair(self.variables, first, second)
                elif isinstance(one, Spawn) and member.name == "name":
                    self.unify_values(first, second)
                else:
                    self.unify(first, second)
        elif one != other:
            raise Unlike(UNLIKE_TEXTS)

    def unify_values(self, one: Any, other: Any) -> None:
        """Pair two constants: names that may be exchanged, or equal values."""
        if isinstance(one, tuple) and isinstance(other, tuple) and len(one) == len(other):
            for each in zip(one, other, strict=True):
                self.unify_values(*each)
        elif isinstance(one, str) and isinstance(other, str) and {one, other} <= self.movable():
            self.pair(self.names, one, other)
        elif type(one) is not type(other) or one != other:
            raise Unlike(f"the text of one says {one} where the other's says {other}")

    def movable(self) -> frozenset[Name]:
        """Return the names that may be exchanged: of agents and of entities."""
        return frozenset((*self.c.alpha.names(), *self.c.setting.kinds))


# --- transpositions -------------------------------------------------------------------------------------------


def transposition(c: Configuration, pairing: Pairing) -> Renaming:
    """Return the renaming that exchanges both sides of a pairing; raises Unlike if it changes the mission."""

    def both(pairs: dict[Any, Any]) -> dict[Any, Any]:
        return {**pairs, **{other: one for one, other in pairs.items()}}

    renaming = Renaming(both(pairing.names), both(pairing.numbers), both(pairing.variables))
    _check_kinds(c, renaming)
    counters = _sayings(c, renaming, pairing.names)
    renaming = Renaming(renaming.names, renaming.numbers, renaming.variables, counters)
    _check_program(c, renaming)
    _check_world(c, renaming)
    return renaming


def _check_kinds(c: Configuration, renaming: Renaming) -> None:
    setting, agents = c.setting, set(c.alpha.names())
    words = {word for channel in _channels(c) for word in WORD.findall(channel)} | set(
        setting.program.reactions
    )
    for one, other in renaming.names.items():
        if (one in agents) is not (other in agents) or setting.kinds.get(one) != setting.kinds.get(other):
            raise Unlike(f"'{one}' and '{other}' are not of one kind")
        if one in words:
            raise Unlike(f"a channel or a rule is named with '{one}'")
        holds = setting.signature[setting.kind(one)].contains if one in setting.kinds else frozenset[str]()
        if holds.intersection(setting.kinds.values()):
            raise Unlike(f"'{one}' may contain others: of two places as small the first by name is taken")


def _channels(c: Configuration) -> Iterator[str]:
    for name in c.setting.kinds:
        yield from (*c.structure.physical.channels(name), *c.structure.logical.links(name))
    for clause in c.setting.environment:
        yield from (getattr(clause, "channel", ""), *getattr(clause, "channels", ()))


def _sayings(c: Configuration, renaming: Renaming, first: Iterable[Name]) -> dict[Cell, Cell]:
    """Return the permutation of the counters of messages from outside, those of the first side first.

    Raises:
        Unlike: It changes the environment.
    """
    counters: dict[Cell, Cell] = {}
    left = list(c.setting.environment)
    for clause in c.setting.environment:
        renamed = renaming.value(clause)
        found = next((each for each in left if _unnumbered(each) == _unnumbered(renamed)), None)
        if found is None:
            raise Unlike("the environment treats them differently")
        left.remove(found)
        if isinstance(clause, Says) and isinstance(found, Says) and clause.counter != found.counter:
            counters[clause.counter] = found.counter
    ones = {each.counter for each in _said_to(c, first)}
    return dict(sorted(counters.items(), key=lambda item: item[0] not in ones))


def _said_to(c: Configuration, agents: Iterable[Name]) -> Iterator[Says]:
    """Yield the messages that may be said to some agents."""
    to = set(agents)
    return (each for each in c.setting.environment if isinstance(each, Says) and each.agent in to)


def _unnumbered(clause: Any) -> Any:
    return (clause.message, clause.agent, clause.times) if isinstance(clause, Says) else clause


def _check_program(c: Configuration, renaming: Renaming) -> None:
    program = c.setting.program
    for number, statement in enumerate(program.statements):
        if restated(renaming, statement) != program.statements[renaming.numbers.get(number, number)]:
            line = program.lines[number] if number < len(program.lines) else 0
            raise Unlike(f"the text tells them apart{f' (line {line})' if line else ''}")
    for variable in sorted(program.watched, key=str):
        if renaming.value(variable) not in program.watched:
            raise Unlike(f"a property tells them apart: it names {variable}")
    for each in program.behaviours.values():
        if Behaviour(each.name, restated(renaming, each.parameters), restated(renaming, each.body)) != each:
            raise Unlike(f"the behaviour '{each.name}' tells them apart")
    for statement in program.statements:
        if isinstance(statement, ControlBy) and statement.name not in COMMANDS:
            _check_rule(c, renaming, statement)


def _check_rule(c: Configuration, renaming: Renaming, statement: ControlBy) -> None:
    make, names = c.setting.program.reactions[statement.name], sorted(c.setting.kinds)
    if len(names) ** (len(statement.arguments) + 1) > MOST_ARGUMENTS:
        raise Unlike(f"the rule '{statement.name}' has too many arguments to be tried with all of them")
    for chosen in product(names, repeat=len(statement.arguments) + 1):
        if renaming.value(_made(make, chosen)) != _made(make, tuple(map(renaming.name, chosen))):
            raise Unlike(f"the rule '{statement.name}' tells them apart")


def _made(make: Any, chosen: tuple[Name, ...]) -> Any:
    try:
        return make(*chosen)
    except Fault:
        return None


def restated(renaming: Renaming, value: Any) -> Any:
    """Return a statement, or a part of one, renamed."""
    if isinstance(value, tuple):
        return tuple(restated(renaming, each) for each in value)
    if isinstance(value, int) and not isinstance(value, bool):
        return renaming.numbers.get(value, value)
    if isinstance(value, str):
        return renaming.variables.get(
            value, value
        )  # of a behaviour's parameters: others are members, see below
    if isinstance(value, Literal | Exactly):
        return type(value)(renaming.value(value.value))
    if not is_dataclass(value) or isinstance(value, type):
        return value
    return type(value)(*(_restated_member(renaming, value, each.name) for each in fields(value)))


def _restated_member(renaming: Renaming, value: Any, member: str) -> Any:
    part = getattr(value, member)
    if isinstance(part, str) and (type(value), member) not in VARIABLES:
        return renaming.name(part) if isinstance(value, Spawn) and member == "name" else part
    return restated(renaming, part)


def _check_world(c: Configuration, renaming: Renaming) -> None:
    after = renaming.configuration(c)
    if after == c:
        if frozenset(map(renaming.name, c.setting.arriving)) != c.setting.arriving:
            raise Unlike("of one flights arrive, of the other not")
        return
    cell = next(cell for cell, value in c.state.items() if after.read(cell) != value)  # type: ignore[attr-defined]  # only rows are explored
    words = {"placement": "they are not in the same place", "channels": "they are on different channels"}
    raise Unlike(words.get(cell[0], f"what is said of '{cell[-1]}' at first ({cell[0]}) differs"))


# --- properties -----------------------------------------------------------------------------------------------


def is_invariant(renaming: Renaming, formula: Proposition) -> bool:
    """Tell whether a proposition is invariant under the exchange."""
    return bool(_normal(formula) == _normal(renaming.value(formula)))


def _normal(formula: Any) -> Any:
    if isinstance(formula, And | Or):
        return (type(formula).__name__, frozenset(map(_normal, _flat(type(formula), formula.formulas))))
    inner = getattr(formula, "formula", None)
    return formula if inner is None else ("not", _normal(inner))


def _flat(kind: type, formulas: Iterable[Any]) -> Iterator[Any]:
    for each in formulas:
        if isinstance(each, kind):
            yield from _flat(kind, each.formulas)  # type: ignore[attr-defined]  # And and Or have them
        else:
            yield each
