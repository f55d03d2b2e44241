"""The assumptions about ways on which a verdict rests: how far each vehicle may be from its way."""

from collections.abc import Iterator

from physical import EntityMotion
from semantics.state.setting import Setting
from semantics.state.signature import Name

MOST_NAMES = 5
"""The most vehicles that a note names."""


def assumed_ways(setting: Setting) -> Iterator[str]:
    """Yield the assumptions of a mission whose properties ask for regions, in words; vehicles with one are together."""
    if setting.regions is None:
        return
    vehicles: dict[str, list[Name]] = {}
    for name, motion in setting.regions.motions.items():
        if motion.targets and setting.signature[setting.kind(name)].driven:
            vehicles.setdefault(_assumption(motion), []).append(name)
    for assumption, names in vehicles.items():
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        yield f"ways assume of {', '.join(names[:MOST_NAMES])}{more}: {assumption}"


def _assumption(motion: EntityMotion) -> str:
    if motion.strays is not None:
        return (
            f"it strays at most {motion.strays:g} m from the lines between its waypoints, as the mission says"
        )
    if motion.circle:
        return f"it strays at most {motion.circle:g} m, the diameter of its circles; a way is as wide as its places"
    return "it strays at most 0 m, since the mission does not say; a way is as wide as its places"
