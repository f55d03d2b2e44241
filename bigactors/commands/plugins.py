"""`bigactors plugins`: the possible values of --vehicle, --feed and --detector."""

from __future__ import annotations

from argparse import Namespace
from typing import TYPE_CHECKING, Final

from bigactors import __version__
from bigactors.exits import Exit
from bigactors.terminal import say

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

DESCRIPTION: Final = """\
List the forms of --vehicle, --feed and --detector: each with its package, the version, and the summary of the
package. No plugin is loaded."""

EXAMPLES: Final = ("bigactors plugins",)

ARGUMENTS: Final = ""


OURS: tuple[tuple[str, str], ...] = (
    ("--vehicle NAME=udp:[HOST:]PORT", "a vehicle that speaks MAVLink, by datagrams sent to this machine"),
    ("--vehicle NAME=udpout:HOST:PORT", "a vehicle that speaks MAVLink, by datagrams sent to it"),
    ("--vehicle NAME=tcp:HOST:PORT", "a vehicle that speaks MAVLink, by a connection to it"),
    ("--vehicle NAME=tcpin:[HOST:]PORT", "a vehicle that speaks MAVLink, by a connection from it"),
    ("--vehicle NAME=serial:DEVICE[:BAUD]", "a vehicle that speaks MAVLink, by a serial line"),
    ("--vehicle NAME=ros:tcp:HOST:PORT", "a robot of ROS 2, by the Zenoh router of rmw_zenoh"),
    (
        "--vehicle NAME=simulated:KIND",
        "a simulated plane, copter, rover, boat, px4-plane or px4-copter",
    ),
    ("--feed ais=ADDRESS", "vessels, by AIS"),
    ("--feed detections=http:[HOST:]PORT", "detections of others, by HTTP, or folder:PATH"),
    ("--feed locations=URL", "positions from a location service"),
    ("--feed places=FILE", "a file of places, and its changes"),
    ("--feed ros=ADDRESS", "positions on topics of ROS 2, by Zenoh"),
)


def run(_options: Namespace) -> Exit:
    """Print one line for each plugin."""
    from bigactors.installed_plugins import DETECTORS, FEEDS, VEHICLES

    rows = [(form, f"bigactors {__version__}", does) for form, does in OURS]
    rows += _theirs("--vehicle NAME={}:ADDRESS", VEHICLES)
    rows += _theirs("--feed {}=ADDRESS", FEEDS)
    rows += _theirs("--detector {}", DETECTORS)
    widths = [max(len(row[column]) for row in rows) for column in (0, 1)]
    for form, package, summary in rows:
        say(f"{form:<{widths[0]}}  {package:<{widths[1]}}  {summary}".rstrip())
    return Exit.HOLDS


def _theirs(form: str, group: str) -> list[tuple[str, str, str]]:
    from bigactors.installed_plugins import installed, package_of

    return [(form.format(each.name), package_of(each), _summary(each)) for each in installed(group)]


def _summary(entry: EntryPoint) -> str:
    """Return a package's own summary in one line."""
    from physical.untrusted_text import legible

    told = {} if entry.dist is None else entry.dist.metadata.json
    return legible(str(told.get("summary", "")).partition("\n")[0])
