"""The syntax tree of declarations and whole `.big` files."""

from __future__ import annotations

from typing import TypeAlias

from bigraphs.notation.big.syntax import NOWHERE, Arguments, Expression, ValueExpression
from bigraphs.notation.lalr import Span
from bigraphs.records import Record
from bigraphs.signature import Status


class ControlDeclaration(Record):
    """`ctrl K = 1;`, after `atomic` or `passive`, `ordered` and `fun`; `parameters` are those of `fun ctrl`.

    The arity is None, any number, only where a signature says so: the notation has no word for it.
    """

    name: str
    arity: int | None
    status: Status = "active"
    ordered: bool = False
    parameters: tuple[str, ...] = ()
    span: Span = NOWHERE


class ConstantDeclaration(Record):
    """`int n = 3;`, `float f = 0.5;` or `string s = "a";`."""

    type: str
    name: str
    value: ValueExpression
    span: Span = NOWHERE


class BigDeclaration(Record):
    """`big b = expression;`, or `fun big b(n) = expression;`.

    `big b(1) = expression;` gives the bigraph for these arguments; systems with parameters are written so.
    """

    name: str
    body: Expression
    parameters: tuple[str, ...] = ()
    arguments: Arguments = ()
    span: Span = NOWHERE


class ConditionTerm(Record):
    """`[!] pattern in ctx|param`."""

    positive: bool
    pattern: Expression
    where: str
    span: Span = NOWHERE


class ReactDeclaration(Record):
    """`react r = redex --> reactum @ [sites] if conditions;`, or `fun react r(n) = ...;`.

    The instantiation map is None if it is not written; `weight` is what stands in `-[w]->`.
    """

    name: str
    redex: Expression
    reactum: Expression
    instantiation: tuple[int, ...] | None = None
    weight: ValueExpression | None = None
    conditions: tuple[ConditionTerm, ...] = ()
    parameters: tuple[str, ...] = ()
    arguments: Arguments = ()
    span: Span = NOWHERE


class ActionDeclaration(Record):
    """`action a[reward] react ...; end`."""

    name: str
    rules: tuple[ReactDeclaration, ...]
    reward: ValueExpression | None = None
    span: Span = NOWHERE


class SortDeclaration(Record):
    """`sort S = {K, L};`: a name for a set of controls."""

    name: str
    controls: tuple[str, ...]
    span: Span = NOWHERE


class PlaceDeclaration(Record):
    """`place K = {L, S};`: what a K holds; nothing, if the braces are empty."""

    control: str
    content: tuple[str, ...]
    span: Span = NOWHERE


class LinkDeclaration(Record):
    """`link radio = {K, L.0};`: ports that only links of this sort join."""

    name: str
    ports: tuple[tuple[str, int | None], ...]
    span: Span = NOWHERE


class Call(Record):
    """A rule, a predicate or a first state: `r`, `r(n, 2)`; `reward` is a predicate's."""

    name: str
    arguments: Arguments = ()
    reward: ValueExpression | None = None
    span: Span = NOWHERE


class ParameterDeclaration(Record):
    """`int n, m = {1, 2};`: the values that parameters of a system range over.

    `values` are those of the set, the single value, or, if `ranged`, first value, step and last value.
    """

    type: str
    names: tuple[str, ...]
    values: tuple[ValueExpression, ...]
    ranged: bool = False
    span: Span = NOWHERE


class ClassTerm(Record):
    """Rules of one priority, `{r, s(n)}`, or instantaneous ones, `(r)`."""

    rules: tuple[Call, ...]
    instantaneous: bool = False
    span: Span = NOWHERE


class ActionTerm(Record):
    """`a[reward] = {r, s}`, an action that lists its rules, within a system."""

    name: str
    rules: tuple[str, ...]
    reward: ValueExpression | None = None
    span: Span = NOWHERE


class SystemTerm(Record):
    """`begin brs ... end`."""

    kind: str
    init: Call
    classes: tuple[ClassTerm, ...] = ()
    predicates: tuple[Call, ...] = ()
    parameters: tuple[ParameterDeclaration, ...] = ()
    actions: tuple[ActionTerm, ...] = ()
    span: Span = NOWHERE


Declaration: TypeAlias = (
    ControlDeclaration
    | ConstantDeclaration
    | BigDeclaration
    | ReactDeclaration
    | ActionDeclaration
    | SortDeclaration
    | PlaceDeclaration
    | LinkDeclaration
)


class Model(Record):
    """A `.big` file as written."""

    declarations: tuple[Declaration, ...]
    system: SystemTerm | None = None
