"""Elaboration: from a mission's syntax tree to its meaning, phase by phase, reporting all mistakes at once.

Each phase is a module, in this order: signature, world (with files and geometry), environment (with drifts), beliefs,
rules, bodies (with statements, expressions and patterns), controls, checks. It does not depend on exploration.
"""

from specs.elaboration.mission import (
    Diagnosis,
    ElaboratedMission,
    diagnose,
    elaborate,
    files_named,
    find_mission,
    load_mission,
    read_mission,
    require_bigactor,
)
from specs.elaboration.variation import Variation

__all__ = [
    "Diagnosis",
    "ElaboratedMission",
    "Variation",
    "diagnose",
    "elaborate",
    "files_named",
    "find_mission",
    "load_mission",
    "read_mission",
    "require_bigactor",
]
