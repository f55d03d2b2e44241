"""The first mission: it is written, it holds, and it breaks as it says."""

import re

import pytest

from bigactors.commands.new import new_mission


@pytest.fixture
def here(tmp_path, monkeypatch):
    """Go to an empty folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_new_mission_holds_in_the_canonical_layout(here, bigactors, done):
    out = done("new", "patrol")
    assert "\n  bigactors check --watch patrol.mission  " in out
    assert "\nmission patrol\n" in (here / "patrol.mission").read_text("utf-8")
    assert bigactors("fmt", "--check", "patrol.mission") == (0, "", "")
    out = done("check", "patrol.mission")
    assert out.startswith("patrol.mission: 32 configurations, 70 transitions, ")
    assert "warning" not in out


def test_what_it_says_to_do_next_can_be_done(here, bigactors, done):
    out = done("new", "patrol")
    commands = re.findall(r"^  bigactors (\S+) (.*?)  ", out, re.MULTILINE)
    assert [name for name, _ in commands] == ["check", "show"]
    assert bigactors("show", "patrol.mission")[0] == 0
    assert (here / "patrol.svg").is_file()


def test_its_line_breaks_it_with_what_it_promises(here, bigactors):
    bigactors("new", "patrol")
    path = here / "patrol.mission"
    text = path.read_text("utf-8")
    broken, count = re.subn(r"^// (?=BigActor )", "", text, flags=re.MULTILINE)
    assert count == 1
    path.write_text(broken, encoding="utf-8")
    promised = re.search(r"^//   ✗ (\S+)  (\S+)$", text, re.MULTILINE)
    code, out, err = bigactors("check", "patrol.mission")
    assert (code, err) == (1, "")
    assert re.findall(r"^  ✗ (\S+) +(\w+)", out, re.MULTILINE) == [promised.groups()]
    assert "control race: CTR(intruder, MOVE uav0 TO field0) and CTR(pilot, MOVE_HOST_TO bay0)" in out
    assert "a shortest trace, 2 steps" in out


def test_a_path_is_taken_and_the_file_is_named_after_it(here, bigactors):
    (here / "missions").mkdir()
    assert bigactors("new", "missions/patrol.mission")[0] == 0
    assert "\nmission patrol\n" in (here / "missions" / "patrol.mission").read_text("utf-8")


def test_only_the_header_has_the_name():
    assert new_mission("patrol").replace("patrol", "new") == new_mission("new")
