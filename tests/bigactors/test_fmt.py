import os
import stat

import pytest

import specs

UGLY = "mission   m\nsignature { kind Place // a place\n }\nworld { p0 : Place=box (1,2) (3 , 4) }\n"
NEAT = (
    "mission m\n\nsignature {\n  kind Place  // a place\n}\n\nworld {\n  p0: Place = box (1, 2) (3, 4)\n}\n"
)


@pytest.fixture
def ugly(missions):
    path = missions / "ugly.mission"
    path.write_text(UGLY)
    path.chmod(0o640)
    return path


def test_a_mission_is_laid_out_and_its_comments_are_kept(ugly, done):
    assert done("fmt", "ugly.mission") == "ugly.mission formatted\n"
    assert ugly.read_text() == NEAT
    assert stat.S_IMODE(ugly.stat().st_mode) == 0o640
    assert done("fmt", "ugly.mission") == done("fmt", "--check", "ugly.mission") == ""


def test_check_and_stdout_write_nothing(ugly, bigactors, done):
    assert bigactors("fmt", "--check", "ugly.mission") == (1, "ugly.mission would be formatted\n", "")
    assert done("fmt", "--stdout", "ugly.mission") == NEAT
    assert ugly.read_text() == UGLY


@pytest.mark.usefixtures("ugly")
@pytest.mark.parametrize(
    ("data", "said"), [(b"mission m\r\nworld {", "broken.mission:2:"), (b"\xff\xfe\x00", "LS002")]
)
def test_what_does_not_parse_is_left_alone_and_the_others_are_formatted(missions, bigactors, data, said):
    (missions / "broken.mission").write_bytes(data)
    code, out, err = bigactors("fmt", "broken.mission", "ugly.mission", "nowhere.mission")
    assert (code, out) == (2, "ugly.mission formatted\n")
    assert said in err
    assert "nowhere.mission: No such file" in err
    assert (missions / "broken.mission").read_bytes() == data


def test_a_link_stays_a_link(ugly, missions, done):
    os.symlink("ugly.mission", missions / "link.mission")
    done("fmt", "link.mission")
    assert (missions / "link.mission").is_symlink()
    assert ugly.read_text() == NEAT


def test_a_formatter_that_would_change_what_is_said_is_our_bug_and_destroys_nothing(
    ugly, bigactors, monkeypatch
):
    monkeypatch.setattr(specs, "format_mission", lambda *_: "mission other\n")
    code, _, err = bigactors("fmt", "ugly.mission")
    assert code == 4
    assert "would change its meaning" in err
    assert ugly.read_text() == UGLY


def test_nothing_is_left_behind_where_writing_fails(ugly, missions, refused, monkeypatch):
    def refuse(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    before = sorted(path.name for path in missions.iterdir())
    assert "No space left on device" in refused("fmt", "ugly.mission")
    assert sorted(path.name for path in missions.iterdir()) == before
    assert ugly.read_text() == UGLY
