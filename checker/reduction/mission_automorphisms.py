"""The automorphisms of a mission: transpositions of names that preserve it, and the reasons against others."""

from collections.abc import Callable, Hashable, Iterable, Iterator, Set
from dataclasses import fields, is_dataclass
from functools import cached_property, partial
from itertools import product
from typing import Any

from checker.reduction.alpha_equivalence import VARIABLES, Pairing, Unlike
from checker.reduction.configuration_renaming import WORD, Mentions, Renaming
from checker.reduction.exchanged_times import check_times
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Fault, Literal
from semantics.behaviours.patterns import Exactly
from semantics.behaviours.program import Behaviour
from semantics.behaviours.statements import ControlBy, Spawn, Statement
from semantics.environment import Says
from semantics.properties.propositions import And, Instances, Or, Proposition
from semantics.state.cell_values import Cell
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler
from semantics.state.signature import Name

MOST_ARGUMENTS = 20_000
"""The most combinations of arguments with which a rule of the mission is tried."""


class Automorphisms:
    """The transpositions that preserve a mission."""

    def __init__(self, c: Configuration, formulas: Iterable[Proposition] = ()) -> None:
        self.c = c
        self.program = c.setting.program
        self.properties = tuple(map(_Parts, formulas))

    def transposition(self, pairing: Pairing) -> Renaming:
        """Return the renaming that exchanges both sides of a pairing; raises Unlike if it changes the mission."""
        renaming = self.of_setting(pairing)
        self._check_world(renaming)
        for each in self.properties:
            if not each.kept(renaming):
                raise Unlike(f"a property distinguishes them: {each.formula}")
        return renaming

    def of_setting(self, pairing: Pairing) -> Renaming:
        """Return the renaming that exchanges both sides; raises Unlike if it changes the mission's setting.

        The rules commute with such a renaming: the transitions of an image are the images of the transitions.
        """

        def both(pairs: dict[Any, Any]) -> dict[Any, Any]:
            return {**pairs, **{other: one for one, other in pairs.items()}}

        renaming = Renaming(both(pairing.names), both(pairing.numbers), both(pairing.variables))
        self._check_kinds(renaming)
        counters = _sayings(self.c, renaming, pairing.names)
        renaming = Renaming(renaming.names, renaming.numbers, renaming.variables, counters)
        self._check_program(renaming)
        if frozenset(map(renaming.name, self.c.setting.arriving)) != self.c.setting.arriving:
            raise Unlike("of one flights arrive, of the other not")
        missable = self.c.setting.missable
        if any((one in missable) is not (other in missable) for one, other in renaming.names.items()):
            raise Unlike("an observation may miss one, and never the other")
        check_times(self.c, renaming)
        strays = self.c.setting.strays
        if any(strays.get(one) != strays.get(other) for one, other in renaming.names.items()):
            raise Unlike("one strays farther from its way than the other")
        return renaming

    # --- kinds and names --------------------------------------------------------------------------------------

    @cached_property
    def _words(self) -> frozenset[str]:
        """The words in the names of channels and rules."""
        words = (word for channel in _channels(self.c) for word in WORD.findall(channel))
        return frozenset((*words, *self.program.reactions))

    @cached_property
    def _inhabited(self) -> frozenset[str]:
        """The kinds that may contain an existing entity."""
        setting = self.c.setting
        there = frozenset(setting.kinds.values())
        return frozenset(kind for kind in there if setting.signature[kind].contains & there)

    def _check_kinds(self, renaming: Renaming) -> None:
        kinds, alpha = self.c.setting.kinds, self.c.alpha
        for one, other in renaming.names.items():
            if (one in alpha) is not (other in alpha) or kinds.get(one) != kinds.get(other):
                raise Unlike(f"'{one}' and '{other}' are not of one kind")
            if one in self._words:
                raise Unlike(f"a channel or a rule is named with '{one}'")
            if kinds.get(one) in self._inhabited:
                raise Unlike(f"'{one}' may contain others: of two places as small the first by name is taken")

    # --- the program ------------------------------------------------------------------------------------------

    @cached_property
    def _statements(self) -> Mentions[int]:
        def looks() -> Iterator[tuple[int, Callable[[Renaming], object]]]:
            for number, statement in enumerate(self.program.statements):
                yield number, partial(_stated_at, number, statement)

        return Mentions(looks())

    @cached_property
    def _rules(self) -> list[tuple[str, int]]:
        """The mission's own rules, each with the number of its arguments, in the order of their first use."""
        used = (each for each in self.program.statements if isinstance(each, ControlBy))
        return list(
            dict.fromkeys((each.name, len(each.arguments)) for each in used if each.name not in COMMANDS)
        )

    def _check_program(self, renaming: Renaming) -> None:
        program = self.program
        for number in self._statements.of(renaming):
            partner, image = _stated_at(number, program.statements[number], renaming)
            if image != program.statements[partner]:
                line = program.line(number)
                raise Unlike(f"the text distinguishes them{f' (line {line})' if line else ''}")
        for variable in sorted(program.watched, key=str):
            if renaming.value(variable) not in program.watched:
                raise Unlike(f"a property distinguishes them: it names {variable}")
        for each in program.behaviours.values():
            if (
                Behaviour(each.name, restated(renaming, each.parameters), restated(renaming, each.body))
                != each
            ):
                raise Unlike(f"the behaviour '{each.name}' distinguishes them")
        for name, arguments in self._rules:
            self._check_rule(renaming, name, arguments)

    def _check_rule(self, renaming: Renaming, rule: str, arguments: int) -> None:
        make, names = self.program.reactions[rule], sorted(self.c.setting.kinds)
        mentions: Set[str] | None = getattr(make, "mentions", None)
        if mentions is not None:  # a rule from the mission's text; other functions are tried
            if not mentions.isdisjoint(renaming.names):
                raise Unlike(f"the rule '{rule}' distinguishes them")
            return
        if len(names) ** (arguments + 1) > MOST_ARGUMENTS:
            raise Unlike(f"the rule '{rule}' has too many arguments to be tried with all of them")
        for chosen in product(names, repeat=arguments + 1):
            if renaming.value(_made(make, chosen)) != _made(make, tuple(map(renaming.name, chosen))):
                raise Unlike(f"the rule '{rule}' distinguishes them")

    # --- the first configuration ------------------------------------------------------------------------------

    @cached_property
    def _cells(self) -> Mentions[Cell]:
        def looks() -> Iterator[tuple[Cell, Callable[[Renaming], object]]]:
            for cell, value in self.c.state.items():  # type: ignore[attr-defined]  # only rows are explored
                yield cell, partial(self._held_at, cell, value)

        return Mentions(looks())

    def _held_at(self, cell: Cell, value: Any, renaming: Renaming) -> tuple[Cell, Any]:
        unordered = self.c.setting.scheduler is Scheduler.UNORDERED
        return renaming.cell(cell), renaming.content(cell, value, unordered=unordered)

    def _check_world(self, renaming: Renaming) -> None:
        state = self.c.state
        for cell in self._cells.of(renaming):
            partner, image = self._held_at(cell, state.read(cell), renaming)
            if state.read(partner) != image:
                raise Unlike(
                    DIFFERENCES.get(cell[0], f"the initial state of '{cell[-1]}' ({cell[0]}) differs")
                )


DIFFERENCES = {"placement": "they are not in the same place", "channels": "they are on different channels"}
"""The messages for a difference between two initial cells, by the kind of cell."""


def _stated_at(number: int, statement: Statement, renaming: Renaming) -> tuple[int, Any]:
    """Return the image of a statement and of its number."""
    return renaming.numbers.get(number, number), restated(renaming, statement)


def _channels(c: Configuration) -> Iterator[str]:
    for name in c.setting.kinds:
        yield from (*c.structure.physical.channels(name), *c.structure.logical.links(name))
    for clause in c.setting.environment:
        yield from (getattr(clause, "channel", ""), *getattr(clause, "channels", ()))


def _sayings(c: Configuration, renaming: Renaming, first: Iterable[Name]) -> dict[Cell, Cell]:
    """Return the permutation of the counters of messages from outside, those of the first side first.

    Raises:
        Unlike: The renaming changes the environment.
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
    """Yield the messages from outside to some agents."""
    to = set(agents)
    return (each for each in c.setting.environment if isinstance(each, Says) and each.agent in to)


def _unnumbered(clause: Any) -> Any:
    return (clause.message, clause.agent, clause.times) if isinstance(clause, Says) else clause


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
        )  # a behaviour's parameter; names of members are handled below
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


# --- properties -----------------------------------------------------------------------------------------------


class _Parts:
    """A property as a conjunction; a transposition preserves it if it maps each changed part to a part."""

    def __init__(self, formula: Proposition) -> None:
        self.formula = formula
        self.parts = list(_flat(And, (formula,)))
        self.normal = frozenset(map(normal, self.parts))
        self.mentions = Mentions((number, partial(_image, part)) for number, part in enumerate(self.parts))

    def kept(self, renaming: Renaming) -> bool:
        """Return whether the property is invariant under a transposition."""
        changed = (self.parts[number] for number in self.mentions.of(renaming))
        return all(normal(_image(part, renaming)) in self.normal for part in changed)


def changing(formula: Proposition, renamings: Iterable[Renaming]) -> Renaming | None:
    """Return the first of some transpositions under which a proposition is not invariant."""
    parts = _Parts(formula)
    return next((each for each in renamings if not parts.kept(each)), None)


def _image(part: Any, renaming: Renaming) -> Any:
    return renaming.value(part)


def normal(formula: Any) -> Hashable:
    """Return a value that is the same for propositions that differ in the order of operands."""
    if isinstance(formula, And | Or):
        return (type(formula).__name__, frozenset(map(normal, _flat(type(formula), formula.formulas))))
    inner = getattr(formula, "formula", None)
    if inner is not None:
        return ("not", normal(inner))
    known: Hashable = formula
    return known


def _flat(kind: type, formulas: Iterable[Any]) -> Iterator[Any]:
    if isinstance(formulas, Instances):  # invariant if its range and its body are
        yield formulas
        return
    for each in formulas:
        if isinstance(each, kind):
            yield from _flat(kind, each.formulas)  # type: ignore[attr-defined]  # And and Or have them
        else:
            yield each
