"""The missions that ship: exact counts, verdicts and lengths of traces (default scheduler, monitor not counted)."""

import os
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from scale import IS_WHOLE, some_long

from checker import Engine, Limits, Outcome, Reduction, Report, check
from semantics import Control, Scheduler
from semantics.properties.kinds import PropertyKind
from specs.elaboration import Variation, load_mission, read_mission

MISSIONS = Path(__file__).parents[2] / "specs" / "missions"


@dataclass(frozen=True)
class Expected:
    """Counts, for each property that is violated the lengths of its shortest traces by kind, and when what is true."""

    configurations: int
    transitions: int
    violated: dict[str, dict[str, int]] = field(default_factory=dict)
    witnesses: dict[str, int] = field(default_factory=dict)
    times: dict[str, str] = field(default_factory=dict)


SHIPPED: dict[str, Expected] = {
    "broken_corridor": Expected(
        81, 180, violated={"never over the prison": {"invariant": 5}}, witnesses={"both are back": 12}
    ),
    "broken_control_race": Expected(10, 12, violated={"race_freedom": {"control race": 2}}),
    "broken_crossing": Expected(16, 24, violated={"apart": {"invariant": 4}}, witnesses={"both are over": 6}),
    "broken_deadlock": Expected(526, 1_128, violated={"deadlock_freedom": {"deadlock": 22}}),
    "broken_endurance": Expected(
        26,
        28,
        violated={"endurance": {"exhausted": 18}},
        times={"home": "at 12:30 at the earliest, at 28:10 at the latest"},
    ),
    "broken_inconsistent": Expected(24, 48, violated={"local_consistency": {"inconsistent": 2}}),
    "broken_race_in_time": Expected(
        17,
        20,
        violated={"race_freedom": {"control race": 3}},
        times={
            "in the west": "at 0:35 at the earliest, at 14:25 at the latest",
            "there and back": "after 28:35 at the latest",
        },
    ),
    "broken_range_of_radio": Expected(
        8, 9, violated={"in range of the first": {"invariant": 2}}, witnesses={"handed over": 5}
    ),
    "broken_two_lanes": Expected(
        17, 16, violated={"not through the oil": {"invariant": 8}}, witnesses={"through": 9}
    ),
    "broken_unmatched": Expected(24, 46, violated={"local_consistency": {"unmatched": 3}}),
    "broken_unrealisable": Expected(60, 136, violated={"local_consistency": {"unrealisable": 4}}),
    "convoy": Expected(3_730, 11_253, witnesses={"all are out": 54}),
    "corridor": Expected(81, 180, witnesses={"both are back": 12}),
    "crossing": Expected(15, 16, witnesses={"both are over": 12}),
    "crossing_timed": Expected(8, 7, times={"both are over": "after 23:20 at the latest"}),
    "distributed_handover": Expected(102, 157, witnesses={"once around": 45}),
    "endurance": Expected(26, 28, times={"home": "at 12:30 at the earliest, at 28:10 at the latest"}),
    "go_ahead": Expected(82, 202, witnesses={"surveyed": 9}),
    "handover": Expected(23, 34, witnesses={"handed over": 6}),
    "handover_timed": Expected(
        14,
        14,
        times={
            "authority": "after 5 s at the latest",
            "told": "after 13 s at the latest",
            "handed over": "at 0:30 at the earliest, at 1:07 at the latest if at all: it may never",
        },
    ),
    "harbour_watch": Expected(12, 11, witnesses={"the fairway was clear": 11}),
    "look_before_entry": Expected(26, 27, witnesses={"the second enters too": 23}),
    "look_before_entry_racy": Expected(53, 86, violated={"race_freedom": {"stale-observation race": 12}}),
    "nomad": Expected(78, 125, witnesses={"aboard the UAV": 9, "ashore again": 3}),
    "oil_spill": Expected(34, 74, witnesses={"over the spill": 8}),
    "oil_spill_timed": Expected(
        209,
        330,
        times={
            "over the spill": "after 47:07 at the latest",
            "over the spill at": "at 7:28 at the earliest, at 47:07 at the latest",
            "home": "at 19:17 at the earliest, at 1:09:07 at the latest",
        },
    ),
    "race_in_time": Expected(
        8,
        7,
        times={
            "in the west": "at 0:35 at the earliest, at 14:25 at the latest",
            "there and back": "after 28:35 at the latest",
        },
    ),
    "range_of_radio": Expected(20, 24, witnesses={"handed over": 14}),
    "relay_timed": Expected(
        16,
        29,
        times={
            "the report": "after 8 min at the latest",
            "told": "at 0:10 at the earliest, at 8:00 at the latest",
        },
    ),
    "rendezvous": Expected(18_051, 73_275, witnesses={"all meet": 55}),
    "search_and_deploy": Expected(76, 121, witnesses={"deployed": 13}),
    "smartphone": Expected(15, 16, witnesses={"delivered": 12}),
    "spill_watch": Expected(4_446, 15_843, witnesses={"home": 37, "over the spill": 13}),
    "surveillance": Expected(153, 663, witnesses={"an alarm is raised": 6}),
    "takeover": Expected(630, 2_214, witnesses={"landed after an emergency": 25}),
    "tanker": Expected(56, 125, witnesses={"both drifters deployed": 14}),
    "two_lanes": Expected(13, 13, witnesses={"through": 10}),
    "two_gates": Expected(38, 76, witnesses={"there and back": 10}),
}


def checked(name: str) -> Report:
    mission = load_mission(MISSIONS / f"{name}.mission")
    return check(mission.initial, mission.properties, Limits(configurations=200_000))


def test_every_mission_that_ships_is_listed_here():
    assert sorted(path.stem for path in MISSIONS.glob("*.mission")) == sorted(SHIPPED)


@pytest.mark.parametrize("name", SHIPPED)
def test_a_mission_that_ships_has_its_counts_verdicts_and_shortest_traces(name):
    report, expected = checked(name), SHIPPED[name]
    assert report.complete
    assert (report.configurations, report.transitions) == (expected.configurations, expected.transitions)
    violated = {
        verdict.property.name: {violation.kind: len(violation.trace) for violation in verdict.violations}
        for verdict in report.verdicts
        if verdict.outcome.value == "violated"
    }
    assert violated == expected.violated
    assert report.exit_code == (1 if violated else 0)
    reached = {
        v.property.name: len(v.witness)
        for v in report.verdicts
        if v.property.kind == "reachable" and v.witness is not None
    }
    assert reached == expected.witnesses
    timed = (PropertyKind.TIME, PropertyKind.WITHIN)
    assert {v.property.name: v.note for v in report.verdicts if v.property.kind in timed} == expected.times


MOST = Limits(configurations=5_000 if IS_WHOLE else 1_000)


def with_regions(name: str) -> str:
    """Return the text of a mission with a bound on each vehicle's way, and a property about each two vehicles."""
    mission = load_mission(MISSIONS / f"{name}.mission")
    kinds, signature = mission.setting.kinds, mission.setting.signature
    driven = sorted({kind for kind in kinds.values() if signature[kind].driven})
    first = min(kinds)
    asked = [
        f"forall x: {kind} . x at least 1 m from {first} or x within 900 km of {first}" for kind in driven
    ]
    strays = "\n".join(f"  {kind} strays at most 200 m" for kind in driven)
    checks = "\n".join(f'  invariant "way {rank}": {each}' for rank, each in enumerate(asked))
    text = (MISSIONS / f"{name}.mission").read_text(encoding="utf-8")
    text = "\n".join(line for line in text.split("\n") if "strays" not in line)
    return f"{text}\nenvironment {{\n{strays}\n}}\ncheck {{\n{checks}\n}}\n"


@pytest.mark.parametrize("name", some_long(SHIPPED))
def test_properties_about_ways_change_no_configuration(name):
    timed = Variation(control=Control.TIMED)
    plain = load_mission(MISSIONS / f"{name}.mission", timed)
    asked = read_mission(with_regions(name), MISSIONS, variation=timed)
    counts = [
        (each.configurations, each.transitions, each.depth)
        for each in (
            check(plain.initial, plain.properties, MOST),
            check(asked.initial, asked.properties, MOST),
        )
    ]
    assert counts[0] == counts[1]


PAPERS_RUN = [
    "⟨req_ctr : a, control(MOVE_HOST_TO searchArea0)⟩",
    "⟨actuate : CTR(a, MOVE_HOST_TO searchArea0)⟩",
    "⟨req_obs : a, observe(CHILDREN(PARENT(uav0)))⟩",
    "⟨sense : OBS(a, CHILDREN(PARENT(uav0)))⟩",
    "⟨rcv_obs : a, react({oilSpill0, searchArea0, uav0})⟩",
    "⟨fun : a⟩",
    "⟨req_ctr : a, control(MOVE_HOST_TO oilSpill0)⟩",
    "⟨actuate : CTR(a, MOVE_HOST_TO oilSpill0)⟩",
]


def test_the_run_of_figure_2_is_c0_to_c8_rule_for_rule():
    (witness,) = [v.witness for v in checked("oil_spill").verdicts if v.property.name == "over the spill"]
    assert [str(step.label) for step in witness.steps] == PAPERS_RUN


FIGURE_8 = """
0 BigActor hosted_at gcs2 with_behavior {
1   observe(LINKED_TO_HOST)
2   loop {
3     react {
4       case obs: Observation => display(obs)
5                                     observe(LINKED_TO_HOST)
6       case "handover" => control(HAND uav0 TO gcs0)
7     }
8   }
9 }
"""


def test_figure_8_stands_in_handover_verbatim():
    assert FIGURE_8 in (MISSIONS / "handover.mission").read_text(encoding="utf-8")


@pytest.mark.parametrize("scheduler", Scheduler)
@pytest.mark.parametrize("control", Control)
def test_who_looks_before_entering_races_under_every_scheduler_and_control(scheduler, control):
    variation = Variation(scheduler=scheduler, control=control)
    for name, outcome in (("look_before_entry_racy", "violated"), ("look_before_entry", "holds")):
        if name == "look_before_entry" and scheduler is Scheduler.UNORDERED:
            continue  # its synchronisation rests on requests being served in order
        mission = load_mission(MISSIONS / f"{name}.mission", variation)
        verdicts = {
            v.property.kind: v.outcome.value for v in check(mission.initial, mission.properties).verdicts
        }
        assert verdicts["race_freedom"] == outcome


@pytest.mark.parametrize("engine", [pytest.param(Engine.REFERENCE, marks=pytest.mark.long), Engine.FAST])
@pytest.mark.parametrize(
    ("control", "reductions", "expected"),
    [("timed", (Reduction.POR,), 600), ("atomic", (), 2_754), ("atomic", (Reduction.POR,), 425)],
)
def test_a_family_keeps_apart_on_its_route_whatever_explores_it(engine, control, reductions, expected):
    mission = load_mission(MISSIONS / "convoy.mission", Variation(control=Control(control)))
    report = check(mission.initial, mission.properties, engine=engine, reduce=reductions)
    undecided = {each.property.name for each in report.verdicts if each.outcome is not Outcome.HOLDS}
    assert (report.configurations, undecided) == (expected, {"all come home"} if reductions else set())


TIMED = {"oil_spill": (43, 98), "handover": (23, 34), "search_and_deploy": (98, 166), "tanker": (62, 141)}


@pytest.mark.parametrize("name", TIMED)
def test_what_may_fly_holds_when_control_takes_time_too(name):
    mission = load_mission(MISSIONS / f"{name}.mission", Variation(control=Control.TIMED))
    report = check(mission.initial, mission.properties)
    assert (report.configurations, report.transitions, report.exit_code) == (*TIMED[name], 0)


RECORDING = (
    Path(os.environ.get("BIGACTORS_DATA", MISSIONS.parents[2] / "shared" / "data"))
    / "ais"
    / "workum_2020.nmea"
)


@pytest.mark.skipif(
    not RECORDING.is_file(), reason="the real recordings are not here (BIGACTORS_DATA names their folder)"
)
def test_harbour_watch_holds_on_the_real_marina():
    mission = load_mission(
        MISSIONS / "harbour_watch.mission", Variation(sources={"harbour_watch.nmea": RECORDING})
    )
    vessels = [name for name, kind in mission.setting.kinds.items() if kind == "Vessel"]
    report = check(mission.initial, mission.properties)
    assert len(vessels) == 30
    assert (report.configurations, report.transitions, report.exit_code) == (12, 11, 0)
    occupied = mission.initial.structure.physical.children("basin0")
    assert occupied == (
        "mmsi211524940",
        "mmsi215441000",
        "mmsi244110847",
        "mmsi244710041",
        "mmsi244780956",
        "mmsi269057061",
        "mmsi269057654",
    )
