"""A mission of two places, a UAV, a station and a vessel with its drifter, and one run of it."""

from pathlib import Path

from checker import Trace
from checker.steps import candidates
from physical import box, circle, point
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Host, Literal, QueryOf
from semantics.behaviours.patterns import Anything
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Case, ControlBy, Observe, React
from semantics.state.initial import initial
from semantics.state.physical_model import Carried, Placed
from semantics.state.setting import Control, Setting
from semantics.state.signature import Kind, Signature
from semantics.successors import successors
from specs import Source
from specs.elaboration import elaborate
from specs.parser import parse

MOVERS = frozenset({"OilSpill", "UAV", "Vessel", "Station", "Drifter"})
SIGNATURE = Signature.of(
    [
        Kind("Location", MOVERS),
        Kind("OilSpill", frozenset({"UAV"})),
        Kind("UAV", driven=True),
        Kind("Vessel", carries=frozenset({"Drifter"}), driven=True),
    ]
)
KINDS = {
    "searchArea0": "Location",
    "oilSpill0": "OilSpill",
    "uav0": "UAV",
    "gcs0": "Station",
    "vessel0": "Vessel",
    "drifter0": "Drifter",
}
PLACEMENTS = {
    "searchArea0": Placed(box((37.04, -8.59), (36.94, -8.79))),
    "oilSpill0": Placed(circle((37.00, -8.70), 400)),
    "uav0": Placed(point(37.06, -8.55)),
    "gcs0": Placed(point(37.07, -8.60)),
    "vessel0": Placed(point(36.98, -8.66)),
    "drifter0": Carried("vessel0", Placed(point(36.98, -8.66))),
}
CHANNELS = {"uav0": ("control:gcs0",), "gcs0": ("control:gcs0", "network"), "vessel0": ("network",)}
STATEMENTS = (
    ControlBy("MOVE_HOST_TO", (Literal("searchArea0"),)),
    Observe(QueryOf("CHILDREN", QueryOf("PARENT", Host()))),
    React((Case(Anything("seen", "observation"), None, ()),)),
)


def oil_spill(**changes):
    placements = changes.pop("placements", PLACEMENTS)
    beliefs = changes.pop("beliefs", None)
    program = Program(STATEMENTS, {}, COMMANDS, (12, 13, 14))
    setting = Setting(SIGNATURE, KINDS, program, control=Control.TIMED, **changes)
    return initial(setting, placements, CHANNELS, {"searcher": ("uav0", (0, 1, 2))}, beliefs)


def run(configuration):
    configurations, labels = [configuration], []
    while following := list(successors(configurations[-1])):
        labels.append(following[0].label)
        configurations.append(following[0].target)
    return configurations, labels


OBSERVING = """
mission observing
signature { kind Place contains Craft kind Craft driven }
world { a: Place = box (37.1, -8.5) (37.0, -8.6) u: Craft = point (37.05, -8.55) }
BigActor w hosted_at u with_behavior { while true { observe(CHILDREN(a)) react { case seen => skip } } }
"""


def observing(rounds):
    """Return a flight in which an agent observes so many times, four steps each."""
    source = Source("observing", OBSERVING)
    trace = Trace(elaborate(parse(source), source, Path()).initial)
    for _ in range(16):
        trace = trace.extended(candidates(trace.configurations[-1])[0])
    assert trace.steps[-1].target == trace.steps[-5].target
    return Trace(trace.initial, trace.steps + trace.steps[-4:] * (rounds - 4))
