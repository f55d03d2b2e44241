"""Dependence on the order of names: such a mission has no interchangeable names."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from checker.reduction.messages import Unknown, may_take
from semantics.behaviours.expressions import Apply, Literal
from semantics.behaviours.patterns import Exactly
from semantics.behaviours.statements import ChooseFrom, Display, For, ForEach, React, Send
from semantics.environment import Says
from semantics.state.configuration import Configuration
from semantics.state.setting import Scheduler


def ordered(c: Configuration) -> str | None:
    """Return why the order of names may matter to a mission's program; None where it doesn't."""
    program, environment = c.setting.program, c.setting.environment
    told = any(isinstance(each, Send) for each in program.statements)
    told |= any(isinstance(each, Says) for each in environment)
    unordered = c.setting.scheduler is Scheduler.UNORDERED
    for number, statement in enumerate(program.statements):
        line = (
            f" (line {program.lines[number]})"
            if number < len(program.lines) and program.lines[number]
            else ""
        )
        if isinstance(statement, For | ForEach):
            return f"a 'for' goes through names in their order{line}"
        if isinstance(statement, ChooseFrom):
            return f"where one alternative of 'choose' fails, those after it in the order of names are lost{line}"
        if isinstance(statement, Display) and not isinstance(statement.value, Literal):
            return f"'display' prints names{line}"
        if any(isinstance(each, Apply) and each.operator == "first" for each in parts(statement)):
            return f"'first' takes names in their order{line}"
        if isinstance(statement, React):
            guarded = [case for case in statement.cases if case.guard is not None]
            if any(unordered or (told and may_take(case.pattern, Unknown())) for case in guarded):
                return f"a guard is tried on messages in the order of names, and may fail{line}"
    return None


def parts(value: Any) -> Iterator[Any]:
    """Yield a statement and all expressions and patterns in it."""
    yield value
    if isinstance(value, tuple | frozenset):
        for each in value:
            yield from parts(each)
    elif is_dataclass(value) and not isinstance(value, Literal | Exactly):
        for member in fields(value):
            yield from parts(getattr(value, member.name))
