"""Elaboration: what missions come to, phase by phase, and what runs of them count."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from elaborating import elaborated, reachable, told
from geojson import collection, feature

from physical import ais_recording, box, centroid, circle, point, translate_to
from physical.ais_reports import AisError
from semantics.behaviours import statements as k
from semantics.behaviours.expressions import Fault, Host, Literal, QueryOf, Variable
from semantics.behaviours.program import VariableOf
from semantics.behaviours.statements import Choose, For, ForEach, Loop, Match, React, Spawn
from semantics.behaviours.values import Text
from semantics.environment import Appears, Drifts, Leaves, Says
from semantics.properties.propositions import Always, And, Inside, Not, Or, VariableIs, holds
from semantics.state.physical_model import Carried, Placed
from semantics.state.setting import Control, Scheduler
from semantics.successors import successors
from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import MissionError
from specs.elaboration import load_mission, read_mission

MISSIONS = Path(__file__).parents[2] / "specs" / "missions"
SIGNATURE = """
signature {
  kind Location contains Location, OilSpill, UAV, Vessel, Station, Drifter
  kind OilSpill contains UAV
  kind UAV driven
  kind Vessel driven carries Drifter
  kind Drifter
  kind Station
}
"""
WORLD = (
    SIGNATURE
    + """
world {
  searchArea0: Location = box (37.04, -8.59) (36.94, -8.79)
  base0: Location = box (37.2, -8.59) (37.1, -8.79)
  oilSpill0: OilSpill = circle (37.00, -8.70) radius 400 m
  uav0: UAV = point (37.15, -8.7) linked wifi
  vessel0: Vessel = point (37.15, -8.6) linked wifi
  drifter0: Drifter carried by vessel0
}
"""
)
FIGURE_2 = """
BigActor a hosted_at uav0 with_behavior {{
  control(MOVE_HOST_TO searchArea0)
  observe(CHILDREN(PARENT(HOST)))
  react {{ {case} }}
}}
scheduler {scheduler}
control {control}
"""
STILL = re.sub("  (vessel|drifter)0: .*\n", "", WORLD).replace(" linked wifi", "")
TESTED_INSIDE = "case obs => if oilSpill0 in obs { control(MOVE_HOST_TO oilSpill0) }"
GUARDED = "case obs if oilSpill0 in obs => control(MOVE_HOST_TO oilSpill0)"


def actor(body, name="a", host="uav0"):
    return f"BigActor {name} hosted_at {host} with_behavior {{\n{body}\n}}\n"


# --- Figure 2 -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("case", "scheduler", "control", "count"),
    [
        (TESTED_INSIDE, "program_order", "atomic", (10, 10)),
        (TESTED_INSIDE, "program_order", "timed", (13, 14)),
        (TESTED_INSIDE, "unordered", "atomic", (16, 18)),
        (GUARDED, "unordered", "atomic", (12, 12)),
        (GUARDED, "program_order", "atomic", (10, 10)),
    ],
)
def test_figure_2_on_a_still_world_has_the_paper_s_counts(case, scheduler, control, count):
    mission = elaborated(STILL + FIGURE_2.format(case=case, scheduler=scheduler, control=control))
    seen, transitions = reachable(mission)
    assert (len(seen), transitions) == count


def test_what_is_not_said_has_its_default():
    mission = elaborated(STILL + actor("skip"))
    assert mission.setting.scheduler is Scheduler.PROGRAM_ORDER
    assert mission.setting.control is Control.ATOMIC
    assert not mission.setting.monitored
    kinds = [prop.kind for prop in mission.properties]
    assert kinds == ["local_consistency", "race_freedom", "deadlock_freedom", "computation"]
    assert mission.name == "test"
    assert mission.line("agent", "a") == STILL.count("\n") + 1
    assert mission.line("agent", "nobody") == 0


EVERYTHING = str(MISSIONS.parents[1] / "tests" / "corpus" / "ok" / "everything.mission")


def printed(path):
    m = load_mission(path)
    return f"{m.setting.program.statements, m.setting.environment, m.properties, sorted(m.fixed), m.initial}"


def test_elaboration_is_the_same_under_two_hash_seeds():
    here = Path(__file__).parent
    script = "import sys; sys.path[:0] = sys.argv[1:3]; import test_elaboration as t; print(t.printed(sys.argv[3]))"
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    there = subprocess.run(
        [sys.executable, "-c", script, str(here), str(here.parent), EVERYTHING],
        env={**os.environ, "PYTHONHASHSEED": seed},
        capture_output=True,
        check=True,
        text=True,
    ).stdout
    assert there == printed(EVERYTHING) + "\n"
    assert "Says" in there


# --- world and beliefs ----------------------------------------------------------------------------------------


def test_a_carried_entity_has_its_own_shape_or_a_point_where_its_carrier_is():
    physical = elaborated(WORLD).initial.structure.physical
    assert physical.placement("drifter0") == Carried("vessel0", Placed(point(37.15, -8.6)))
    assert physical.abstract_parent("drifter0") == "vessel0"


def test_the_first_logical_model_is_that_of_the_world_unless_it_is_believed_otherwise():
    believed = "believes { uav0 in searchArea0 oilSpill0 unknown vessel0 unlinked drifter0 in region }"
    plain, other = elaborated(WORLD), elaborated(WORLD + believed)
    assert plain.initial.structure.logical.parent("uav0") == "base0"
    logical = other.initial.structure.logical
    parents = [logical.parent(name) for name in ("uav0", "oilSpill0", "drifter0")]
    assert parents == ["searchArea0", None, "region"]
    assert (logical.links("vessel0"), logical.links("uav0")) == ((), ("wifi",))


def test_what_is_in_an_unknown_place_is_believed_in_the_place_around_that():
    world = WORLD.replace("uav0: UAV = point (37.15, -8.7)", "uav0: UAV = point (37.0, -8.7)")
    logical = elaborated(world + "believes { oilSpill0 unknown }").initial.structure.logical
    assert logical.parent("uav0") == "searchArea0"


def test_what_nobody_can_move_is_fixed():
    moving = "environment { oilSpill0 drifts among base0 searchArea0 vanishes }"
    assert elaborated(WORLD).fixed == {"searchArea0", "base0", "oilSpill0"}
    assert elaborated(WORLD + moving).fixed == {"base0"}


def test_a_mover_may_straddle_a_border():
    world = WORLD.replace("circle (37.00, -8.70)", "circle (37.04, -8.70)")
    assert elaborated(world + "environment { oilSpill0 drifts among searchArea0 }")
    assert [code for code, *_ in told(world)] == ["LS305"]


def test_a_geojson_file_is_read_beside_the_mission(tmp_path):
    features = [
        feature("harbour0", "Basin", [-8.7, 37.0], radius_m=500),
        feature("tug0", "Vessel", [-8.7, 37.0], channels=["ais"]),
    ]
    (tmp_path / "harbour.geojson").write_text(collection(*features))
    world = 'world { from "harbour.geojson" keep Basin as Location, Vessel }'
    text = SIGNATURE + world + actor("skip", host="tug0")
    mission = elaborated(text, tmp_path)
    assert mission.setting.kinds == {"harbour0": "Location", "tug0": "Vessel"}
    assert mission.initial.structure.logical.parent("tug0") == "harbour0"
    assert mission.initial.structure.logical.links("tug0") == ("ais",)
    one = elaborated(text.replace("Vessel }", "Vessel limit 1 }").replace("tug0", "harbour0"), tmp_path)
    assert one.notes == ("1 of the 2 entities in harbour.geojson is in the world: the first",)


def test_a_recording_is_read_as_of_a_time():
    pytest.importorskip("pyais")
    text = SIGNATURE + 'world { from "harbour_watch.nmea" keep Vessel limit 2 }'
    mission = elaborated(text, MISSIONS)
    assert len(mission.setting.kinds) == 2
    assert set(mission.setting.kinds.values()) == {"Vessel"}
    wrong = text.replace("keep Vessel", "keep Vesel as Vessel")
    assert told(wrong, MISSIONS)[0][0] == "LS306"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("none.geojson", "there is no file"),
        ("/etc/passwd", "is an absolute path"),
        ("~/x.geojson", "is an absolute path"),
        ("C:/x.geojson", "is an absolute path"),
        (".", "there is no file"),
        ("x" * 5000, "is no path of a file"),
    ],
)
def test_a_file_that_cannot_be_read_is_a_mistake_of_the_mission(name, words, tmp_path):
    (code, message, _), *_ = told(f'world {{ from "{name}" }}', tmp_path)
    assert code == "LS007"
    assert words in message


def test_a_mission_that_ships_is_loaded_by_its_name_unless_a_file_has_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert load_mission("oil_spill").setting.kinds["oilSpill0"] == "OilSpill"
    (tmp_path / "oil_spill").write_text("signature { kind Boat }", encoding="utf-8")
    assert load_mission("oil_spill").setting.kinds == {}
    with pytest.raises(MissionError, match="the file cannot be read"):
        load_mission(Path("handover"))  # a path is a file's


@pytest.mark.parametrize(
    ("name", "message", "hint"),
    [
        ("oil_spil", "there is no such file", "did you mean 'oil_spill'?"),
        (
            "nothing/of_it",
            "there is no such file",
            "give the path of a mission, or the name of one that ships: ",
        ),
        ("", "the path of the mission is empty", ""),
        (".", "this is a folder, not a mission", "give the path of a mission"),
        ("x" * 5000, "this is no path of a file", "give the path of a mission"),
        ("signature { kind A }", "this is the text of a mission, not its path", "write it to a file"),
    ],
)
def test_what_is_no_mission_is_said_with_the_nearest_that_ships(name, message, hint):
    with pytest.raises(MissionError) as caught:
        load_mission(name)
    (found,) = caught.value.diagnostics
    assert (found.code.number, found.message, found.hint[: len(hint)]) == ("LS007", message, hint)


def test_a_file_named_without_its_end_is_found_in_the_hint(tmp_path):
    (tmp_path / "bridge.mission").write_text("signature standard", encoding="utf-8")
    with pytest.raises(MissionError, match=f"did you mean '{tmp_path}/bridge.mission'"):
        load_mission(f"{tmp_path}/bridge")


@pytest.mark.parametrize(
    ("read", "given", "message"),
    [
        (
            read_mission,
            Path("bridge.mission"),
            "read_mission takes a text or a Mission, and load_mission a file",
        ),
        (read_mission, 5, "5 is neither"),
        (load_mission, 7, "not int"),
        (read_mission, s.Mission("x", ()), r"'x' is no part of a tree: a name is Name\('uav0'\)"),
    ],
)
def test_what_is_neither_a_text_nor_a_tree_nor_a_path_is_refused(read, given, message):
    with pytest.raises(TypeError, match=message):
        read(given)


# --- behaviours -----------------------------------------------------------------------------------------------


def statements(body, more=""):
    return elaborated(WORLD + actor(body) + more).setting.program.statements


def test_each_binding_of_a_variable_has_a_name_of_its_own():
    show = "def show(x) = { display(x) let y = x display(y) }\n"
    body = "let x = 1 if true { let x = 2 display(x) } x = 3 show(x)"
    program = elaborated(WORLD + show + actor(body)).setting.program
    variables = [each.variable for each in program.statements if type(each).__name__ == "Assign"]
    assert variables == ["x", "x#2", "x", "y"]
    assert program.behaviours["show"].parameters == ("x#show",)


def test_a_guard_in_a_react_is_tested_at_the_head_of_its_body_and_one_in_a_match_is_not():
    react, tested, *_ = statements("react { case obs if uav0 in obs => skip case obs => skip }")
    assert isinstance(react, React)
    assert [case.body for case in react.cases] == [(1,), ()]
    assert tested == k.Tested()
    found = statements("match 1 { case x if x == 1 => skip case _ => display(0) }")
    assert isinstance(found[0], Match)
    assert k.Tested() not in found


def test_for_goes_through_what_is_left_under_a_hidden_name():
    found = statements("for x in {1, 2} { display(x) }")
    assert found[0] == For(found[0].members, "#1", 1)
    assert found[1] == ForEach("x", "#1", (2,))


def test_what_is_left_of_a_for_meets_no_variable_of_the_mission():
    found = statements(
        "let rest = 1 for x in {1, 2} { let rest = 2 for y in {x} { display(rest) } } if true { let rest = 3 }"
    )
    binding = [each for each in found if not isinstance(each, For)]
    bound = {getattr(each, field, None) for each in binding for field in ("variable", "rest")} - {None}
    assert sorted(bound) == ["#1", "#2", "rest", "rest#2", "rest#3", "x", "y"]


def test_a_loop_at_the_top_is_outermost_and_others_are_not():
    serve = 'def serve() = { loop { react { case "x" => skip } } }\n'
    inner = 'def inner() = { loop { react { case "x" => skip } } }\n'
    actors = actor('loop { react { case "x" => inner() } }') + actor("serve()", "b")
    actors += actor("if true { loop { observe(HOST) } }", "c")
    program = elaborated(WORLD + serve + inner + actors).setting.program
    loops = [each.outermost for each in program.statements if isinstance(each, Loop)]
    assert loops == [True, False, True, False]


def test_queries_have_expressions_at_their_leaves():
    found = statements(
        "let x = uav0 observe(CHILDREN(PARENT(x))) observe(HOST) observe(ALL) observe(LINKED_TO_HOST)"
    )
    of_x = QueryOf("CHILDREN", QueryOf("PARENT", Variable("x")))
    expected = [of_x, QueryOf(None, Host()), QueryOf(None, None), QueryOf("LINKED_TO", Host())]
    assert [each.query for each in found[1:]] == expected


def test_skip_leaves_nothing_and_choices_keep_their_blocks():
    found = statements(
        "skip choose { skip } or { display(1) } spawn b hosted_at uav0 with_behavior n()", "def n() = {}"
    )
    assert found[0] == Choose(((), (1,)))
    assert found[2] == Spawn("b", Literal("uav0"), "n", ())


def test_anonymous_bigactors_are_numbered_in_order():
    text = WORLD + "".join(f"BigActor hosted_at uav0 with_behavior {{ display({n}) }}\n" for n in range(2))
    names = elaborated(text + actor("skip", "bigActor0")).initial.alpha.names()
    assert names == tuple(f"bigActor{n}" for n in range(3))


def test_the_lines_are_those_of_the_statements():
    mission = elaborated(WORLD + actor("display(1)\ndisplay(2)"))
    start = mission.line("agent", "a")
    assert mission.setting.program.lines == (start + 1, start + 2)


def test_a_control_of_what_is_no_node_is_a_fault():
    unknown = 'element(element((("nowhere", 1), 1), 0), 0)'  # the types of a tuple's tuples are not followed
    mission = elaborated(WORLD + actor(f"let place = {unknown} control(MOVE_HOST_TO place)"))
    step = successors(mission.initial)[0].target
    with pytest.raises(Fault, match='a name was expected, not "nowhere"'):
        successors(step)


def test_tail_recursion_is_a_loop():
    again = "def again(n) = { if n > 0 { observe(HOST) react { case obs => again(n - 1) } } }"
    mission = elaborated(WORLD + again + actor("again(2)"))
    assert len(reachable(mission)[0]) == 10


# --- environment ----------------------------------------------------------------------------------------------


def clauses(text):
    return elaborated(WORLD + actor("skip") + f"environment {{ {text} }}").setting.environment


def test_a_drift_among_goes_from_each_placement_to_each_other():
    (drift,) = clauses("oilSpill0 drifts among circle (37.0, -8.71) radius 400 m, base0, point (37.02, -8.7)")
    spill = circle((37.0, -8.7), 400)
    assert drift == Drifts(
        "oilSpill0",
        (
            Placed(circle((37.0, -8.71), 400)),
            Placed(translate_to(spill, centroid(box((37.2, -8.59), (37.1, -8.79))))),
            Placed(translate_to(spill, point(37.02, -8.7))),
        ),
        ("circle (37.0, -8.71) radius 400 m", "base0", "point (37.02, -8.7)"),
        ((1, 2), (0, 2), (0, 1)),
        (0, 1, 2),
    )


def test_a_drift_within_a_place_is_its_finite_quotient():
    world = """
    world {
      sea0: Location = box (37.04, -8.59) (36.94, -8.79)
      bay0: Location = box (37.00, -8.60) (36.98, -8.62)
      buoy0: Drifter = point (37.0, -8.7)
    }
    environment { buoy0 drifts within sea0 }
    """
    mission = elaborated(SIGNATURE + world)
    assert mission.notes == ("borders are left out of the drift of buoy0",)
    (drift,) = mission.setting.environment
    assert sorted(drift.names) == ["somewhere in sea0", "somewhere in sea0 and bay0"]
    assert len(reachable(mission)[0]) == 3  # where it was at first is a placement of its own


def test_who_appears_has_its_channels_and_may_be_carried():
    text = WORLD.replace("drifter0: Drifter", "drifter1: Drifter absent drifter0: Drifter") + actor("skip")
    mission = elaborated(text + "environment { drifter1 appears at vessel0, base0 linked ais }")
    (clause,) = mission.setting.environment
    assert isinstance(clause, Appears)
    assert [type(placement) for placement in clause.placements] == [Carried, Placed]
    assert clause.channels == ("ais",)


def test_what_is_said_goes_to_the_only_bigactor_and_is_counted_by_clause():
    assert clauses('says "go" at most 2 times says "go" to a uav0 leaves wifi') == (
        Says(Text("go"), "a", 2, 0),
        Says(Text("go"), "a", 1, 1),
        Leaves("uav0", "wifi", False),
    )


# --- checks ---------------------------------------------------------------------------------------------------


def properties(text, body="let x = 1 observe(HOST) react { case obs => display(x) }"):
    mission = elaborated(WORLD + actor(body) + f"check {{ {text} }}")
    return mission, mission.properties


def test_a_quantifier_has_an_instance_for_each_entity_of_its_kind():
    mission, (first, *_) = properties('invariant "i": forall x: Location . exists y: UAV . y in x -> x == y')
    both = first.formula
    assert isinstance(both, And)
    (some,) = both.formulas[0].formulas
    assert some == Or((Not(Inside("uav0", "base0")), Always(False)))
    assert (first.kind, first.name) == ("invariant", "i")
    assert not holds(first.formula, mission.initial)


def test_a_variable_of_a_bigactor_is_any_of_that_name_in_what_it_may_run():
    _, (first, *_) = properties(
        'reachable "r": a.x == 1',
        "let x = 1 if true { let x = 2 display(x) } b(3)\n} def b(x) = { display(x)",
    )
    assert first.formula == VariableIs(VariableOf("a", ("x", "x#2", "x#b")), 1)


# --- mistakes -------------------------------------------------------------------------------------------------


def test_all_mistakes_are_reported_at_once_and_by_position():
    text = WORLD + actor("display(nothing)", host="uav9") + "environment { wify drops }"
    assert [message for _, message, _ in told(text)] == [
        "unknown entity 'uav9'",
        "unknown name 'nothing'",
        "unknown channel 'wify'",
    ]


def missing(_):
    raise AisError(
        "ais-extra", "reading AIS needs pyais, which is not installed", "pip install bigactors[ais]"
    )


def test_a_missing_extra_names_it(monkeypatch, tmp_path):
    monkeypatch.setattr(ais_recording, "read_recording", missing)
    (tmp_path / "x.nmea").write_bytes((MISSIONS / "harbour_watch.nmea").read_bytes())
    (code, message, hint), *_ = told('world { from "x.nmea" }', tmp_path)
    assert code == "LS308"
    assert "pyais" in message
    assert "ais" in hint


def test_mistakes_of_syntax_and_of_meaning_are_reported_together(tmp_path):
    path = tmp_path / "two.mission"
    path.write_text("world {\n  a: A absent\n}\nscheduler fast\n")
    with pytest.raises(MissionError) as caught:
        load_mission(path)
    assert [found.code for found in caught.value.diagnostics] == [Code.UNKNOWN_KIND, Code.UNKNOWN_OPTION]
