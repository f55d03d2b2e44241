import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress

import pytest
from processes import begun

from bigactors import checking, trace_files
from bigactors.commands.check import check_report as command
from checker.reports.report import MARKS

pytestmark = pytest.mark.usefixtures("missions")


def test_a_mission_that_holds_is_a_success_with_its_counts(done):
    out = done("check", "holds.mission")
    assert out.startswith("holds.mission: 10 configurations, 10 transitions, depth 8, complete, ")
    assert "\n  ✓ found              holds; examined 1, a witness of 8 steps\n" in out
    assert "\n  rules: actuate 3, fun 1, rcv_obs 1, req_ctr 2, req_obs 2, sense 1\n" in out
    assert "\n  rules never used: req_snd, snd, rcv_msg, timeout, req_mgr, migrate, spawn\n" in out


def test_a_violation_is_shown_with_its_trace_unless_that_is_not_asked_for(bigactors):
    code, out, err = bigactors("check", "race.mission")
    assert (code, err) == (1, "")
    assert "  ✗ race_freedom   violated" in out
    assert "c0 --⟨req_ctr : a, control(MOVE_HOST_TO searchArea0)⟩--> c1" in out
    assert "L  parent(uav0) : base0 ↦ searchArea0" in out
    code, out, _ = bigactors("check", "race.mission", "--no-traces")
    assert (code, "--⟨" in out, "a shortest trace, 2 steps" in out) == (1, False, True)


def test_a_mistake_is_rendered_and_nothing_is_checked(refused):
    err = refused("check", "mistaken.mission")
    assert err == (
        "mistaken.mission:17:24: LS201: unknown name 'serchArea0'\n"
        "  17 |   control(MOVE_HOST_TO serchArea0)\n"
        "     |                        ^^^^^^^^^^\n"
        "  hint: did you mean 'searchArea0'?\n"
    )


@pytest.mark.parametrize("bound", [("--max-configurations", "20"), ("--max-time", "0.3")])
def test_what_was_cut_off_is_no_success(bigactors, bound):
    code, out, _ = bigactors("check", "endless.mission", *bound)
    assert code == 3
    assert "INCOMPLETE" in out
    assert "  to decide more: visit less with --reduce por (docs/explanation/reduction.md); " in out
    assert "\n  stopped at the " in out
    assert "\n  ? deadlock_freedom  incomplete" in out
    assert "✓ deadlock_freedom" not in out
    assert "\n  rules not used so far: req_ctr, " in out


def test_several_missions_get_a_line_each_and_the_gravest_code(bigactors):
    names = ("holds.mission", "race.mission", "endless.mission", "mistaken.mission", "nowhere.mission")
    limit = ("--max-configurations", "20", "--no-traces")
    code, out, err = bigactors("check", *names, *limit)
    assert code == 2
    summary = out.split("\n\n")[-1].splitlines()
    assert [line.split()[:3] for line in summary] == [
        ["✓", "holds.mission", "holds"],
        ["✗", "race.mission", "violated"],
        ["?", "endless.mission", "incomplete"],
        ["!", "mistaken.mission", "mistake"],
        ["!", "nowhere.mission", "mistake"],
    ]
    assert "nowhere.mission: there is no such file" in err
    assert bigactors("check", *names[:3], *limit)[0] == 1
    assert bigactors("check", "holds.mission", "endless.mission", *limit)[0] == 3


def test_with_room_on_a_disk_a_check_goes_on(done):
    out = done("check", "holds.mission", "--max-memory", "64G", "--spill", "there")
    assert out.startswith("holds.mission: 10 configurations, 10 transitions, depth 8, complete, ")


def test_a_bug_at_one_mission_does_not_keep_the_others_from_being_checked(bigactors, monkeypatch):
    honest = checking.check

    def failing(mission, *rest, **more):
        if len(mission.initial.alpha.names()) == 2:
            raise RuntimeError("our bug")
        return honest(mission, *rest, **more)

    monkeypatch.setattr(checking, "check", failing)
    code, out, err = bigactors("check", "race.mission", "holds.mission", "mistaken.mission")
    assert code == 4
    assert "RuntimeError: our bug" in err
    assert "please report" in err
    assert "holds.mission: 10 configurations" in out
    assert "! race.mission      internal error" in out


def test_traces_are_kept_as_text_as_json_and_as_pictures(missions, bigactors):
    code, _, err = bigactors("check", "race.mission", "--no-traces", "--trace", "traces")
    assert code == 1
    folder = missions / "traces" / "race" / "race_freedom-control_race"
    assert sorted(path.name for path in folder.iterdir()) == [
        "c00.svg", "c01.svg", "c02.svg", "trace.html", "trace.json", "trace.svg", "trace.txt",
    ]  # fmt: skip
    text = (folder / "trace.txt").read_text(encoding="utf-8")
    assert text.startswith("race.mission (sha256:")
    assert "race_freedom violated: control race: " in text
    assert "c0 --⟨" in text
    assert (folder / "trace.svg").read_text(encoding="utf-8").startswith("<svg ")
    assert "traces/race/race_freedom-control_race/trace.html" in err


def test_missions_of_one_name_keep_their_traces_apart(missions, bigactors, monkeypatch):
    monkeypatch.setattr(trace_files, "draw_run", lambda *_, **__: None)
    (missions / "sub").mkdir()
    (missions / "sub" / "holds.mission").write_text((missions / "holds.mission").read_text())
    words = ("check", "holds.mission", "sub/holds.mission", "--trace", "traces", "--no-traces")
    assert bigactors(*words)[0] == 0
    assert sorted(path.name for path in (missions / "traces").iterdir()) == ["holds", "holds-2"]


def test_properties_whose_names_differ_in_signs_only_keep_their_traces_apart(
    missions, bigactors, monkeypatch
):
    monkeypatch.setattr(trace_files, "draw_run", lambda *_, **__: None)
    text = (missions / "holds.mission").read_text()
    twice = text.replace('reachable "found"', 'reachable "found!": uav0 in searchArea0\n  reachable "found?"')
    (missions / "twice.mission").write_text(twice)
    assert bigactors("check", "twice.mission", "--trace", "traces")[0] == 0
    found = sorted(path.name for path in (missions / "traces" / "twice").glob("found*"))
    assert found == ["found_-witness", "found_-witness-2"]


def test_the_marks_of_the_summary_are_those_of_the_report():
    assert {sign for sign, _ in command.WORDS.values()} == {*MARKS.values(), "!"}


@pytest.mark.skipif(os.name == "nt", reason="signals and terminals are POSIX's")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda each: each.name)
def test_an_interrupted_exploration_is_incomplete_and_reports_what_it_found(number):
    ours, theirs = os.openpty()
    words = ("check", "endless.mission", "holds.mission", "--no-traces")
    shown = b""
    with begun([sys.executable, "-m", "bigactors", *words], stdout=subprocess.PIPE, stderr=theirs) as process:
        os.close(theirs)
        while b"frontier" not in shown:  # the exploration is under way
            shown += os.read(ours, 1000)
        process.send_signal(number)
        out = process.communicate(timeout=60)[0].decode()
    os.close(ours)
    assert process.returncode == 3
    assert "stopped at an interruption" in out
    assert "? endless.mission  incomplete" in out
    assert "? holds.mission    incomplete  not begun" in out
    assert b"endless: " in shown
    assert b" configurations, depth " in shown
    assert b"Traceback" not in shown


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda each: each.name)
def test_a_second_signal_ends_a_check_at_once(number):
    ours, theirs = os.openpty()
    words = ("check", "endless.mission", "holds.mission", "--no-traces", "--engine", "reference")
    shown = b""
    with begun([sys.executable, "-c", STUCK, *words], stdout=subprocess.PIPE, stderr=theirs) as process:
        os.close(theirs)
        while b"stuck" not in shown:
            shown += os.read(ours, 1000)
        process.send_signal(number)
        while b"heard" not in shown:
            shown += os.read(ours, 1000)
        process.send_signal(number)
        out = process.communicate(timeout=60)[0].decode()
        with suppress(OSError):  # all is read
            shown += os.read(ours, 1000)
    os.close(ours)
    assert process.returncode == 3
    assert "endless.mission: interrupted: nothing is decided of it" in shown.decode()
    assert "? endless.mission  incomplete  interrupted" in out
    assert "holds.mission    incomplete  not begun" in out


STUCK = """
import sys, time
from bigactors import cli
from checker.engines import reference

def stuck(self, number, configuration):
    print("stuck", file=sys.stderr, flush=True)
    while True:
        time.sleep(0.01)
        if self.search.limits.interruption.is_due():
            print("heard", file=sys.stderr, flush=True)
            time.sleep(3600)

reference._Explorer.expand = stuck
sys.exit(cli.main(sys.argv[1:]))
"""

OWNING = """
import fcntl, os, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)  # its session's terminal
os.execv(sys.executable, [sys.executable, "-m", "bigactors", *sys.argv[1:]])
"""


def test_a_terminal_that_closes_ends_an_exploration_with_what_was_found(missions):
    ours, theirs = os.openpty()

    words = ("check", "endless.mission", "--no-traces", "--json", "report.json")
    with begun(
        [sys.executable, "-c", OWNING, *words],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        start_new_session=True,
    ) as process:
        os.close(theirs)
        shown = b""
        while b"frontier" not in shown:
            shown += os.read(ours, 1000)
        os.close(ours)
        assert process.wait(timeout=60) == 3
    report = json.loads((missions / "report.json").read_text(encoding="utf-8"))
    assert report["bounds"] == ["an interruption"]


def test_who_ignores_a_hangup_goes_on_ignoring_it():
    words = ("check", "endless.mission", "--no-traces", "--max-time", "2")
    with begun(["nohup", sys.executable, "-m", "bigactors", *words], stdout=subprocess.PIPE) as process:
        time.sleep(1)
        process.send_signal(signal.SIGHUP)
        out = process.communicate(timeout=60)[0].decode()
    assert "stopped at the time limit of 2 s" in out
    assert "an interruption" not in out


def test_the_signals_handlers_are_put_back(bigactors):
    before = [signal.getsignal(each) for each in (signal.SIGTERM, signal.SIGHUP)]
    assert bigactors("explain", "LS101")[0] == 0
    assert [signal.getsignal(each) for each in (signal.SIGTERM, signal.SIGHUP)] == before
