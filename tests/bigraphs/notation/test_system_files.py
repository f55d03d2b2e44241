import pytest

from bigraphs.errors import BigraphError, NotationError
from bigraphs.examples import example_text
from bigraphs.notation import load_system, read_bgm, read_system

BGM = "%active a : 0; a; a -> a.a; %check;"


def test_the_suffix_says_which_language_a_file_is_in(tmp_path):
    (tmp_path / "one.big").write_text(example_text("actors"))
    (tmp_path / "two.bgm").write_text(BGM)
    assert load_system(tmp_path / "one.big") == read_system(example_text("actors"))
    assert load_system(str(tmp_path / "two.bgm")) == read_bgm(BGM)


def test_a_file_that_cannot_be_read_is_told(tmp_path):
    (tmp_path / "latin.big").write_bytes(b"# \xe9\n")
    (tmp_path / "large.big").write_bytes(b"#" * 1_000_001)
    (tmp_path / "two.bgm").write_text(BGM)
    with pytest.raises(BigraphError, match="cannot be read: No such file"):
        load_system(tmp_path / "none.big")
    with pytest.raises(BigraphError, match="is not UTF-8 at byte 2"):
        load_system(tmp_path / "latin.big")
    with pytest.raises(NotationError, match="longer than 1 MB"):
        load_system(tmp_path / "large.big")
    (tmp_path / "one.txt").write_text("")
    with pytest.raises(BigraphError, match=r"neither a \.big nor a \.bgm file"):
        load_system(tmp_path / "one.txt")
    with pytest.raises(BigraphError, match="has no constants"):
        load_system(tmp_path / "two.bgm", constants={"n": 1})


def test_a_file_that_is_not_there_is_not_said_to_have_the_wrong_name(tmp_path):
    with pytest.raises(BigraphError, match="cannot be read: No such file"):
        load_system(tmp_path / "prob.bgi")
