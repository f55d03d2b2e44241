"""The writer of systems as `.big` files; `read_system` reads an equal system."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final, TypeVar

from bigraphs.errors import BigraphError, NotationError
from bigraphs.notation.big.anti_unification import folded
from bigraphs.notation.big.declarations import (
    ActionDeclaration,
    BigDeclaration,
    Call,
    ClassTerm,
    ConditionTerm,
    ControlDeclaration,
    Declaration,
    LinkDeclaration,
    Model,
    PlaceDeclaration,
    ReactDeclaration,
    SystemTerm,
)
from bigraphs.notation.big.expression_of import expression_of, values_of, written_value
from bigraphs.notation.big.grammar import RESERVED
from bigraphs.notation.big.printer import format_model
from bigraphs.notation.big.syntax import Arguments, ValueExpression
from bigraphs.notation.bounded_parsing import check_bounds
from bigraphs.signature import Control
from bigraphs.sorting import base
from bigraphs.system import Action, Predicate, Rule, System, SystemKind, Value

_CONTROL: Final = re.compile(r"[A-Z][A-Za-z0-9_']*")
_NAME: Final = re.compile(r"[a-z_][A-Za-z0-9_']*")
_Labelled = TypeVar("_Labelled", Rule, Predicate)


def write_system(system: System) -> str:
    """Return the text of a system.

    Raises:
        BigraphError: For parts without notation: names of nodes, properties and declared names of BigMC, controls of
            any arity, idle edges, and names with other characters. Also if the text would exceed the reader's limits.
    """
    return checked_text(model_of(system))


def checked_text(model: Model) -> str:
    """Return the text of a model; raises BigraphError if it exceeds the reader's limits."""
    text = format_model(model)
    try:
        check_bounds(text)
    except NotationError as error:
        message = f"as a .big file it would not be read again: {error.message}"
        raise BigraphError(error.code, message, "keep the file that it was read from") from None
    return text


def model_of(system: System) -> Model:
    """Return a system as syntax: one declaration for each rule and predicate.

    Instances of a parametrised rule are folded into one declaration with parameters if possible; otherwise each has its
    own.
    """
    if system.properties:
        raise _unwritable("properties")
    rules = _distinct(system.rules())
    initial = _fresh("initial", [*(rule.name for rule in rules), *(each.name for each in system.predicates)])
    declarations: list[Declaration] = [*_controls(system), *_sorts(system)]
    declarations += folded(map(_big, _distinct(system.predicates)))
    declarations.append(BigDeclaration(initial, expression_of(system.initial)))
    declarations += _rules(system, rules)
    return Model(tuple(declarations), _system(system, initial))


def _unwritable(what: str) -> BigraphError:
    return BigraphError(
        "notation", f"'.big' has no way to write {what}", "keep the file that it was read from"
    )


def _distinct(labelled: Iterable[_Labelled]) -> list[_Labelled]:
    """Return each rule or predicate once; raises BigraphError if two different ones share a label."""
    found: dict[str, _Labelled] = {}
    for each in labelled:
        if found.setdefault(each.label, each) != each:
            raise BigraphError("name", f"there are two different '{each.label}'")
    return list(found.values())


def _fresh(name: str, taken: Iterable[str]) -> str:
    used = set(taken)
    while name in used:
        name += "'"
    return name


def _checked(name: str, pattern: re.Pattern[str]) -> str:
    if not pattern.fullmatch(name) or name in RESERVED:
        raise _unwritable(f"the name '{name}'")
    return name


def _controls(system: System) -> Iterator[ControlDeclaration]:
    declared: dict[str, ControlDeclaration] = {}
    for control in system.signature.controls:
        declaration = _control(control)
        if declared.setdefault(declaration.name, declaration) != declaration:
            raise _unwritable(f"the control '{control.name}', of which there is another kind")
    yield from declared.values()


def _control(control: Control) -> ControlDeclaration:
    name = _checked(base(control.name), _CONTROL)
    if control.arity is None:
        raise _unwritable(f"the control '{name}' of any arity")
    count = len(values_of(control.name.partition("(")[2]))
    parameters = tuple(f"p{place}" for place in range(count))
    return ControlDeclaration(name, control.arity, control.status, control.ordered, parameters)


def _sorts(system: System) -> Iterator[Declaration]:
    for control, content in system.sorting.places:
        yield PlaceDeclaration(control, content)
    for sort in system.sorting.links:
        yield LinkDeclaration(sort.name, sort.ports)


def _big(predicate: Predicate) -> BigDeclaration:
    name = _checked(predicate.name, _NAME)
    return BigDeclaration(name, expression_of(predicate.pattern), (), _values(predicate.parameters))


def _values(values: Iterable[Value]) -> Arguments:
    return tuple(map(written_value, values))


def _rules(system: System, rules: Iterable[Rule]) -> Iterator[Declaration]:
    if system.kind is not SystemKind.NBRS:
        yield from folded(map(_react, rules))
        return
    for action in system.actions:
        within = folded(_react(rule) for rule in rules if rule.action == action.name)
        yield ActionDeclaration(_checked(action.name, _NAME), tuple(within), _reward(action))


def _reward(rewarded: Action | Predicate) -> ValueExpression | None:
    return None if not rewarded.reward and isinstance(rewarded, Action) else _written(rewarded.reward)


def _written(value: Value | None) -> ValueExpression | None:
    return None if value is None else written_value(value)


def _react(rule: Rule) -> ReactDeclaration:
    if rule.link_constants:
        raise _unwritable("names of a rule that stand for themselves")
    in_order = rule.instantiation == tuple(range(len(rule.redex.sites)))
    return ReactDeclaration(
        _checked(rule.name, _NAME),
        expression_of(rule.redex),
        expression_of(rule.reactum),
        None if in_order else rule.instantiation,
        _written(rule.weight),
        tuple(
            ConditionTerm(each.positive, expression_of(each.pattern), each.where.value)
            for each in rule.conditions
        ),
        (),
        _values(rule.parameters),
    )


def _system(system: System, initial: str) -> SystemTerm:
    classes = tuple(
        ClassTerm(tuple(Call(rule.name, _values(rule.parameters)) for rule in each.rules), each.instantaneous)
        for each in system.classes
        if each.rules
    )
    predicates = tuple(Call(each.name, _values(each.parameters), _reward(each)) for each in system.predicates)
    return SystemTerm(system.kind.value, Call(initial), classes, predicates)
