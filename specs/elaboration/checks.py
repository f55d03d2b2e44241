"""The check phase: scheduler, control, and properties."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from semantics.properties.kinds import Asked, PropertyKind, asked_by
from semantics.properties.property import Property
from semantics.state.setting import Control, Scheduler
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.bodies import Bodies
from specs.elaboration.formulas import Formulas
from specs.elaboration.names import Names
from specs.elaboration.temporal import TemporalFormulas
from specs.elaboration.value_types import Types

D = TypeVar("D", bound=s.Node)


def elaborate_scheduler(mission: s.Mission, names: Names) -> Scheduler:
    """Return the scheduler, `program_order` where none is named."""
    named = _only(mission.each(s.Scheduler), "scheduler", names)
    return Scheduler(named.name) if named is not None else Scheduler.PROGRAM_ORDER


def elaborate_control(mission: s.Mission, names: Names) -> Control:
    """Return whether control takes time, `atomic` where it isn't said."""
    named = _only(mission.each(s.ControlMode), "control", names)
    return Control(named.name) if named is not None else Control.ATOMIC


def _only(named: tuple[D, ...], word: str, names: Names) -> D | None:
    for again in named[1:]:
        names.findings.add(
            Code.REPEATED_SETTING, again, f"'{word}' is said twice", "leave one of the two out"
        )
    return named[0] if named else None


def elaborate_checks(mission: s.Mission, names: Names, bodies: Bodies, types: Types) -> tuple[Property, ...]:
    """Return the properties in the order written, or those of the default, and those that go without saying."""
    written = [item for section in mission.each(s.Check) for item in section.properties]
    formulas, found = Formulas(names, bodies, types), list[Property]()
    always = tuple(Property(kind, kind.value) for kind in asked_by(Asked.ALWAYS))
    seen = {prop.name for prop in always}
    temporal = TemporalFormulas(formulas)
    for item in written:
        line = names.findings.source.line(item.span.start)
        formulas.ranges.clear()
        if isinstance(item, s.StandardProperty):
            prop = Property(PropertyKind(item.name), item.name, line=line)
        elif isinstance(item, s.TemporalProperty | s.Progress | s.FairDeadlockFreedom):
            prop = temporal.property(item, line)
        else:
            invariant = isinstance(item, s.Invariant)
            kind = PropertyKind.INVARIANT if invariant else PropertyKind.REACHABLE
            formula = formulas.elaborate(item.formula, invariant=invariant)
            prop = Property(kind, item.label.value, formula, line)
        if prop.name in seen:
            names.findings.add(
                Code.REPEATED_SETTING, item, f"a property '{prop.name}' is asked for twice", "rename one"
            )
        seen.add(prop.name)
        found.append(replace(prop, ranges=tuple(sorted(formulas.ranges))))
    usual = [Property(kind, kind.value) for kind in asked_by(Asked.BY_DEFAULT)]
    return (*(found or usual), *always)
