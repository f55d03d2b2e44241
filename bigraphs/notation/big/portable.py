"""Translation of a `.big` file to the language that BigraphER reads, as far as possible.

The translation rewrites these extensions: free order of declarations, several kinds of wires before an expression, and
`{x, y}`. In a system it also rewrites `r(n + 1)`, listed actions, and declarations for particular arguments.
`unportable` lists the other extensions.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from typing import Any, Final

from bigraphs.notation.big.anti_unification import changed, folded
from bigraphs.notation.big.declarations import (
    ActionDeclaration,
    BigDeclaration,
    Call,
    ClassTerm,
    ConstantDeclaration,
    ControlDeclaration,
    Declaration,
    LinkDeclaration,
    Model,
    PlaceDeclaration,
    ReactDeclaration,
    SortDeclaration,
    SystemTerm,
)
from bigraphs.notation.big.expression_of import written_value
from bigraphs.notation.big.printer import format_value
from bigraphs.notation.big.syntax import (
    Absolute,
    Chain,
    Close,
    Expression,
    Identity,
    Ion,
    Literal,
    Nest,
    NewNames,
    Ref,
    Substitute,
    Variable,
    Wire,
    Wired,
)
from bigraphs.notation.big.values import variables
from bigraphs.records import Record
from bigraphs.system import Predicate, Rule, System, Value

_IDENTIFIER: Final = re.compile(r"[a-z][A-Za-z0-9_']*")
_TEXT: Final = re.compile(r"[A-Za-z0-9_'-]*")
_TYPES: Final[Mapping[type, str]] = {int: "int", float: "float", str: "string"}


def portable(model: Model, system: System, constants: Mapping[str, Value]) -> Model:
    """Return a file as BigraphER reads it, as far as possible, with these values of constants.

    `system` is the meaning of the file with them.
    """
    declared = [*_constants(model, constants)]
    whole = model.system
    listed = declared if whole is None else _in_actions(declared, whole)
    plain = _Plain(_link_names(model))
    declarations = _in_order(map(plain.of, _as_functions(listed, model)))
    return Model(tuple(declarations), None if whole is None else _system(whole, system))


# --- declarations


def _constants(model: Model, given: Mapping[str, Value]) -> Iterator[Declaration]:
    """Yield the declarations with the given values of constants."""
    declared = {each.name for each in model.declarations if isinstance(each, ConstantDeclaration)}
    for name, value in given.items():
        if name not in declared:
            yield ConstantDeclaration(_TYPES[type(value)], name, written_value(value))
    for each in model.declarations:
        if isinstance(each, ConstantDeclaration) and each.name in given:
            yield changed(each, value=written_value(given[each.name]))
        else:
            yield each


def _in_actions(declarations: Iterable[Declaration], system: SystemTerm) -> Iterator[Declaration]:
    """Yield the declarations; rules that the system lists in an action move into that action."""
    action_of = {rule: action for action in system.actions for rule in action.rules}
    rules: dict[str, list[ReactDeclaration]] = {action.name: [] for action in system.actions}
    for each in declarations:
        if isinstance(each, ReactDeclaration) and each.name in action_of:
            rules[action_of[each.name].name].append(each)
        else:
            yield each
    for action in system.actions:
        if rules[action.name]:
            yield ActionDeclaration(action.name, tuple(rules[action.name]), action.reward)


def _as_functions(declarations: Iterable[Declaration], model: Model) -> Iterator[Declaration]:
    """Yield the declarations; those for particular arguments become functions if possible."""
    taken = _names_of(model)
    bigs: list[BigDeclaration] = []
    reacts: list[ReactDeclaration] = []
    for each in declarations:
        if isinstance(each, BigDeclaration) and each.arguments:
            bigs.append(each)
        elif isinstance(each, ReactDeclaration) and each.arguments:
            reacts.append(each)
        elif isinstance(each, ActionDeclaration):
            yield changed(each, rules=tuple(folded(each.rules, taken)))
        else:
            yield each
    yield from folded(bigs, taken)
    yield from folded(reacts, taken)


def _names_of(model: Model) -> set[str]:
    """Return the names of all bigraphs and values."""
    names = {part.name for part in _parts(model) if isinstance(part, BigDeclaration | ConstantDeclaration)}
    parameters = model.system.parameters if model.system else ()
    return (
        names
        | {name for each in parameters for name in each.names}
        | {each.name for each in _parts(model) if isinstance(each, Variable)}
    )


def _in_order(declarations: Iterable[Declaration]) -> Iterator[Declaration]:
    """Yield declarations in order of use: controls, sorts, then each of the others after the ones that it uses."""
    every = list(declarations)
    first = (ControlDeclaration, SortDeclaration, PlaceDeclaration, LinkDeclaration)
    yield from (each for kind in first for each in every if isinstance(each, kind))
    rest = [each for each in every if not isinstance(each, first)]
    by_name: dict[str, list[Declaration]] = {}
    for each in rest:
        for name in _declared(each):
            by_name.setdefault(name, []).append(each)
    done: set[int] = set()

    def after(each: Declaration) -> Iterator[Declaration]:
        if id(each) in done:
            return
        done.add(id(each))
        for name in _used(each):
            for used in by_name.get(name, ()):
                yield from after(used)
        yield each

    for each in rest:
        yield from after(each)


def _declared(declaration: Declaration) -> Iterator[str]:
    if isinstance(declaration, BigDeclaration | ConstantDeclaration):
        yield declaration.name


def _used(declaration: Declaration) -> list[str]:
    """Return the names of bigraphs and values in a declaration, in source order."""
    return [each.name for each in _parts(declaration) if isinstance(each, Ref | Variable)]


def _parts(value: object) -> Iterator[Record]:
    """Yield a record and every record inside it."""
    waiting = [value]
    while waiting:
        each = waiting.pop()
        if isinstance(each, tuple):
            waiting.extend(reversed(each))
        elif isinstance(each, Record):
            yield each
            waiting.extend(getattr(each, name) for name in reversed(each.__match_args__))


# --- expressions


class _Plain:
    """Rewrites parts of declarations; `taken` are the link names in use."""

    def __init__(self, taken: frozenset[str]) -> None:
        self.taken = taken

    def of(self, value: Any) -> Any:
        """Return a declaration, or a part of one, without extensions of this language."""
        match value:
            case tuple():
                return tuple(map(self.of, value))
            case Wired(wires, body):
                return _wired(wires, self.of(body))
            case NewNames(names) if len(names) > 1:
                first, *others = (NewNames((name,)) for name in dict.fromkeys(names))
                return Chain(first, tuple(("||", other) for other in others)) if others else first
            case Close((joined, _, *_) as names):
                return Chain(Close((joined,)), (("*", Substitute(joined, tuple(dict.fromkeys(names)))),))
            case Ion() | Nest(Ion()):
                return self.ion(value)
            case Record():
                return changed(
                    value, **{name: self.of(getattr(value, name)) for name in value.__match_args__}
                )
            case _:
                return value

    def ion(self, node: Ion | Nest) -> Expression:
        """Return a node with its content; a name on two of its ports becomes two names, joined outside."""
        ion = node.ion if isinstance(node, Nest) else node
        links: list[str] = []
        for name in ion.links:
            links.append(_fresh(name, self.taken.union(links)) if name in links else name)
        apart = changed(ion, links=tuple(links))
        body: Expression = Nest(apart, self.of(node.inside)) if isinstance(node, Nest) else apart
        for name in dict.fromkeys(ion.links):
            ends = tuple(end for end, joined in zip(links, ion.links, strict=True) if joined == name)
            body = Wired((Substitute(name, ends),), body) if len(ends) > 1 else body
        return body


def _link_names(model: Model) -> frozenset[str]:
    return frozenset(name for part in _parts(model) for name in _links_in(part))


def _fresh(name: str, taken: frozenset[str]) -> str:
    number = 1
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


def _wired(wires: tuple[Wire, ...], body: Expression) -> Expression:
    """Return an expression with wires, grouped so that only one kind stands before each parenthesis."""
    groups: list[tuple[Wire, ...]] = []
    for single, together in groupby(wires, lambda wire: isinstance(wire, Close) and len(wire.names) == 1):
        found = tuple(together)
        groups += [found] if single else [(wire,) for wire in found]
    for group in reversed(groups):
        body = Wired(group, body)
    return body


# --- systems


def _system(term: SystemTerm, system: System) -> SystemTerm:
    """Return a system whose call arguments are parameters or values only."""
    ranging = {name for each in term.parameters for name in each.names}
    classes = [
        ClassTerm(_calls(each.rules, found.rules, ranging), each.instantaneous)
        for each, found in zip(term.classes, system.classes, strict=True)
    ]
    return changed(
        term,
        classes=tuple(classes),
        predicates=_calls(term.predicates, system.predicates, ranging),
        actions=(),
    )


def _calls(
    calls: tuple[Call, ...], instances: Iterable[Rule | Predicate], ranging: set[str]
) -> tuple[Call, ...]:
    """Return the calls; if an argument computes with a parameter, one call per instance instead."""
    computing = any(
        not isinstance(value, Variable) and ranging & set(variables(value))
        for each in calls
        for value in each.arguments
    )
    if not computing:
        return calls
    return tuple(_call(each) for each in instances)


def _call(instance: Rule | Predicate) -> Call:
    reward = instance.reward if isinstance(instance, Predicate) else None
    arguments = tuple(map(written_value, instance.parameters))
    return Call(instance.name, arguments, None if reward is None else written_value(reward))


# --- the rest


def unportable(model: Model) -> list[str]:
    """Return the parts of a file that BigraphER cannot express."""
    return list(dict.fromkeys(_unknown(model)))


def _unknown(model: Model) -> Iterator[str]:
    for part in _parts(model):
        match part:
            case ControlDeclaration(name, _, status, ordered):
                if status == "passive" or ordered:
                    yield f"'{'passive ' * (status == 'passive')}{'ordered ' * ordered}ctrl {name}'"
            case PlaceDeclaration(name) | SortDeclaration(name) | LinkDeclaration(name):
                yield f"'{type(part).__name__.removesuffix('Declaration').lower()} {name}'"
            case BigDeclaration(arguments=arguments) | ReactDeclaration(arguments=arguments) if arguments:
                word = "big" if isinstance(part, BigDeclaration) else "react"
                yield f"'{word} {part.name}(...)' for given arguments"
            case Absolute():
                yield "'abs'"
            case Call(reward=Record() as reward) | ActionDeclaration(reward=Record() as reward):
                if any(
                    isinstance(each, Literal) and isinstance(each.value, float) for each in _parts(reward)
                ):
                    yield f"the reward {format_value(reward)}, which is no whole number"
            case Literal(str() as text) if not _TEXT.fullmatch(text):
                yield f'the string "{text}"'
        yield from (f"the name '{name}'" for name in _names_in(part) if not _IDENTIFIER.fullmatch(name))


def _links_in(part: Record) -> Iterator[str]:
    match part:
        case Ion(links=names) | Close(names) | NewNames(names) | Identity(names=names):
            yield from names
        case Substitute(outer, inner):
            yield from (outer, *inner)
        case _:
            pass


def _names_in(part: Record) -> Iterator[str]:
    yield from _links_in(part)
    match part:
        case (
            BigDeclaration(name=name)
            | ReactDeclaration(name=name)
            | ConstantDeclaration(name=name)
            | ActionDeclaration(name=name)
            | Variable(name=name)
        ):
            yield name
        case _:
            pass
