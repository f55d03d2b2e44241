"""Meeting points: places to which a mission sends two vehicles, which then fly to one point.

Only missions with properties about ways are examined: others do not ask how near vehicles come.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial
from itertools import combinations
from typing import Final

from physical import EntityMotion
from semantics.properties.property import Property, region_atoms
from semantics.properties.propositions import is_variable
from semantics.properties.region_atoms import ApartFrom, operands
from semantics.regions.region_facts import RegionFacts
from semantics.regions.suspicions import MayMeet, SuspectedWay, Suspicion
from semantics.state.setting import Setting
from semantics.state.signature import Name
from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import Diagnostic
from specs.elaboration.names import Names
from specs.elaboration.suspicion_warnings import SuspicionWarning

MOST_PAIRS: Final = 50
"""The most pairs of vehicles that are examined."""


def suspected_meeting_points(
    setting: Setting, facts: RegionFacts, properties: Iterable[Property], names: Names
) -> Iterator[SuspicionWarning]:
    """Yield a warning for each two vehicles sent to one point, where neither an altitude nor a property parts them."""
    parted = [operands(atom) for atom in region_atoms(properties) if isinstance(atom, ApartFrom)]
    for one, other in combinations(sorted(_vehicles(setting, facts)), 2):
        shared = sorted(facts.motions[one].targets & facts.motions[other].targets)
        if not shared or any(_parts(pair, one, other) for pair in parted):
            continue
        if _may_be_level(facts.motions[one], facts.motions[other]):
            suspicion, warning = MayMeet(one, other), partial(_warning, names.spans["entity", other])
            text = warning(suspicion, SuspectedWay(one, "", shared[0]))
            yield SuspicionWarning((suspicion,), text, warning)


def _warning(where: s.Span, suspicion: Suspicion, way: SuspectedWay) -> Diagnostic:
    one, other = suspicion.pair
    message = f"'{one}' and '{other}' may be sent to one point in {way.to}, and nothing parts them"
    hint = f"ask for it: {one} at least 50 m from {other}; or give each its own altitudes"
    return Diagnostic(Code.ONE_POINT, where, message, hint)


def _vehicles(setting: Setting, facts: RegionFacts) -> Iterator[Name]:
    return (name for name in facts.motions if setting.signature[setting.kind(name)].driven)


def _parts(pair: tuple[Name, Name], one: Name, other: Name) -> bool:
    """Whether a property about a pair, which may be quantified, is about these two."""
    first, second = pair
    return any(
        all(is_variable(asked) or asked == name for asked, name in ((first, a), (second, b)))
        for a, b in ((one, other), (other, one))
    )


def _may_be_level(one: EntityMotion, other: EntityMotion) -> bool:
    """Whether two vehicles may be at one altitude."""
    bands = [[form.altitude for form in motion.forms] for motion in (one, other)]
    return any(
        a is None or b is None or (a.low <= b.high and b.low <= a.high) for a in bands[0] for b in bands[1]
    )
