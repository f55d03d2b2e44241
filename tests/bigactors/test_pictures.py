import os
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from drawn_missions import KINDS, PLACEMENTS, SIGNATURE, oil_spill, run

from bigactors.cli import main
from bigactors.pictures import Look, draw_configuration, draw_overview, draw_trace, logical_picture
from bigactors.pictures.page import wrapped
from bigactors.pictures.scene import changed_names, differing, is_place, map_entities, palette_of
from bigactors.pictures.trace import AGENT, AROUND, SERVED, rows_of
from bigraphs.drawing import LINKS
from bigraphs.layout import layout
from bigraphs.link_curves import route
from bigraphs.relational_bigraphs import from_relations
from checker.properties.race_steps import RaceSteps
from checker.reports.lanes import lanes_of
from physical import circle, point
from physical.svg import PictureError, text_width
from semantics.behaviours.program import Program
from semantics.environment import Appears
from semantics.state.configuration import Label
from semantics.state.initial import Beliefs, initial
from semantics.state.physical_model import Placed, channels_cell, placement_cell
from semantics.state.setting import Setting
from semantics.successors import expand
from specs.elaboration import load_mission

ROOT = Path(__file__).parents[2]


def texts_of(picture):
    """Return the lines of text of a picture or of a picture's file, from back to front."""
    svg = picture.read_text("utf-8") if isinstance(picture, Path) else picture.svg
    return [text.text for text in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]


# --- what a picture shows -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("beliefs", "names"),
    [
        (None, set()),
        (Beliefs({"uav0": "searchArea0"}), {"uav0"}),
        (Beliefs(links={"uav0": ()}), {"uav0"}),
        (Beliefs({"oilSpill0": None}), {"oilSpill0"}),
    ],
)
def test_what_is_not_as_it_is_believed_and_what_has_vanished_differs(beliefs, names):
    c = oil_spill(beliefs=beliefs)
    assert differing(c) == names
    assert differing(c.with_({placement_cell("gcs0"): None})) == {*names, "gcs0"}


def test_what_changed_is_told_in_both_models():
    c = oil_spill()
    after = c.with_({placement_cell("uav0"): Placed(point(37.0, -8.6)), channels_cell("gcs0"): ()})
    assert changed_names(c, after) == {"uav0", "gcs0"}
    assert changed_names(c, c) == frozenset()


def test_the_map_shows_what_is_there_and_what_is_only_believed():
    c = oil_spill().with_({placement_cell("gcs0"): None})
    shown = {entity.name: entity for entity in map_entities(c)}
    assert set(shown) == set(KINDS)
    assert shown["gcs0"].geometry is None
    assert shown["drifter0"].carried_by == "vessel0"
    assert shown["searchArea0"].place


def test_what_is_in_transit_shows_both_ends():
    configurations, labels = run(oil_spill())
    flying = configurations[[label.rule for label in labels].index("command") + 1]
    (uav,) = (entity for entity in map_entities(flying) if entity.name == "uav0")
    assert uav.geometry is point(37.06, -8.55)
    assert uav.towards == "searchArea0"
    assert uav.destination is PLACEMENTS["searchArea0"].geometry


def test_a_flight_is_shown_by_the_places_of_its_way():
    """A direct line would cross the prison that the way goes round."""
    c = load_mission("corridor").initial
    while not (flying := [each for each in map_entities(c) if each.name == "uav0" and each.towards]):
        c = next(step.target for step in expand(c).by_agents if "north" in str(step.label))
    assert flying[0].via == (c.structure.physical.position("northGate0").geometry,)


def test_a_place_that_may_appear_elsewhere_is_no_fixed_place():
    still = oil_spill()
    moving = oil_spill(environment=(Appears("oilSpill0", (Placed(circle((37.01, -8.7), 400)),)),))
    assert is_place(still, "oilSpill0")
    assert not is_place(moving, "oilSpill0")
    assert not is_place(still, "uav0")


def test_channels_have_the_colours_that_the_bigraph_gives_them():
    c = oil_spill()
    bigraph = c.structure.logical.bigraph()
    drawn = {str(each.link): LINKS[rank] for rank, each in enumerate(route(layout(bigraph)))}
    assert palette_of(c).channels == drawn


def test_each_kind_has_a_colour_believed_or_not():
    c = oil_spill(beliefs=Beliefs({"oilSpill0": None}))
    assert set(palette_of(c).kinds) == set(KINDS.values())


def test_a_fleet_in_flight_is_one_box_beside_the_one_that_changed():
    fleet = [f"uav{n}" for n in range(50)]
    nodes = dict.fromkeys(fleet, "UAV") | {"searchArea0": "Location"}
    believed = from_relations(nodes, dict.fromkeys(fleet, "searchArea0"), {})
    look = Look(palette_of(oil_spill()), frozenset({"uav7"}), frozenset(fleet))
    assert ("UAV ×49", "uav0, uav1, …") in layout(believed, look.glowing, look.marked).shown.lines
    texts = texts_of(logical_picture(believed, look, "L"))
    assert {"UAV ×49", "uav7"} <= set(texts)
    assert "uav8" not in texts


# --- configurations -------------------------------------------------------------------------------


def test_every_entity_agent_and_request_appears():
    texts = texts_of(draw_configuration(run(oil_spill())[0][2], title="Oil spill"))
    assert {"Oil spill", "searcher@uav0", *KINDS} <= set(texts)
    assert all(texts.count(name) >= 2 for name in KINDS)  # in L and in P
    assert any(text.startswith("(searcher, MOVE_HOST_TO searchArea0)") for text in texts)


def test_the_legend_says_what_dashes_and_glow_mean():
    c = oil_spill(beliefs=Beliefs({"uav0": "searchArea0"}))
    after = c.with_({placement_cell("vessel0"): Placed(point(37.0, -8.6))})
    texts = texts_of(draw_configuration(after, changed=c))
    assert {"L and P differ", "changed in this step"} <= set(texts)
    plain = texts_of(draw_configuration(oil_spill()))
    assert not {"L and P differ", "changed in this step"} & set(plain)


def test_a_picture_is_the_same_twice(tmp_path):
    c = oil_spill(beliefs=Beliefs({"uav0": "searchArea0"}))
    for name in ("a.png", "b.png"):
        draw_configuration(c, title="twice", changed=c).save(tmp_path / name)
    one, other = ((tmp_path / name).read_bytes() for name in ("a.png", "b.png"))
    assert one == other
    assert len(one) > 10_000


def test_text_in_an_svg_is_text_that_can_be_searched():
    picture = draw_configuration(oil_spill(), title="a <oil> spill")
    texts = texts_of(picture)
    assert {"searchArea0", "uav0", "coasts ± 1 km", "control:gcs0"} <= set(texts)
    assert texts.count("a <oil> spill") == 1
    assert not re.search(r'<style|class=|\bid="', picture.svg)  # other pictures of a page stay as they are
    assert len(picture.svg.encode()) < 40_000


def test_what_is_folded_tells_its_names_in_an_svg():
    svg = draw_configuration(crowd(100)).svg
    names = re.findall(r'<g data-names="([^"]*)"><title>\1</title><text', svg)
    assert names == [", ".join(f"uav{n}" for n in range(100))] * 2  # in L and on the map
    assert len(svg.encode()) < 40_000


def crowd(count):
    """Return UAVs in one place."""
    names = [f"uav{n}" for n in range(count)]
    setting = Setting(SIGNATURE, {"searchArea0": "Location"} | dict.fromkeys(names, "UAV"), Program())
    there = Placed(point(37.0, -8.7))
    return initial(setting, {"searchArea0": PLACEMENTS["searchArea0"]} | dict.fromkeys(names, there), {}, {})


def test_another_suffix_is_refused(tmp_path):
    with pytest.raises(PictureError, match=r"cannot write a picture as 'c.pdf': name it .svg or .png"):
        draw_configuration(oil_spill()).save(tmp_path / "c.pdf")


def test_an_empty_world_has_a_picture():
    c = initial(Setting(SIGNATURE, {}, Program()), {}, {}, {})
    assert "not in P" not in " ".join(texts_of(draw_configuration(c)))


def test_pictures_are_the_same_under_two_hash_seeds(tmp_path):
    program = (
        "import sys; sys.path[:0] = sys.argv[1:3]; import test_pictures; test_pictures.draw_two(sys.argv[3])"
    )
    seed = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    here = Path(__file__).parent
    command = [sys.executable, "-c", program, str(here), str(here.parent), str(tmp_path / "there")]
    subprocess.run(command, env={**os.environ, "PYTHONHASHSEED": seed}, check=True)
    draw_two(tmp_path / "here")
    for ending in ("c.svg", "t.svg"):
        assert (tmp_path / f"here{ending}").read_bytes() == (tmp_path / f"there{ending}").read_bytes()


def draw_two(stem):
    """Draw a configuration and a trace, named by a stem."""
    configurations, labels = run(oil_spill())
    draw_configuration(configurations[3], changed=configurations[2]).save(f"{stem}c.svg")
    draw_overview(lanes_of(configurations, labels)).save(f"{stem}t.svg")


@pytest.mark.parametrize(
    ("mission", "evidence"),
    [("oil_spill", "over_the_spill-witness"), ("broken_inconsistent", "local_consistency-inconsistent")],
)
def test_the_pictures_of_the_readme_say_what_is_drawn_today(tmp_path, mission, evidence, capsys):
    main(["check", mission, "--trace", str(tmp_path)])
    trace = tmp_path / mission / evidence / "trace.json"
    main(["show", "--trace", str(trace), "--output", str(tmp_path / "now.svg")])
    capsys.readouterr()
    kept = ROOT / "docs" / "pictures" / f"{mission}.svg"
    assert texts_of(kept) == texts_of(tmp_path / "now.svg"), "make pictures"


# --- traces ---------------------------------------------------------------------------------------


def test_a_trace_is_a_picture_a_step_and_an_overview(tmp_path):
    configurations, labels = run(oil_spill())
    paths = draw_trace(configurations[:3], labels[:2], tmp_path, title="Oil spill")
    assert [path.name for path in paths] == ["c00.svg", "c01.svg", "c02.svg", "trace.svg"]
    assert all(path.stat().st_size > 1000 for path in paths)
    assert 'href="c01.svg"' in paths[-1].read_text()


def test_the_steps_of_a_race_carry_their_words_in_the_overview_and_in_each_picture(tmp_path):
    configurations, labels = run(oil_spill())
    race = RaceSteps(1, 2, 3)
    paths = draw_trace(configurations[:4], labels[:3], tmp_path, title="Oil spill", race=race)
    found = [text for text in texts_of(paths[-1]) if text in race.roles.values()]
    assert found == [
        "changed",
        "sensed",
        "changed",
        "acted",
    ]  # the head of what each step changed comes first
    for path, word in zip(paths[:-1], ("", "[sensed]", "[changed]", "[acted]"), strict=True):
        assert any(word in text for text in texts_of(path))
    assert not any("[" in text for text in texts_of(paths[0]))


def test_steps_stand_in_the_lanes_of_who_takes_them_and_the_environment_has_one_of_its_own():
    lanes = lanes_of(*run(oil_spill()))
    assert lanes.names == ("searcher",)
    colours = {row.rule: row.colours for row in rows_of(lanes)}
    assert colours["req_ctr"] == colours["req_obs"] == colours["rcv_obs"] == AGENT
    assert colours["command"] == colours["commit"] == colours["sense"] == SERVED
    c = oil_spill()
    after = c.with_({placement_cell("gcs0"): None})
    lanes = lanes_of([c, after], [Label("env", None, "gcs0 vanishes")])
    assert lanes.names == ("searcher", "environment")
    assert [(row.lane, row.colours) for row in rows_of(lanes)] == [(1, AROUND)]


def test_a_row_tells_only_what_changed():
    rows = rows_of(lanes_of(*run(oil_spill())))
    (commit,) = (row for row in rows if row.rule == "commit")
    assert "L  uav0 : region ↦ searchArea0" in commit.changes
    assert not any("vessel0 :" in line for row in rows for line in row.changes)


def test_every_step_appears_in_the_overview():
    configurations, labels = run(oil_spill())
    texts = texts_of(draw_overview(lanes_of(configurations, labels), title="Oil spill"))
    assert {f"c{step}" for step in range(1, len(configurations))} <= set(texts)
    assert {label.rule for label in labels} <= set(texts)


def test_where_time_passes_an_overview_has_gaps_as_high_as_it_is_long():
    configurations, labels = run(oil_spill())
    moments = [0, 0, 60_000, *[180_000] * (len(labels) - 3)]
    lanes = lanes_of(configurations, labels, None, moments)
    first, still, later, latest, *rest = rows_of(lanes)
    assert (first.gap, still.gap, [row.gap for row in rest]) == (0, 0, [0] * len(rest))
    assert latest.gap == 2 * later.gap > 0
    texts = texts_of(draw_overview(lanes))
    assert [each for each in texts if ":" in each and each[0].isdigit()] == ["0:00", "1:00", "3:00"]
    assert {"+ 1 min", "+ 2 min"} <= set(texts)


def test_a_trace_of_no_step_has_an_overview():
    assert texts_of(draw_overview(lanes_of([oil_spill()], [])))[-2:] == ["changed", "by each step"]


def test_wrapped_lines_fit_and_lose_nothing_while_there_is_room():
    text = "READY(searcher, CHILDREN(PARENT(uav0)), {oilSpill0, searchArea0, uav0})"
    lines = wrapped(text, 110.0, 7.0, 6)
    assert all(text_width(line, 7.0) <= 110.0 for line in lines)
    assert "".join(lines).replace(" ", "") == text.replace(" ", "")
    assert wrapped(text, 110.0, 7.0, 2)[-1].endswith("…")
    assert wrapped("", 110.0, 7.0, 2) == ()
