"""Differences: each part of a configuration, only what is new or gone, and nothing of what stayed."""

import pytest

from physical import box, circle, point
from semantics.behaviours.expressions import QueryOf
from semantics.behaviours.observations import All
from semantics.behaviours.program import Program
from semantics.behaviours.statements import Observe
from semantics.behaviours.values import Text
from semantics.environment import Says
from semantics.races.monitor import monitored
from semantics.state.agents import code_cell, host_cell, mailbox_cell, store_cell
from semantics.state.cell_values import AGENTS
from semantics.state.configuration import Configuration
from semantics.state.differences import PARTS, Difference, differences
from semantics.state.initial import initial
from semantics.state.physical_model import (
    Carried,
    InTransit,
    Placed,
    channels_cell,
    down_cell,
    placement_cell,
)
from semantics.state.requests import OBS, READY
from semantics.state.setting import Setting
from semantics.state.signature import Kind, Signature

KINDS = {"sea0": "Location", "shore0": "Location", "uav0": "UAV", "vessel0": "Vessel"}
SIGNATURE = Signature.of(
    [
        Kind("Location", frozenset({"UAV", "Vessel"})),
        Kind("UAV", driven=True),
        Kind("Vessel", carries=frozenset({"UAV"}), driven=True),
    ]
)
SAYS = Says(Text("go"), "a", 2, 0)


def start() -> Configuration:
    program = Program((Observe(QueryOf("ALL", None)),), {}, {}, (7,))
    setting = Setting(SIGNATURE, KINDS, program, (SAYS,))
    placements = {
        "sea0": Placed(box((37.0, -8.6), (36.9, -8.8))),
        "shore0": Placed(circle((37.2, -8.7), 900)),
        "uav0": Placed(point(37.2, -8.7)),
        "vessel0": Placed(point(36.95, -8.7)),
    }
    return initial(setting, placements, {"uav0": ("control:gcs0",)}, {"a": ("uav0", (0,))})


def told(changes):
    c = start()
    return [str(each) for each in differences(c, c.with_(changes))]


ALL = All()

CHANGES = {
    "what an agent is at": ({code_cell("a"): ()}, ["α  a ended"]),
    "where it is hosted": ({host_cell("a"): "vessel0"}, ["α  a hosted_at vessel0"]),
    "a new value": ({store_cell("a"): (("n#1", 3), ("#2", ()))}, ["α  a.n = 3"]),
    "mail": ({mailbox_cell("a"): (Text("go"), "go")}, ['α  mail of a: + "go"', "α  mail of a: + go"]),
    "a request": ({("line", "a"): (OBS("a", ALL),)}, ["η  + OBS(a, ALL)"]),
    "a place believed": ({("parent", "uav0"): "sea0"}, ["L  uav0 : shore0 ↦ sea0"]),
    "links believed": ({("links", "uav0"): ("mesh",)}, ["L  uav0 : − control:gcs0", "L  uav0 : + mesh"]),
    "channels": ({channels_cell("uav0"): ("control:gcs0", "mesh")}, ["P  uav0 : + mesh"]),
    "a channel down": ({down_cell("mesh"): True}, ["P  mesh drops"]),
    "what is absent": ({placement_cell("uav0"): None}, ["P  uav0 : in shore0 ↦ absent"]),
    "what is carried": (
        {placement_cell("uav0"): Carried("vessel0", Placed(point(36.95, -8.7)))},
        ["P  uav0 : in shore0 ↦ carried by vessel0"],
    ),
    "what may still be said": ({SAYS.counter: 1}, ["E  may still be said: 1"]),
    "who is there": ({AGENTS: ("a",)}, []),
}


@pytest.mark.parametrize("change", CHANGES)
def test_only_what_changed_is_told(change):
    changes, expected = CHANGES[change]
    assert told(changes) == expected


def test_what_is_on_its_way_is_told():
    c = start()
    flying = InTransit(c.structure.physical.placement("uav0"), "sea0")
    (found,) = differences(c, c.with_({placement_cell("uav0"): flying}))
    assert found == Difference("P", "uav0", "uav0 : in shore0 ↦ on the way to sea0")


def test_a_request_that_becomes_another_is_less_and_more():
    c = start().with_({("line", "a"): (OBS("a", ALL), OBS("a", ALL))})
    seen = c.with_({("line", "a"): (READY("a", ALL, "{}"), OBS("a", ALL))})
    assert [str(each) for each in differences(c, seen)] == ["η  − OBS(a, ALL)", "η  + READY(a, {})"]


def test_parts_come_in_one_order():
    changes = {key: value for given, _ in CHANGES.values() for key, value in given.items()}
    c = start()
    found = [each.part for each in differences(c, c.with_(changes))]
    assert found == sorted(found, key=PARTS.index)
    assert set(found) == set(PARTS)


def test_nothing_differs_from_itself_and_the_monitors_memory_is_no_difference():
    c = start()
    assert differences(c, c) == ()
    assert differences(monitored(c), monitored(c).with_({("watch", "agent", "a"): None})) == ()
