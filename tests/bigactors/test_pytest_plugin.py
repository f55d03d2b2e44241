"""Missions as tests: what pytest collects, runs and says, in this process and in others."""

import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import checker
from bigactors.check_outputs import result_on

pytest_plugins = ["pytester"]

LOADED = result_on
"""What the plugin needs is loaded before pytester forgets what was loaded: numpy is not loaded twice in a process."""

ASKED = "[pytest]\nmission_files = *.mission\n"


@pytest.fixture
def texts(missions):
    """Return the missions that others are made of, by name."""
    return {path.stem: path.read_text(encoding="utf-8") for path in missions.glob("*.mission")}


@pytest.fixture
def folder(texts, pytester, monkeypatch):
    """Go to a folder with a mission that holds and one that races; only the plugins that are named are loaded."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    put(pytester, holds=texts["holds"], race=texts["race"])
    return pytester


def put(folder, **texts):
    """Write missions into a folder, by name."""
    for name, text in texts.items():
        (folder.path / f"{name}.mission").write_text(text, encoding="utf-8")


def ran(folder, *words, **settings):
    """Run pytest with the plugin, in this process."""
    if settings:
        folder.makeini("[pytest]\n" + "".join(f"{name} = {value}\n" for name, value in settings.items()))
    return folder.runpytest("-p", "bigactors.pytest_plugin", "-p", "no:asyncio", *words)


VIOLATED = "race.mission::race_freedom\n  race.mission::stays*"
TIMED = ("holds.mission", "--mission-control", "timed", "--mission-engine", "reference")


@pytest.mark.parametrize(
    ("words", "settings", "outcomes"),
    [
        ((), {}, {}),
        (("holds.mission",), {}, {"passed": 5}),
        ((), {"mission_files": "h*.mission"}, {"passed": 5}),
        ((), {"mission_files": "elsewhere/*.mission"}, {}),
        (TIMED, {}, {"passed": 5}),
        (("race.mission", "--mission-scheduler", "unordered"), {}, {"passed": 1, "failed": 2}),
        ((), {"mission_files": "*.mission", "mission_violated": VIOLATED}, {"passed": 6, "xfailed": 2}),
    ],
)
def test_what_is_given_or_configured_is_collected_and_checked_as_options_say(
    folder, words, settings, outcomes
):
    ran(folder, *words, **settings).assert_outcomes(**outcomes)


def test_each_property_is_a_test_at_its_line(folder):
    result = ran(folder, "--collect-only", "-q", "race.mission")
    names = ("race_freedom", "stays at home", "computation")
    assert result.outlines[:3] == [f"race.mission::{name}" for name in names]
    result = ran(folder, "-v", "race.mission::race_freedom")
    result.assert_outcomes(failed=1)


def test_a_property_that_is_violated_fails_with_its_shortest_trace(folder):
    result = ran(folder, "race.mission")
    result.assert_outcomes(passed=1, failed=2)
    result.stdout.fnmatch_lines(
        [
            "race.mission:15: race_freedom violated: control race",
            "a shortest trace, 2 steps:",
            "  c0 --⟨req_ctr : a, control(MOVE_HOST_TO searchArea0)⟩--> c1",
            "race.mission:*: stays at home violated: invariant",
            "FAILED race.mission::race_freedom - race.mission:15: race_freedom violated: c*",
        ]
    )
    assert "Traceback" not in result.stdout.str()
    assert "pytest_plugin.py" not in result.stdout.str()


def test_what_a_limit_leaves_undecided_fails_with_the_reason(folder, texts):
    put(folder, endless=texts["endless"])
    result = ran(folder, "endless.mission", "--mission-max-configurations", "20")
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(
        ["*: deadlock_freedom incomplete", "not decided; stopped at the limit of 20 configurations: *"]
    )


def test_a_limit_is_read_as_on_the_command_line(folder):
    result = ran(folder, "holds.mission", "--mission-max-time", "-1")
    assert result.ret == pytest.ExitCode.USAGE_ERROR
    result.stderr.fnmatch_lines(["*--mission-max-time: '-1' is not a number of seconds above 0"])


def test_the_mistakes_of_a_mission_are_an_error_of_collection(folder, texts):
    put(folder, mistaken=texts["mistaken"])
    result = ran(folder, mission_files="*.mission")
    assert result.ret == pytest.ExitCode.INTERRUPTED
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(
        [
            "mistaken.mission:17:24: LS201: unknown name 'serchArea0'",
            "  17 |   control(MOVE_HOST_TO serchArea0)",
            "     |                        ^^^^^^^^^^",
            "  hint: did you mean 'searchArea0'?",
        ],
        consecutive=True,
    )


def test_a_mission_in_which_nobody_acts_is_an_error_of_collection(folder):
    put(folder, empty="")
    result = ran(folder, "empty.mission")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["empty.mission:1:1: LS*: the file declares nothing"])


def test_what_holds_and_had_to_be_violated_fails(folder):
    result = ran(folder, mission_files="holds.mission", mission_violated="*::deadlock_freedom")
    result.assert_outcomes(passed=4, failed=1)
    result.stdout.fnmatch_lines(["*XPASS(strict)*mission_violated*"])


def test_what_is_undecided_is_not_as_expected(folder, texts):
    put(folder, endless=texts["endless"])
    settings = {"mission_files": "endless.mission", "mission_violated": "*::deadlock_freedom"}
    ran(folder, "--mission-max-configurations", "20", **settings).assert_outcomes(failed=2)


def test_warnings_on_a_mission_are_warnings_of_pytest(folder, texts):
    text = texts["holds"].replace("check {", 'check {\n  invariant "i": forall v: Nobody . v in base0')
    text = text.replace("kind UAV driven", "kind UAV driven\n  kind Nobody")
    put(folder, weak=text)
    result = ran(folder, "weak.mission", "-W", "default::bigactors.pytest_plugin.MissionWarning")
    result.assert_outcomes(passed=6, warnings=2)
    result.stdout.fnmatch_lines(["*weak.mission:26: MissionWarning: there is no entity of kind Nobody: *"])
    strict = ran(folder, "weak.mission", "-W", "error::bigactors.pytest_plugin.MissionWarning")
    strict.assert_outcomes(passed=5, failed=1)
    assert "Traceback" not in strict.stdout.str()
    assert "warn_explicit" not in strict.stdout.str()


def test_a_mission_is_explored_once_and_for_what_is_selected(folder, monkeypatch):
    asked, honest = [], checker.check
    monkeypatch.setattr(
        checker, "check", lambda *rest, **more: asked.append(len(rest[1])) or honest(*rest, **more)
    )
    ran(folder, mission_files="*.mission")
    assert asked == [5, 3]
    asked.clear()
    ran(folder, "-k", "race_freedom").assert_outcomes(passed=1, failed=1, deselected=6)
    assert asked == [1, 1]
    asked.clear()
    ran(folder, "-m", "not mission").assert_outcomes(deselected=8)
    assert asked == []


def test_what_failed_last_is_run_again(folder):
    ran(folder, mission_files="*.mission").assert_outcomes(passed=6, failed=2)
    ran(folder, "--lf").assert_outcomes(failed=2)


def test_each_property_is_a_case_of_junit(folder):
    ran(folder, "--junit-xml=report.xml", mission_files="*.mission")
    cases = ET.parse(folder.path / "report.xml").getroot().findall(".//testcase")
    failed = {case.get("name"): case.find("failure") for case in cases if case.find("failure") is not None}
    assert len(cases) == 8
    assert failed.keys() == {"race_freedom", "stays at home"}
    assert "race_freedom violated: control race" in failed["race_freedom"].text


def test_workers_share_missions(folder):
    result = ran(folder, "-p", "xdist", "-n", "2", mission_files="*.mission")
    result.assert_outcomes(passed=6, failed=2)


def test_a_whole_run_in_a_process_of_its_own(folder):
    (folder.path / "pytest.ini").write_text(ASKED, encoding="utf-8")
    words = ["-m", "pytest", "-p", "bigactors.pytest_plugin", "--strict-config", "--strict-markers"]
    done = subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, check=False, encoding="utf-8"
    )
    assert done.returncode == 1
    assert "2 failed, 6 passed" in done.stdout


def test_pytest_loads_the_plugin_and_little_else_where_bigactors_is_installed(tmp_path):
    project = Path(__file__).parents[2] / "pyproject.toml"
    declared = tomllib.loads(project.read_text("utf-8"))["project"]["entry-points"]["pytest11"]
    assert declared == {"bigactors": "bigactors.pytest_plugin"}
    script = (
        "import sys, pytest\n"
        "from bigactors import pytest_plugin\n"
        "pytest.main(['--version'], plugins=[pytest_plugin])\n"
        "print(*sorted({name.split('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    slow = {"checker", "lark", "networkx", "numpy", "semantics", "shapely", "specs"}
    assert not set(done.stdout.split()) & slow
