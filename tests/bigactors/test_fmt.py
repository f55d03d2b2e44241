import os
import stat

import specs

UGLY = "mission   m\nsignature { kind Place // a place\n }\nworld { p0 : Place=box (1,2) (3 , 4) }\n"
NEAT = (
    "mission m\n\nsignature {\n  kind Place  // a place\n}\n\nworld {\n  p0: Place = box (1, 2) (3, 4)\n}\n"
)


def test_a_mission_is_laid_out_and_its_comments_are_kept(missions, bigactors):
    path = missions / "ugly.mission"
    path.write_text(UGLY)
    path.chmod(0o640)
    assert bigactors("fmt", "ugly.mission") == (0, "ugly.mission formatted\n", "")
    assert path.read_text() == NEAT
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert bigactors("fmt", "ugly.mission") == (0, "", "")


def test_check_writes_nothing(missions, bigactors):
    path = missions / "ugly.mission"
    path.write_text(UGLY)
    assert bigactors("fmt", "--check", "ugly.mission") == (1, "ugly.mission would be formatted\n", "")
    assert path.read_text() == UGLY
    path.write_text(NEAT)
    assert bigactors("fmt", "--check", "ugly.mission") == (0, "", "")


def test_the_result_is_printed_if_asked(missions, bigactors):
    path = missions / "ugly.mission"
    path.write_text(UGLY)
    assert bigactors("fmt", "--stdout", "ugly.mission") == (0, NEAT, "")
    assert path.read_text() == UGLY


def test_what_does_not_parse_is_left_alone_and_the_others_are_formatted(missions, bigactors):
    broken, ugly = missions / "broken.mission", missions / "ugly.mission"
    broken.write_bytes(b"mission m\r\nworld {")
    ugly.write_text(UGLY)
    code, out, err = bigactors("fmt", "broken.mission", "ugly.mission", "nowhere.mission")
    assert (code, out) == (2, "ugly.mission formatted\n")
    assert "broken.mission:2:" in err
    assert "nowhere.mission: No such file" in err
    assert broken.read_bytes() == b"mission m\r\nworld {"


def test_what_is_no_text_is_left_alone(missions, bigactors):
    path = missions / "binary.mission"
    path.write_bytes(b"\xff\xfe\x00")
    code, _, err = bigactors("fmt", "binary.mission")
    assert code == 2
    assert "LS002" in err
    assert path.read_bytes() == b"\xff\xfe\x00"


def test_a_link_stays_a_link(missions, bigactors):
    (missions / "ugly.mission").write_text(UGLY)
    os.symlink("ugly.mission", missions / "link.mission")
    assert bigactors("fmt", "link.mission")[0] == 0
    assert (missions / "link.mission").is_symlink()
    assert (missions / "ugly.mission").read_text() == NEAT


def test_a_formatter_that_would_change_what_is_said_is_our_bug_and_destroys_nothing(
    missions, bigactors, monkeypatch
):
    (missions / "ugly.mission").write_text(UGLY)
    monkeypatch.setattr(specs, "format_mission", lambda *_: "mission other\n")
    code, _, err = bigactors("fmt", "ugly.mission")
    assert code == 4
    assert "would change what it says" in err
    assert (missions / "ugly.mission").read_text() == UGLY


def test_nothing_is_left_behind_where_writing_fails(missions, bigactors, monkeypatch):
    (missions / "ugly.mission").write_text(UGLY)

    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    before = sorted(path.name for path in missions.iterdir())
    code, _, err = bigactors("fmt", "ugly.mission")
    assert code == 2
    assert "No space left on device" in err
    assert sorted(path.name for path in missions.iterdir()) == before
    assert (missions / "ugly.mission").read_text() == UGLY
