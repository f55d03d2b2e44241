"""A station believes of a peer's parcel only what the text of its own mission can have produced."""

import json
from itertools import islice
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import IS_WHOLE, examples

from semantics.admission.parcel_refusals import text_objection
from semantics.analysis.value_flow import flow_of
from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.expressions import Fault
from semantics.behaviours.values import Text
from semantics.state.parcel_serialization import parcel_json, parcel_of
from semantics.state.requests import CTR, MGR, OBS, READY, SND
from semantics.state.setting import Control, Scheduler
from semantics.state.station_partition import (
    Parting,
    enter,
    is_here,
    leave,
    objection,
    parted,
    sent_cell,
    station_of,
)
from semantics.state.station_partition import parcel_of as parcel_here
from semantics.successors import moves, served, successors
from specs.diagnostics import Source
from specs.elaboration import Variation, elaborate, load_mission
from specs.parser import parse

TEXT = """
signature {
  kind Location contains UAV, Station
  kind UAV driven
  kind Station
}
world {
  west0: Location = box (37.10, -8.70) (37.00, -8.80)
  east0: Location = box (37.10, -8.50) (37.00, -8.60)
  danger0: Location = box (37.10, -8.30) (37.00, -8.40)
  gcs0: Station = point (37.05, -8.55) linked internet, control:gcs0
  gcs1: Station = point (37.06, -8.56) linked internet, control:gcs1
  uav0: UAV = point (37.05, -8.75) linked internet, control:gcs1
}
rule lift(u: UAV) { west0.(u | $0) || east0.$1 -> west0.$0 || east0.(u | $1) }
def patrol(times) = {
  observe(CHILDREN(west0))
  migrate(uav0)
  react { case view => for place in {west0, east0} { control(MOVE_HOST_TO place) } }
  send ("round", times, [west0, east0]) to op0
  migrate(gcs0)
}
BigActor scout hosted_at gcs0 with_behavior {
  send "begun" to op0
  let n = 0
  loop { patrol(n)
         n = n + 1
         react { case ("more", place) => display(place) } } }
BigActor op0 hosted_at gcs0 with_behavior {
  loop { react { case "begun" => display("begun")
                 case ("round", n, route) => send ("more", west0) to scout } } }
environment { says ("more", east0) to scout at most 1 times }
check { invariant "never there": not uav0 in danger0 }
"""
SHIPPED = sorted(path.stem for path in (Path(__file__).parents[3] / "specs" / "missions").glob("*.mission"))
STATIONS = {"gcs0": "gcs0", "gcs1": "gcs1", "uav0": "gcs1"}
SAFE = {"west0", "east0"}


def mission():
    source = Source("admission.mission", TEXT)
    return elaborate(parse(source), source, Path(), Variation(Scheduler.FCFS, Control.TIMED)).initial


FIRST = mission()


def part(name):
    return parted(FIRST, Parting(name, STATIONS, {}, {}))


def travels(draw=None, steps=400):
    """Yield what leaves while two stations go on: sender, receiver as it was then, number, parcel as plain data."""
    parts = {name: part(name) for name in ("gcs0", "gcs1")}
    for turn in range(steps):
        ways = []
        for name, c in parts.items():
            for a in c.alpha.names():
                if is_here(c, a):
                    ways += [(name, step) for step in (*served(c, a), *moves(c, a))]
        if not ways:
            return
        name, step = ways[turn * 7919 % len(ways)] if draw is None else draw(st.sampled_from(ways))
        parts[name] = step.target
        for a in parts[name].alpha.names():
            for left in leave(parts[name], a):
                to = station_of(parts[name], a)
                number = left.target.read(sent_cell(to))
                plain = json.loads(json.dumps(parcel_json(parcel_here(parts[name], a))))
                parts[name] = left.target
                yield name, parts[to], number, plain
                (entered,) = enter(parts[to], name, number, parcel_of(plain))
                parts[to] = entered.target


TRAVELS = list(islice(travels(), 40))
VALUES = st.sampled_from(
    [
        *(
            "danger0",
            "west0",
            "uav0",
            "gcs0",
            "gcs1",
            "scout",
            "op0",
            "more",
            "",
            "HAND",
            "MOVE_HOST_TO",
            "lift",
        ),
        *(0, 1, 5, 10**17, -1, None, [], {}, True),
        {"set": ["danger0"]},
        {"Controls": ["scout", "MOVE_HOST_TO", "uav0", ["danger0"]]},
        {"Controls": ["scout", "MOVE_HOST_TO", "uav0", ["west0"]]},
        {"CTR": ["scout", {"Reaction": ["MOVE_HOST_TO west0", {}, {}, []]}]},
        {"MGR": ["scout", "gcs1"]},
        {"text": "more"},
        {"text": "west0"},
        {"SND": ["scout", "op0", {"text": "hello"}]},
    ]
)


def places(data, path=()):
    """Yield the path of every part of plain data."""
    yield path
    parts = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, each in parts:
        yield from places(each, (*path, key))


def changed(data, path, how, value):
    """Return plain data with one part replaced, doubled or left out."""
    if not path:
        return value if how == "replace" else data
    key, rest = path[0], path[1:]
    if isinstance(data, dict):
        return {each: changed(part, rest, how, value) if each == key else part for each, part in data.items()}
    if rest or how == "replace":
        return [*data[:key], changed(data[key], rest, how, value), *data[key + 1 :]]
    middle = {"double": [data[key], data[key]], "drop": [], "add": [data[key], value]}[how]
    return [*data[:key], *middle, *data[key + 1 :]]


def is_of_the_text(request):
    """Tell whether a request is an instance of a statement of `TEXT`, as a reader of it would say."""
    match request:
        case CTR(_, reaction):
            make = FIRST.setting.program.reactions["MOVE_HOST_TO"]
            return any(reaction == make(host, place) for host in ("gcs0", "uav0") for place in SAFE)
        case OBS(_, query) | READY(_, query, _):
            return str(query) == "CHILDREN(west0)"
        case SND(_, to, (Text("round"), int(), route)):
            return to == "op0" and route.stops == ("west0", "east0")
        case SND(_, "op0", Text("begun")):
            return True
        case SND(_, to, message):
            return to == "scout" and message == (Text("more"), "west0")
        case MGR(_, host):
            return host in ("uav0", "gcs0")
    return False


def go_on(c, steps=12):
    """Let a configuration go on: nothing but a mission's own mistakes may end a run."""
    for _ in range(steps):
        try:
            found = list(successors(c))
        except Fault:
            return
        for step in found:
            assert "MOVE_HOST_TO danger0" not in str(step.label)
        if not found:
            return
        c = found[-1].target


@examples(90)
@given(st.data())
def test_every_parcel_that_enters_asks_for_what_the_program_asks_for(data):
    sender, there, number, plain = data.draw(st.sampled_from(TRAVELS))
    for _ in range(data.draw(st.integers(1, 3))):
        path = data.draw(st.sampled_from(list(places(plain))))
        how = data.draw(st.sampled_from(["replace", "replace", "double", "drop", "add"]))
        plain = changed(plain, path, how, data.draw(VALUES))
    try:
        parcel = parcel_of(plain)
    except ValueError:
        return
    for step in enter(there, sender, number, parcel):
        assert all(is_of_the_text(pending.request) for pending in step.target.eta.all())
        assert "danger0" not in str(step.target.alpha.store("scout"))
        go_on(step.target)


@examples(60)
@given(st.data())
def test_whatever_an_honest_station_sends_enters(data):
    assert sum(1 for _ in travels(data.draw, steps=60)) >= 0  # each is taken in on its way


def arrival():
    """Return a parcel that brings the scout to its vehicle, as plain data."""
    return next(each for each in TRAVELS if each[3]["Parcel"][2] is not None and each[0] == "gcs0")


def forged(**changes):
    sender, there, number, plain = arrival()
    running = dict(
        zip(("host", "code", "store", "requests", "says"), plain["Parcel"][2]["Running"], strict=True)
    )
    running |= changes
    return there, sender, number, parcel_of({"Parcel": ["scout", [], {"Running": list(running.values())}]})


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"requests": [{"Controls": ["scout", "MOVE_HOST_TO", "uav0", ["danger0"]]}]}, "no statement that"),
        (
            {"requests": [{"Controls": ["scout", "MOVE_HOST_TO", "uav0", ["east0", "danger0"]]}]},
            "no statement",
        ),
        ({"requests": [{"Controls": ["scout", "lift", "uav0", ["uav0"]]}]}, "no statement that"),
        ({"requests": [{"Controls": ["op0", "MOVE_HOST_TO", "uav0", ["east0"]]}]}, "another agent"),
        ({"requests": [{"MGR": ["scout", "danger0"]}]}, "no statement that"),
        (
            {"requests": [{"SND": ["scout", "op0", [{"text": "round"}, 1, {"route": ["danger0"]}]]}]},
            "no statement that",
        ),
        ({"host": "gcs0"}, "does not run the bigActors on gcs0"),
        ({"host": "gcs1"}, "it never goes to gcs1"),
        ({"code": [0, 0]}, "its remaining program"),
        ({"code": [-1]}, "its remaining program"),
        ({"store": []}, "its variables differ"),
        ({"store": [["n", "danger0"]]}, "its variable"),
        ({"says": [2]}, "its counts of `says`"),
    ],
)
def test_what_the_text_cannot_have_produced_is_refused(changes, why):
    there, sender, number, parcel = forged(**changes)
    if changes.get("store"):
        name = arrival()[3]["Parcel"][2]["Running"][2][0][0]
        there, sender, number, parcel = forged(store=[[name, "danger0"]])
    assert why in objection(there, parcel)
    assert list(enter(there, sender, number, parcel)) == []


def test_what_a_statement_outside_of_all_loops_asks_for_comes_once():
    begun = {"SND": ["scout", "op0", {"text": "begun"}]}
    assert objection(forged(requests=[begun])[0], forged(requests=[begun])[3]) == ""
    there, *_, parcel = forged(requests=[begun, begun])
    assert objection(there, parcel) == "it has more requests than its statements make"


def test_what_a_statement_that_is_still_to_come_asks_for_does_not_enter():
    begun = {"SND": ["scout", "op0", {"text": "begun"}]}
    start = list(FIRST.alpha.code("scout"))
    there, *_, parcel = forged(requests=[begun], code=start, store=[])
    assert "no statement that it has passed" in objection(there, parcel)


@pytest.mark.parametrize("name", SHIPPED)
def test_every_configuration_of_a_shipped_mission_can_be_sent(name):
    path = Path(__file__).parents[3] / "specs" / "missions" / f"{name}.mission"
    first = load_mission(path, Variation(Scheduler.FCFS, Control.TIMED)).initial
    flow, seen, waiting = flow_of(first.setting), {first}, [first]
    while waiting and len(seen) < (300 if IS_WHOLE else 60):
        c = waiting.pop()
        for a in c.alpha.names():
            try:
                parcel = parcel_here(c, a)
            except ValueError:
                continue  # it flies
            if parcel is not None:
                assert text_objection(c.setting, flow, parcel_of(parcel_json(parcel))) == ""
        for step in successors(c):
            if step.target not in seen:
                seen.add(step.target)
                waiting.append(step.target)


RULES = """
signature {
  kind Location contains UAV, Station
  kind UAV driven
  kind Station
}
world {
  west0: Location = box (37.10, -8.70) (37.00, -8.80)
  east0: Location = box (37.10, -8.50) (37.00, -8.60)
  gcs0: Station = point (37.05, -8.55) linked internet, control:gcs0
  uav0: UAV = point (37.05, -8.75) linked internet, control:gcs0
}
rule carry(u: UAV, here: Location, there: Location) {
  HOST || here.(u | $0) || there.$1 -> HOST || here.$0 || there.(u | $1) }
rule claim(u: UAV) { u[c] || HOST[d] -> u[d] || HOST[d] }
BigActor op0 hosted_at gcs0 with_behavior {
  for u in {uav0} { control(carry(u, west0, east0))
                    control(claim(u))
                    control({ HOST || west0.(u | $0) || east0.$1 -> HOST || west0.$0 || east0.(u | $1) }) }
  control(MOVE uav0 TO east0 VIA west0)
}
"""


def test_what_a_command_or_a_rule_has_made_is_known_by_its_arguments():
    source = Source("rules.mission", RULES)
    program = elaborate(parse(source), source, Path()).setting.program
    several = {"carry": ("uav0", "west0", "east0"), "claim": ("uav0",), "MOVE": ("uav0", "east0", "west0")}
    for name, make in program.reactions.items():
        given = several.get(name, ("uav0",) if name not in COMMANDS else None)
        if given is None:
            continue
        made = make("gcs0", *given)
        assert make.made_from(made, "gcs0")[1:] == given
        assert make(*make.made_from(made, "gcs0")) == made
        assert [other for other, each in program.reactions.items() if each.made_from(made, "gcs0")] == [name]
