"""`bigactors.check`: of a mission by its file, too."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, TypeAlias

from checker import Limits, Report
from checker.check import Checkable
from checker.check import check as check_properties
from semantics import Configuration, Property

Start: TypeAlias = Configuration | Checkable | str | Path


def check(
    start: Start,
    properties: Iterable[Property] | None = None,
    limits: Limits | None = None,
    **options: Any,
) -> Report:
    """Explore everything that is reachable and decide the properties.

    Args:
        start: A mission; the path of its file, or the name of one that ships; or a configuration to start from.
        properties: What is to be decided; what the mission asks where it is left out.
        limits: Where to stop.
        options: Those of `checker.check`: `report`, `notes`, `engine`, `violations`, `reduce`, `keeping`, `cluster`,
            `threads` and `times`.

    Raises:
        MissionError: The file cannot be read, or has mistakes; all of them.
        RefusedError: A reduction is unsound for the mission, or nothing in it allows one.
        TypeError: A configuration is given without properties.
    """
    if isinstance(start, str | Path):
        from specs.elaboration import load_mission  # noqa: PLC0415 - who has a mission has read it

        start = load_mission(start)
    return check_properties(start, properties, limits, **options)
