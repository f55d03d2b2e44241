"""Stations together are the whole: whatever leaves and enters when, they take the steps that the whole could take."""

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scale import examples

from semantics.behaviours.observations import All, Of, QueryOperator
from semantics.behaviours.values import Route, Text
from semantics.bigactor_rules import say
from semantics.environment import Says
from semantics.observed_steps import WRITABLE
from semantics.state.canonical import written
from semantics.state.parcel_serialization import parcel_json
from semantics.state.parcel_serialization import parcel_of as parcel_in
from semantics.state.parcels import Controls, Parcel, Running
from semantics.state.requests import MGR, OBS
from semantics.state.setting import Control, Scheduler
from semantics.state.station_partition import (
    Belief,
    Parting,
    believe,
    enter,
    is_here,
    leave,
    objection,
    parcel_of,
    parted,
    sent_cell,
    station_of,
    took_cell,
)
from semantics.successors import expand, moves, served
from specs.diagnostics import Source
from specs.elaboration import Variation, elaborate, load_mission
from specs.parser import parse

TEXT = """
signature {
  kind Location contains Location, Station
  kind Station
}
world {
  shore0: Location = box (37.1, -8.5) (37.0, -8.6)
  gcs0: Station = point (37.05, -8.53) linked internet, control:gcs0
  gcs1: Station = point (37.06, -8.53) linked internet, control:gcs1
  gcs2: Station = point (37.07, -8.53) linked internet
}
def visit(host) = {
  observe(CHILDREN(PARENT(HOST)))
  migrate(host)
  react { case view if gcs1 in view => send ("seen", view, [gcs1, {1, 2}, gcs1]) to op0 }
}
BigActor nomad hosted_at gcs0 with_behavior { loop { visit(gcs1)
  visit(gcs2)
  observe(LINKED_TO_HOST)
  visit(gcs0) } }
BigActor op0 hosted_at gcs0 with_behavior {
  send "hello" to op1
  spawn child hosted_at gcs2 with_behavior Childhood("a")
  loop { react { case ("seen", view, x) => send view to op1
                 case m: Message => send (m, 1) to nomad } }
}
def Childhood(word) = { send word to op0
  migrate(gcs1)
  loop { send word to op1
  react { case x => display(x) } } }
BigActor op1 hosted_at gcs1 with_behavior { loop { react {
  case "hello" => send "hello" to op0
  case x => send "more" to child } } }
environment { says "come" to nomad at most 3 times
              says "go" to op0 at most 2 times }
"""
STATIONS = ("gcs0", "gcs1", "gcs2")
HOSTS = {name: name for name in STATIONS}


def mission(text=TEXT):
    source = Source("parting.mission", text)
    return elaborate(parse(source), source, Path(), Variation(Scheduler.FCFS, Control.TIMED)).initial


FIRST = mission()


def parting(here):
    return Parting(here, HOSTS, {}, {})


class Together:
    """The whole, and its parts with what is on its way between them."""

    def __init__(self, first=FIRST):
        self.whole = first
        self.parts = {name: parted(first, parting(name)) for name in STATIONS}
        self.under_way = {(a, b): [] for a in STATIONS for b in STATIONS if a != b}
        self.beliefs, self.latest, self.stamp = [], {}, 0

    def ways(self):
        """Return what may happen next: a step of an agent where it runs, or a parcel that arrives."""
        found = []
        for name, part in self.parts.items():
            for a in part.alpha.names():
                if is_here(part, a):
                    found += [(name, step) for step in (*served(part, a), *moves(part, a))]
            found += [(name, step) for each in part.setting.environment for step in self._said(part, each)]
        found += [(index, "believe") for index in range(len(self.beliefs))]
        return found + [pair for pair, parcels in self.under_way.items() if parcels]

    def _said(self, part, clause):
        return say(part, clause) if isinstance(clause, Says) and is_here(part, clause.agent) else ()

    def go(self, way):
        if way[1] == "believe":
            self._believe(way[0])
            return
        if isinstance(way[1], str):
            self._arrive(*way)
            return
        name, step = way
        expansion = expand(self.whole)
        found = (*expansion.enabled, *expansion.by_environment)
        alike = [t.target for t in found if str(t.label) == str(step.label)]
        agent = step.label.agent
        self.whole = next(
            target
            for target in alike
            if agent is None or target.alpha.code(agent) == step.target.alpha.code(agent)
        )
        cells = written(self.parts[name], step.target)
        self.parts[name] = step.target
        self._show({cell: value for cell, value in cells.items() if cell[0] in WRITABLE})
        self._tell(name, [cell for cell in cells if cell[0] in ("parent", "links")])
        self._forward(name)

    def _show(self, changes):
        """Let all stations see at once what has changed in the world: it is the same as in the whole."""
        self.parts = {name: part.with_(changes) for name, part in self.parts.items()}
        assert all(self.whole.read(cell) == value for cell, value in changes.items())

    def _tell(self, name, slots):
        """Tell the others what was written into L; the latest counts."""
        for slot, node in slots:
            self.stamp += 1
            value = self.parts[name].read((slot, node))
            names = value if slot == "links" else (() if value is None else (value,))
            self.latest[name, slot, node] = self.stamp
            for other in STATIONS:
                if other != name:
                    self.beliefs.append((other, self.stamp, Belief(node, slot, names)))

    def _believe(self, index):
        to, stamp, belief = self.beliefs.pop(index)
        if stamp > self.latest.get((to, belief.slot, belief.node), 0):
            self.latest[to, belief.slot, belief.node] = stamp
            for believed in believe(self.parts[to], belief):
                self.parts[to] = believed.target

    def _forward(self, name):
        for a in self.parts[name].alpha.names():
            for left in leave(self.parts[name], a):
                to = station_of(self.parts[name], a)
                plain = json.loads(json.dumps(parcel_json(parcel_of(self.parts[name], a))))
                self.parts[name] = left.target
                self.under_way[name, to].append((left.target.read(sent_cell(to)), plain))

    def _arrive(self, sender, to):
        while waiting := [index for index, (other, _, _) in enumerate(self.beliefs) if other == to]:
            self._believe(waiting[0])  # what its sender knew comes first
        number, plain = self.under_way[sender, to].pop(0)
        entered = list(enter(self.parts[to], sender, number, parcel_in(plain)))
        assert entered, objection(self.parts[to], parcel_in(plain))
        assert list(enter(entered[0].target, sender, number, parcel_in(plain))) == []  # it comes again
        self.parts[to] = entered[0].target
        self._forward(to)

    def of(self, a):
        """Return what all stations, and all that is under way, have of an agent."""
        parcels = [parcel_of(part, a) for part in self.parts.values() if a in part.alpha]
        sent = [parcel_in(plain) for several in self.under_way.values() for _, plain in several]
        parcels += [parcel for parcel in sent if parcel.agent == a]
        found = [parcel for parcel in parcels if parcel is not None]
        mail = Counter(map(repr, (message for parcel in found for message in parcel.mail)))
        return mail, [parcel.running for parcel in found if parcel.running is not None]


@examples(60)
@given(st.data())
def test_the_stations_together_take_the_steps_of_the_whole(data):
    together = Together()
    for _ in range(data.draw(st.integers(1, 60))):
        together.go(data.draw(st.sampled_from(together.ways())))
        for a in together.whole.alpha.names():
            mail, running = together.of(a)
            whole = parcel_of(together.whole, a)
            assert mail == Counter(map(repr, whole.mail if whole else ()))
            assert running == ([whole.running] if whole and whole.running else [])


HANDOVER = load_mission(
    Path(__file__).parents[3] / "specs" / "missions" / "distributed_handover.mission",
    Variation(Scheduler.FCFS, Control.ATOMIC),
).initial


@examples(60)
@given(st.data())
def test_a_vehicle_goes_round_the_stations_as_in_the_whole(data):
    """Example 2: what one station writes into L the next one has when it is told to go on."""
    together = Together(HANDOVER)
    while ways := together.ways():
        together.go(data.draw(st.sampled_from(ways)))
    assert together.whole.structure.physical.channels("uav0") == ("control:gcs0",)
    assert together.whole.eta.all() == ()
    for part in together.parts.values():
        assert part.structure.logical.links("uav0") == together.whole.structure.logical.links("uav0")


@examples(60)
@given(st.data())
def test_what_is_kept_of_an_agent_that_has_ended_goes_where_it_went(data):
    last = "BigActor last hosted_at gcs0 with_behavior { let n = 1 migrate(gcs1) n = n + 1 migrate(gcs2) }"
    asked = 'check { reachable "r": last.n == 2 }'
    together = Together(mission(f"{TEXT.partition('def visit')[0]} {last} {asked}"))
    while ways := together.ways():
        together.go(data.draw(st.sampled_from(ways)))
    assert together.whole.alpha.store("last") == (("n", 2),)
    stores = {name: part.alpha.store("last") for name, part in together.parts.items()}
    assert stores == {"gcs0": (), "gcs1": (), "gcs2": (("n", 2),)}


def test_a_part_has_of_agents_elsewhere_their_hosts_alone():
    part = parted(FIRST, parting("gcs1"))
    assert part.alpha.names() == ("nomad", "op0", "op1")
    assert [parcel_of(part, a) is None for a in part.alpha.names()] == [True, True, False]
    assert [station_of(part, a) for a in part.alpha.names()] == ["gcs0", "gcs0", "gcs1"]


def test_what_runs_here_does_not_leave():
    part = parted(FIRST, parting("gcs0"))
    assert list(leave(part, "op0")) == []
    assert list(leave(part, "op1")) == []  # nothing of it is here
    assert list(leave(FIRST, "op0")) == []  # nothing is parted


def test_parcels_enter_once_and_in_order():
    part = parted(FIRST, parting("gcs1"))
    parcel = Parcel("op1", (Text("hello"),))
    assert list(enter(part, "gcs0", 2, parcel)) == []
    (first,) = enter(part, "gcs0", 1, parcel)
    assert str(first.label) == "⟨enter : op1, gcs0⟩"
    assert first.target.alpha.mailbox("op1") == (Text("hello"),)
    assert first.target.read(took_cell("gcs0")) == 1
    assert list(enter(first.target, "gcs0", 1, parcel)) == []
    assert len(list(enter(first.target, "gcs0", 2, parcel))) == 1
    assert len(list(enter(first.target, "gcs2", 1, parcel))) == 1
    assert list(enter(part, "gcs9", 1, parcel)) == []


def running(**changes):
    asked = parcel_of(FIRST, "nomad").running
    return replace(Running("gcs1", asked.code, asked.store, (), asked.says), **changes)


HANDS = Controls("nomad", "HAND", "gcs0", ("gcs1", "gcs2"))


@pytest.mark.parametrize(
    ("parcel", "why"),
    [
        (Parcel("nobody", ("x",)), "no bigActor nobody"),
        (Parcel("op1", (), running()), "runs here already"),
        (Parcel("nomad", (), running(code=(10_000,))), "not in this mission"),
        (Parcel("nomad", (), running(says=())), "its counts of `says`"),
        (Parcel("nomad", (), running(host="gcs9")), "gcs9 is unknown"),
        (Parcel("nomad", (), running(requests=(MGR("op1", "gcs1"),))), "another agent"),
        (Parcel("nomad", (), running(requests=(MGR("nomad", "gcs8"),))), "no statement that it has passed"),
        (Parcel("nomad", (), running(host="gcs2")), "does not run the bigActors on gcs2"),
        (Parcel("nomad", (), running(requests=(HANDS,))), "no statement that it has passed"),
    ],
)
def test_what_no_station_of_the_mission_can_have_sent_does_not_enter(parcel, why):
    part = parted(FIRST, parting("gcs1"))
    assert why in objection(part, parcel)
    assert list(enter(part, "gcs0", 1, parcel)) == []


def test_a_parcel_is_read_as_it_was_written():
    whole = Parcel("nomad", ("gcs1", Text("gcs1")), running(requests=(HANDS,)))
    assert parcel_in(json.loads(json.dumps(parcel_json(whole)))) == whole
    assert objection(parted(FIRST, parting("gcs1")), Parcel("nomad", (Text("come"),), running())) == ""
    assert "without a sender" in objection(
        parted(FIRST, parting("gcs1")), Parcel("nomad", ("come",), running())
    )


def test_a_route_is_read_as_it_was_written_and_as_no_tuple():
    said = Parcel("nomad", (Route(("b", ("a", Route(())), "b")),), running())
    data = json.loads(json.dumps(parcel_json(said)))
    assert parcel_in(data) == said
    assert parcel_in(data).mail[0] != ("b", ("a", ()), "b")


def test_a_parcel_with_an_operator_that_queries_have_not_is_refused():
    asking = Parcel("nomad", (), running(requests=(OBS("nomad", Of(QueryOperator.PARENT, All())),)))
    text = json.dumps(parcel_json(asking))
    assert parcel_in(json.loads(text)) == asking
    with pytest.raises(ValueError, match="'COUSINS' is no operator of queries"):
        parcel_in(json.loads(text.replace("PARENT", "COUSINS")))


def deep(levels):
    value = "x"
    for _ in range(levels):
        value = [value]
    return value


@pytest.mark.parametrize(
    "data",
    [
        None,
        [],
        {"Parcel": []},
        {"Parcel": ["nomad", "x", None]},
        {"Parcel": ["nomad", [], {"Running": ["gcs0", ["one"], [], [], []]}]},
        {"Parcel": ["nomad", [], {"Running": ["gcs0", [True], [], [], []]}]},
        {"Parcel": ["nomad", [], {"Running": ["gcs0", [1], [["x"]], [], []]}]},
        {"Parcel": ["nomad", [], {"Running": ["gcs0", [1], [], [{"Parcel": []}], []]}]},
        {"Parcel": ["nomad", [1.5], None]},
        {"Parcel": ["nomad", [{"truth": "maybe"}], None]},
        {"Parcel": ["nomad", [{"text": 3}], None]},
        {"Parcel": ["nomad", [10**30], None]},
        {"Parcel": ["nomad", [deep(100)], None]},
        {"Parcel": ["nomad", [["x"] * 2000], None]},
        {"Parcel": ["nomad", ["x"] * 20_000, None]},
        {"Parcel": ["nomad", [{"seen": 3, "swept": 4}], None], "more": 1},
    ],
)
def test_what_is_no_parcel_is_refused(data):
    with pytest.raises(ValueError, match=r"."):
        parcel_in(data)
