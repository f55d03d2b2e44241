"""The check phase: scheduler, control, and properties."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Final, TypeVar

from semantics.properties.kinds import PropertyKind, RequestMode, asked_by
from semantics.properties.property import Property
from semantics.state.setting import Control, Scheduler
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.bodies import Bodies
from specs.elaboration.distances import RegionContext
from specs.elaboration.formulas import FormulaElaborator
from specs.elaboration.names import Names
from specs.elaboration.temporal import TemporalFormulas
from specs.elaboration.timing import TickConversion
from specs.elaboration.value_types import Types

_COMMENT: Final = re.compile(r"(?://|#)[^\n]*")

D = TypeVar("D", bound=s.Node)


def elaborate_scheduler(mission: s.Mission, names: Names) -> Scheduler:
    """Return the scheduler; the default is `program_order`."""
    named = _only(mission.each(s.Scheduler), "scheduler", names)
    return Scheduler(named.name) if named is not None else Scheduler.PROGRAM_ORDER


def elaborate_control(mission: s.Mission, names: Names) -> Control:
    """Return the kind of control; the default is `atomic`."""
    named = _only(mission.each(s.ControlMode), "control", names)
    return Control(named.name) if named is not None else Control.ATOMIC


def _of_time(
    item: s.Deadline | s.FirstTime, formulas: FormulaElaborator, ticks: TickConversion | None, line: int
) -> Property:
    formula, then = item.formula, None
    if isinstance(item, s.FirstTime):
        kind, bound = PropertyKind.TIME, 0
    else:
        kind, bound = PropertyKind.WITHIN, 0 if ticks is None else ticks.count(item.limit)
        if isinstance(formula, s.LeadsTo):
            then = formulas.elaborate(formula.right, invariant=False)
            formula = formula.left
    proposition = formulas.elaborate(formula, invariant=False)
    return Property(kind, item.label.value, proposition, line, bound=bound, then=then)


def _check_timed(item: s.Property, prop: Property, names: Names, *, is_timed: bool) -> None:
    """Report a property of time in a mission without `timing`, and an untimed property of runs in a mission with it."""
    if is_timed and prop.is_of_runs:
        word = item.logic if isinstance(item, s.TemporalProperty) else prop.kind.value
        message = f"'{word}' is about runs without times, and this mission has a section 'timing'"
        hint = 'ask for a bounded response: within 5 min "answered": F leads to G; or leave timing out'
        names.findings.add(Code.UNTIMED_PROPERTY, item, message, hint)
    if not is_timed and prop.kind.is_of_time:
        message = f"'{prop.kind.value}' asks for times, and the mission has no durations"
        names.findings.add(Code.NO_TIMING, item, message, "give the mission a section: timing { ... }")


def _only(named: tuple[D, ...], word: str, names: Names) -> D | None:
    for again in named[1:]:
        names.findings.add(
            Code.REPEATED_SETTING, again, f"'{word}' is written twice", "leave one of the two out"
        )
    return named[0] if named else None


def _written(item: s.Property, text: str) -> str:
    """Return the formula of a property as its author wrote it, on one line; empty if it has none."""
    if not isinstance(item, s.Invariant | s.Reachable | s.TemporalProperty | s.Deadline | s.FirstTime):
        return ""
    fairness = item.fairness if isinstance(item, s.TemporalProperty) else ()
    before, end = fairness[-1].span.end if fairness else item.label.span.end, item.span.end
    while text.count("(", before, end) > text.count(")", before, end) and ")" in text[end:]:
        end = text.index(")", end) + 1  # include the closing bracket
    return " ".join(_COMMENT.sub("", text[before:end]).partition(":")[2].split())


def elaborate_checks(
    mission: s.Mission,
    names: Names,
    bodies: Bodies,
    types: Types,
    ticks: TickConversion | None,
    ways: RegionContext,
) -> tuple[Property, ...]:
    """Return the properties in written order, or the default ones, followed by those that are always checked.

    `ticks` is None in a mission without `timing`.
    """
    written = [item for section in mission.each(s.Check) for item in section.properties]
    formulas, found = (
        FormulaElaborator(names, bodies, types, ways, is_timed=ticks is not None),
        list[Property](),
    )
    always = tuple(Property(kind, kind.value) for kind in asked_by(RequestMode.ALWAYS))
    seen = {prop.name for prop in always}
    temporal = TemporalFormulas(formulas)
    for item in written:
        line = names.findings.source.line(item.span.start)
        formulas.ranges.clear()
        if isinstance(item, s.StandardProperty):
            prop = Property(PropertyKind(item.name), item.name, line=line)
        elif isinstance(item, s.TemporalProperty | s.Progress | s.FairDeadlockFreedom):
            prop = temporal.property(item, line)
        elif isinstance(item, s.Deadline | s.FirstTime):
            prop = _of_time(item, formulas, ticks, line)
        else:
            invariant = isinstance(item, s.Invariant)
            kind = PropertyKind.INVARIANT if invariant else PropertyKind.REACHABLE
            formula = formulas.elaborate(item.formula, invariant=invariant)
            prop = Property(kind, item.label.value, formula, line)
        _check_timed(item, prop, names, is_timed=ticks is not None)
        if prop.name in seen:
            names.findings.add(
                Code.REPEATED_SETTING, item, f"a property '{prop.name}' is asked for twice", "rename one"
            )
        seen.add(prop.name)
        text = _written(item, names.findings.source.text)
        found.append(replace(prop, ranges=tuple(sorted(formulas.ranges)), written=text))
    usual = [Property(kind, kind.value) for kind in asked_by(RequestMode.BY_DEFAULT)]
    return (*(found or usual), *always)
