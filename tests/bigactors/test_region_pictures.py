"""A violated property about regions is drawn: the regions of its entities, the breach, and the nearest points."""

import re

import pytest

from bigactors import check
from bigactors.pages import Story, trace_page
from bigactors.pictures import draw_configuration, marks_of
from bigactors.pictures.region_marks import RegionMarks
from semantics.properties.property import watching
from semantics.properties.region_atoms import WithinRangeOf
from specs.elaboration import load_mission

pytestmark = pytest.mark.usefixtures("missions")


def marked(name):
    """Return the trace of a mission's violated property, and the marks of its end."""
    mission = load_mission(name)
    report = check(mission)
    (verdict,) = (each for each in report.verdicts if each.violations)
    trace = verdict.violations[0].trace
    last = trace.configurations[-1]
    return trace, marks_of(mission.initial, last, [verdict.property], violated=True)


def texts_of(svg):
    return re.findall(r">([^<>]+)</text>", svg.replace("\\u003c", "<"))  # of a page, the pictures are JSON


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("broken_corridor", "uav1 may be in prison0"),
        ("broken_crossing", "may meet"),
        ("broken_range_of_radio", "9,879 m, not 6 km"),
    ],
)
def test_the_breach_of_a_property_is_drawn_with_words(name, text):
    trace, marks = marked(name)
    ways = marks.ways(trace.configurations[-1])
    assert ways.regions
    assert ways.breaches
    texts = texts_of(draw_configuration(trace.configurations[-1], marks=marks).svg)
    assert text in texts
    assert "where it breaks the property" in texts


def test_the_nearest_points_are_drawn_while_something_is_under_way():
    trace, marks = marked("broken_crossing")
    before = [marks.ways(c).spans for c in trace.configurations[:-1]]
    assert [[span.text for span in spans] for spans in before] == [[], [], ["3,286 m"], ["3,286 m"]]
    page = trace_page(Story("crossing", "", True, trace, marks=marks))
    assert "3,286 m" in texts_of(page)
    assert "where it may be" in texts_of(page)


def test_a_range_is_drawn_around_the_station():
    trace, marks = marked("broken_range_of_radio")
    assert len(marks.ways(trace.configurations[-1]).limits) == 1


def test_a_range_is_drawn_around_whichever_of_both_is_certain():
    mission = load_mission("broken_range_of_radio")
    flying = marked("broken_range_of_radio")[0].configurations[-1]
    ways = [
        RegionMarks(watching(mission.initial, mission.properties), (atom,), flying).ways(flying)
        for atom in (WithinRangeOf("uav0", "gcs0", 6_000.0), WithinRangeOf("gcs0", "uav0", 6_000.0))
    ]
    assert ways[0].limits
    assert ways[0] == ways[1]


def test_a_path_leads_by_the_places_of_its_flight():
    trace, marks = marked("broken_corridor")
    (region,) = (each for each in marks.ways(trace.configurations[2]).regions if each.name == "uav1")
    assert [round(north, 3) for north, _ in region.path] == [37.095, 37.075, 37.095]


def test_a_picture_without_such_a_property_is_as_before():
    mission = load_mission("oil_spill")
    assert marks_of(mission.initial, mission.initial, mission.properties) is None


def test_a_shown_trace_has_the_same_marks(bigactors, tmp_path):
    bigactors("check", "broken_crossing", "--trace", str(tmp_path))
    folder = tmp_path / "broken_crossing" / "apart-invariant"
    shown = tmp_path / "shown.svg"
    code, _, _ = bigactors("show", "--trace", str(folder / "trace.json"), "--output", str(shown))
    assert code == 0
    assert "may meet" in texts_of(shown.read_text())
    assert "may meet" in texts_of((folder / "c04.svg").read_text())
