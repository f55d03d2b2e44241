"""Comparisons of variables with constants in properties: those that are never true."""

from __future__ import annotations

from typing import Final

from semantics.behaviours.program import VariableOf
from semantics.behaviours.values import Value, show
from semantics.properties.propositions import ORDERS
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.names import Names
from specs.elaboration.type_constraints import requoted, unquoted
from specs.elaboration.value_types import ANY, NAMES, NOTHING, Sorts, Types, ValueSort, sort_of

_PLURALS: Final = {
    ValueSort.NUMBER: "numbers",
    ValueSort.TEXT: "texts",
    ValueSort.ENTITY: "entities",
    ValueSort.AGENT: "bigActors",
    ValueSort.TRUTH: "true and false",
    ValueSort.TUPLE: "tuples",
    ValueSort.SET: "sets",
    ValueSort.ROUTE: "routes",
    ValueSort.OBSERVATION: "observations",
}

_WORDS: Final = NAMES | {ValueSort.TEXT}


def check_comparable(node: s.Stored, variable: VariableOf, value: Value, names: Names, types: Types) -> None:
    """Report a comparison that no value of the variable can satisfy."""
    if node.operator in ORDERS and not isinstance(value, int):
        message = f"'{node.operator}' compares numbers, and {show(value)} is none"
        hint = "write a whole number, or compare with == or !="
        names.findings.add(Code.NOT_COMPARABLE, node, message, hint)
        return
    sorts = frozenset[ValueSort]().union(*(types.get(each, NOTHING).sorts for each in variable.variables))
    sort, sorts = sort_of(value, names.agents), sorts or ANY.sorts
    if sort in _WORDS and sorts & _WORDS:
        _check_quotes(node, variable, value, sorts & _WORDS, names)
    elif sort not in sorts:
        has = " or ".join(words for sort, words in _PLURALS.items() if sort in sorts)
        message = f"'{variable}' never has a value of that type, only {has}"
        hint = f"whether it has a value at all is asked with: bound {variable}"
        names.findings.add(Code.NOT_COMPARABLE, node, message, hint)


def _check_quotes(node: s.Stored, variable: VariableOf, value: Value, sorts: Sorts, names: Names) -> None:
    """Warn of a text that is compared with names, or of a name that is compared with texts."""
    sort = sort_of(value, names.agents)
    if (sort is ValueSort.TEXT) is not (ValueSort.TEXT in sorts) and not {sort, ValueSort.TEXT} <= sorts:
        has = " or ".join(words for each, words in _PLURALS.items() if each in sorts)
        message = (
            f"these are never equal: '{variable}' has only {has}, and {write(node.value)} is {sort.value}"
        )
        known = {*names.kinds, *names.agents}
        hint = unquoted(node.value, known) or requoted(value)
        names.findings.warn(Code.ALWAYS_THE_SAME, node, message, hint)
