"""Misses: the entities that an observation may leave out although they are there."""

from __future__ import annotations

from typing import Final

from specs import syntax as s
from specs.codes import Code
from specs.elaboration.names import Names
from specs.elaboration.vehicles import entities_of

MOST: Final = 8
"""The most entities that observations may miss: one observation has at most 2⁸ answers."""


def elaborate_misses(mission: s.Mission, names: Names) -> tuple[str, ...]:
    """Return the entities that an observation may miss, sorted."""
    sections = mission.each(s.Environment)
    clauses = (each for section in sections for each in section.clauses if isinstance(each, s.Misses))
    found: set[str] = set()
    seen: set[str] = set()
    for name in (name for clause in clauses for name in clause.entities):
        if name.text in seen:
            message = f"observe may miss '{name.text}' is written twice"
            names.findings.add(Code.REPEATED_SETTING, name, message, "leave one of the two out")
        elif name.text in names.kinds or name.text in names.signature.kinds:
            before = len(found)
            found.update(entities_of(names, name))
            if before <= MOST < len(found):
                message = f"observations may miss {len(found)} entities; at most {MOST} can be missed"
                hint = "name the entities that matter, or declare fewer"
                names.findings.add(Code.TOO_MANY_MISSED, name, message, hint)
        else:
            known = [*names.signature.kinds, *names.kinds]
            names.findings.unknown(name, known, sort="entity or kind", otherwise="declare it in the world")
        seen.add(name.text)
    return tuple(sorted(found))
