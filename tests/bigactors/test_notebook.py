"""What notebooks show: through IPython's formatter, as one value after another is the last of a cell."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ET

import pytest
from IPython.core.formatters import DisplayFormatter

import bigactors
from bigactors import notebook
from checker import Limits

HOSTILE = '<script>alert("1")</script>&'


@pytest.fixture(scope="module")
def mission():
    return bigactors.load_mission("look_before_entry_racy")


@pytest.fixture(scope="module")
def report(mission):
    return bigactors.check(mission)


def shown(value):
    """Return what a notebook is given of a value, by its type."""
    display = DisplayFormatter()
    notebook.register(display)
    data, _ = display.format(value)
    return data


def test_a_running_ipython_shows_reports_once_the_package_is_imported():
    cells = """
import bigactors
html = get_ipython().display_formatter.formatters["text/html"]
html.enabled = True  # a terminal shows texts only
print(html(bigactors.check(bigactors.load_mission("oil_spill"))))
"""
    line = [sys.executable, "-m", "IPython", "--no-banner", "--colors=NoColor", "-c", cells]
    done = subprocess.run(line, capture_output=True, text=True, check=True, timeout=300)
    assert "race_freedom" in done.stdout
    assert "<table>" in done.stdout


def test_a_configuration_is_a_picture_of_bigraph_and_map(mission):
    data = shown(mission.initial)
    assert data["text/plain"] == repr(mission.initial)
    picture = ET.fromstring(data["image/svg+xml"])
    assert picture.tag.endswith("svg")
    assert re.fullmatch(r"width:100%;max-width:[\d.]+pt;height:auto", picture.get("style"))


def test_the_steps_of_a_race_carry_their_words(report):
    race = next(each for each in report.verdicts["race_freedom"].violations if each.trace.race)
    html = shown(race.trace)["text/html"]
    assert re.findall(r"\[(sensed|changed|acted)\]", html) == ["sensed", "changed", "acted"]


def test_a_bigraph_is_a_picture_and_what_is_too_large_for_one_is_a_line(mission, monkeypatch):
    bigraph = mission.initial.structure.logical.bigraph()
    assert shown(bigraph)["image/svg+xml"] == shown(bigraph)["image/svg+xml"]
    assert ET.fromstring(shown(bigraph)["image/svg+xml"]).tag.endswith("svg")
    monkeypatch.setattr(notebook, "MOST_ENTITIES", 4)
    monkeypatch.setattr("bigraphs.bigraph.MOST_DRAWN", 4)
    assert set(shown(mission.initial)) == set(shown(bigraph)) == {"text/plain"}


def parsed(html):
    """Return what is in HTML that is XML too."""
    return ET.fromstring(html.replace("<br>", "<br/>"))


def test_a_report_is_a_table_whose_violations_unfold(report):
    table = parsed(shown(report)["text/html"])
    rows = [["".join(cell.itertext()) for cell in row] for row in table.iterfind("table/tr")]
    assert [row[:2] for row in rows if row[0]] == [
        ["✓", "local_consistency"],
        ["✗", "race_freedom"],
        ["✓", "deadlock_freedom"],
        ["✓", "computation"],
    ]
    (row, *_) = parsed(shown(report.verdicts["deadlock_freedom"])["text/html"])
    assert ["".join(cell.itertext()) for cell in row][:2] == ["✓", "deadlock_freedom"]
    unfolded = table.findall(".//details")
    assert len(unfolded) == len(report.verdicts["race_freedom"].violations) == 2
    assert "".join(unfolded[0].find("summary").itertext()).startswith("stale-observation race: CTR(b, ")
    assert len(unfolded[0].findall(".//tr")) == 1 + 12
    assert "53 configurations, 86 transitions, depth " in "".join(table.itertext())


def test_a_report_that_is_incomplete_says_why(mission):
    cut_off = bigactors.check(mission, limits=Limits(configurations=5))
    text = "".join(parsed(shown(cut_off)["text/html"]).itertext())
    assert "INCOMPLETE" in text
    assert "stopped at the limit of 5 configurations" in text


def test_a_trace_is_a_table_with_a_column_for_each_agent(report):
    trace = report.verdicts["race_freedom"].violations[0].trace
    table = parsed(shown(trace)["text/html"]).find("table")
    assert ["".join(cell.itertext()) for cell in table[0]] == ["", "a", "b", "changes"]
    assert len(table) == 1 + 12
    last = ["".join(cell.itertext()) for cell in table[12]]
    assert last[:3] == ["c12", "", "[acted] actuate CTR(b, MOVE_HOST_TO gate0)"]
    assert "uav1 : south0 ↦ gate0" in last[3]


def test_of_a_long_trace_the_first_steps_are_shown_and_those_of_a_race(report, monkeypatch):
    monkeypatch.setattr(notebook, "MOST_STEPS", 5)
    trace = report.verdicts["race_freedom"].violations[0].trace
    html = parsed(shown(trace)["text/html"])
    numbers = [row[0].text for row in html.find("table")[1:]]
    assert numbers == ["c1", "c2", "c3", "c4", "c5", "c7", "c8", "c12"]
    assert "not shown: 4 more steps" in "".join(html.itertext())


def test_a_trace_that_comes_round_says_so():
    report = bigactors.check(bigactors.load_mission("surveillance"))
    trace = report.verdicts["somebody is watched for ever"].witness
    assert "again and again" in shown(trace)["text/html"]


def test_no_text_of_a_mission_is_taken_for_markup(tmp_path):
    path = tmp_path / "hostile.mission"
    path.write_text(
        "signature { kind Boat driven }\nworld { boat0: Boat = point (37, -8) }\n"
        f"BigActor a hosted_at boat0 with_behavior {{ send '{HOSTILE}' to a }}\n"
        f"check {{ invariant '{HOSTILE}': not pending SND a }}\n".replace("'", '"').replace('"1"', r"\"1\""),
        encoding="utf-8",
    )
    report = bigactors.check(bigactors.load_mission(path))
    html = shown(report)["text/html"]
    assert HOSTILE in "".join(parsed(html).itertext())
    assert "<script" not in html


def test_what_is_shown_needs_nothing_else_and_no_colour_of_the_page(mission, report):
    trace = report.verdicts["race_freedom"].violations[0].trace
    for html in (shown(report)["text/html"], shown(trace)["text/html"]):
        assert not re.search(r"https?://|<style|<script|class=|background|color:(?:white|black)", html)
    svg = shown(mission.initial)["image/svg+xml"]
    assert not re.search(r'(?:href|src)="(?!#)', svg)


@pytest.mark.long
@pytest.mark.filterwarnings("default")  # those of Jupyter's own libraries
def test_an_executed_notebook_has_pictures_and_tables(tmp_path):
    client, forms = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    cells = (
        "from bigactors import check, load_mission\nmission = load_mission('broken_deadlock')\nmission.initial",
        "report = check(mission)\nreport",
        "report.verdicts['deadlock_freedom'].violations[0].trace",
    )
    book = forms.v4.new_notebook(cells=list(map(forms.v4.new_code_cell, cells)))
    client.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(tmp_path)}}).execute()
    picture, table, trace = (cell["outputs"][0]["data"] for cell in book.cells)
    assert picture["image/svg+xml"].startswith("<svg ")
    assert "deadlock_freedom" in table["text/html"]
    assert "<table" in trace["text/html"]
