"""`bigactors.check`: `checker.check`, which also takes a mission's file or name."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeAlias

from checker import Limits, Report
from checker.check import Checkable
from checker.check import check as check_properties
from semantics import Configuration, Property
from specs.syntax import Mission

Start: TypeAlias = Configuration | Checkable | Mission | str | Path


def check(
    start: Start,
    properties: Iterable[Property] | None = None,
    limits: Limits | None = None,
    **options: Any,
) -> Report:
    """Explore all reachable configurations and decide the properties.

    Args:
        start: A mission, or its syntax tree; the path of its file, or the name of one that ships; or a configuration.
        properties: The properties to decide; by default the mission's.
        limits: The bounds of the exploration.
        options: Those of `checker.check`: `report`, `notes`, `engine`, `violations`, `reduce`, `keeping`, `cluster`,
            `threads`, `clock`, `times`, `ways` and `suspected`.

    Raises:
        MissionError: The file cannot be read or has mistakes; the error has all of them.
        RefusedError: A reduction is unsound for the mission, or nothing in it allows one.
        TypeError: A configuration is given without properties.
    """
    if isinstance(start, str | Path | Mission):
        from specs.elaboration import load_mission, read_mission  # noqa: PLC0415 - not for an elaborated mission

        start = read_mission(start) if isinstance(start, Mission) else load_mission(start)
    return check_properties(start, properties, limits, **options)
