"""Logical-space programming: the public names of all packages, in one import.

    import bigactors

    mission = bigactors.load_mission("oil_spill.mission")
    report = bigactors.check(mission.initial, mission.properties)

Each name has one home, which is loaded when the name is first used: importing this package loads nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from bigactors.pictures import draw_configuration as draw_configuration
    from bigactors.pictures import draw_trace as draw_trace
    from checker import Exploration as Exploration
    from checker import Limits as Limits
    from checker import Outcome as Outcome
    from checker import Progress as Progress
    from checker import ReplayError as ReplayError
    from checker import Report as Report
    from checker import Step as Step
    from checker import Trace as Trace
    from checker import Verdict as Verdict
    from checker import Violation as Violation
    from checker import check as check
    from checker import explore as explore
    from checker import owned as owned
    from checker import print_trace as print_trace
    from checker import replay as replay
    from checker import report_json as report_json
    from checker import report_text as report_text
    from checker import to_json as to_json
    from physical import PhysicalProperty as PhysicalProperty
    from physical import read_geojson as read_geojson
    from physical import write_geojson as write_geojson
    from physical.ais_recording import read_recording as read_recording
    from physical.ais_world import world_at as world_at
    from semantics import Configuration as Configuration
    from semantics import Control as Control
    from semantics import Fault as Fault
    from semantics import Label as Label
    from semantics import Property as Property
    from semantics import Scheduler as Scheduler
    from semantics import Setting as Setting
    from semantics import Transition as Transition
    from semantics import expand as expand
    from semantics import holds as holds
    from semantics import initial as initial
    from semantics import monitored as monitored
    from semantics import successors as successors
    from semantics.state.printing import print_changes as print_changes
    from semantics.state.printing import print_configuration as print_configuration
    from specs import Diagnostic as Diagnostic
    from specs import MissionError as MissionError
    from specs import format_mission as format_mission
    from specs.elaboration import ElaboratedMission as ElaboratedMission
    from specs.elaboration import load_mission as load_mission

__version__ = "0.1.0"

HOMES: Final = {
    "bigactors.pictures": ("draw_configuration", "draw_trace"),
    "checker": (
        "Exploration", "Limits", "Outcome", "Progress", "ReplayError", "Report", "Step", "Trace", "Verdict",
        "Violation", "check", "explore", "owned", "print_trace", "replay", "report_json", "report_text", "to_json",
    ),
    "physical": ("PhysicalProperty", "read_geojson", "write_geojson"),
    "physical.ais_recording": ("read_recording",),
    "physical.ais_world": ("world_at",),
    "semantics": (
        "Configuration", "Control", "Fault", "Label", "Property", "Scheduler", "Setting", "Transition", "expand",
        "holds", "initial", "monitored", "successors",
    ),
    "semantics.state.printing": ("print_changes", "print_configuration"),
    "specs": ("Diagnostic", "MissionError", "format_mission"),
    "specs.elaboration": ("ElaboratedMission", "load_mission"),
}  # fmt: skip
"""Where each public name lives."""

_HOME: Final = {name: home for home, names in HOMES.items() for name in names}

__all__ = sorted(_HOME)  # noqa: PLE0605 - a sorted list of the names above


def __getattr__(name: str) -> Any:
    """Return a public name from its home."""
    if name not in _HOME:
        raise AttributeError(f"module 'bigactors' has no attribute '{name}'")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
