"""The tables for `bigraphs.notation.lalr`, extracted from lark."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lark import Lark
from lark.grammar import Rule, Terminal
from lark.lexer import BasicLexer, ContextualLexer, PatternStr, UnlessCallback
from lark.parsers.lalr_analysis import Shift

from bigraphs.notation.parse_tables import write_tables

__all__ = ["tables_of", "write_tables"]


def tables_of(parser: Lark) -> dict[str, Any]:
    """Return the tables of an LALR parser with a contextual lexer, as plain data."""
    table = parser.parser.parser._parse_table  # noqa: SLF001 - lark offers no other way
    contextual = parser.parser.lexer
    assert isinstance(contextual, ContextualLexer)
    rules = {rule: number for number, rule in enumerate(parser.rules)}
    lexers: dict[int, int] = {}
    of_lexers: list[Any] = []
    states = []
    for state in range(len(table.states)):
        lexer = contextual.lexers[state]
        assert isinstance(lexer, BasicLexer)
        if id(lexer) not in lexers:
            lexers[id(lexer)] = len(of_lexers)
            of_lexers.append(_lexer(lexer))
        row = {
            symbol: found if action is Shift else ~rules[found]
            for symbol, (action, found) in table.states[state].items()
        }
        states.append([lexers[id(lexer)], row])
    return {
        "terminals": {
            each.name: [True, each.pattern.value]
            if isinstance(each.pattern, PatternStr)
            else [False, each.pattern.to_regexp()]
            for each in parser.terminals
        },
        "ignored": sorted(parser.ignore_tokens),
        "lexers": of_lexers,
        "states": states,
        "reductions": [_reduction(rule) for rule in parser.rules],
        "starts": {
            start: [table.start_states[start], table.end_states[start]] for start in table.start_states
        },
    }


def _lexer(lexer: BasicLexer) -> tuple[list[str], dict[str, dict[str, str]]]:
    order = [terminal.name for terminal in lexer.scanner.terminals]
    words = {
        name: {terminal.pattern.value: terminal.name for terminal in callback.scanner.terminals}
        for name, callback in lexer.callback.items()
        if isinstance(callback, UnlessCallback)
    }
    return order, words


def _reduction(rule: Rule) -> tuple[str, int, str | None, bool, list[int | None]]:
    symbol = rule.origin.name
    method = rule.alias or (None if symbol.startswith("_") else symbol)
    single = rule.options.expand1 and not rule.alias
    return symbol, len(rule.expansion), method, single, list(_parts(rule))


def _parts(rule: Rule) -> Iterator[int | None]:
    """Yield the parts of a rule that its method receives, as in `Reduction`."""
    left_out = [
        len(ones) for ones in "".join(str(int(each)) for each in rule.options.empty_indices).split("0")
    ]
    left_out = left_out if rule.options.empty_indices else [0] * (len(rule.expansion) + 1)
    for number, symbol in enumerate(rule.expansion):
        yield from [None] * left_out[number]
        if not isinstance(symbol, Terminal):
            yield ~number if symbol.name.startswith("_") else number
        elif rule.options.keep_all_tokens or not symbol.filter_out:
            yield number
    yield from [None] * left_out[-1]
