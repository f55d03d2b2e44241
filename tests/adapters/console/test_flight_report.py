"""The report of a flight and its tracks from the command line, of a recorded run."""

import csv
from dataclasses import replace
from html.parser import HTMLParser

from recorded import uav

from adapters.console.flight_report import flight_report
from adapters.live.batch import Noting, Saying
from bigactors.cli import main

FOUL = "<script>alert(1)</script>"


class Cells(HTMLParser):
    """The rows of a page's tables, and the names of its elements."""

    def __init__(self, page):
        super().__init__()
        self.rows, self.tags, self.inside = [], set(), False
        self.feed(page)

    def handle_starttag(self, tag, _):
        self.tags.add(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag == "td":
            self.rows[-1].append("")
            self.inside = True

    def handle_endtag(self, tag):
        self.inside &= tag != "td"

    def handle_data(self, data):
        if self.inside:
            self.rows[-1][-1] += data.strip()


def test_replay_writes_a_report_and_show_the_tracks(recording, tmp_path, capsys):
    report, tracks = tmp_path / "flight.html", tmp_path / "tracks.csv"
    assert main(["replay", str(recording), "--report", str(report)]) == 0
    assert main(["show", "--trace", str(recording), "--output", str(tracks)]) == 0
    assert f"report written to {report}" in capsys.readouterr().err
    rows = Cells(report.read_text()).rows
    assert ["end", "the mission has ended"] in rows
    assert ["uav0", "UAV", "00:16:40", "00:17:42", "3.56 km", ""] in rows
    assert ["00:17:41", "someone", 'say "handover"', "op", "confirmed"] in rows
    (lost,) = [row for row in rows if "lost link" in row]
    assert lost[2:] == ["uav0", "nothing was heard of uav0 for 2 s", "not acknowledged"]
    names = {row["name"] for row in csv.DictReader(tracks.read_text().splitlines())}
    assert names == {"uav0", "boat0", *(f"mmsi{n}" for n in range(7))}


def test_a_report_is_of_a_recorded_flight(tmp_path, capsys):
    trace = tmp_path / "run.json"
    main(["simulate", "oil_spill", "--steps", "1", "--json", str(trace)])
    assert main(["replay", str(trace), "--report", str(tmp_path / "r.html")]) == 2
    assert "a report is of a recorded flight" in capsys.readouterr().err


def test_what_others_say_is_text_in_a_report(tape, flight):
    flight.turn(1, uav((37.011, -8.65), 1), sayings=[Noting(FOUL, FOUL), Saying("op", FOUL, FOUL)])
    page = Cells(flight_report(tape.history().facts))
    assert any(row[1:] == [FOUL, "note", FOUL, "confirmed"] for row in page.rows)
    assert "script" not in page.tags


def test_a_rehearsal_is_no_flight_in_its_report(tape, flight):
    flight.turn(1, uav((37.011, -8.65), 1))
    facts = tape.history().facts
    for run, told in (
        (facts.run, []),
        (replace(facts.run, vehicles={"uav0": "autopilot simulated:plane"}), [["simulated", "uav0"]]),
        (replace(facts.run, rate=8.0), [["simulated", "its time"]]),
    ):
        rows = Cells(flight_report(replace(facts, run=run))).rows
        assert [row for row in rows if row[:1] == ["simulated"]] == told
