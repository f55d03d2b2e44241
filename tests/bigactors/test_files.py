import os

import pytest

from bigactors.files import read_json, write_text
from bigactors.mistakes import Mistake


def test_a_new_file_has_the_rights_that_new_files_have(tmp_path):
    before = os.umask(0o027)
    try:
        write_text(str(tmp_path / "new"), "text")
    finally:
        os.umask(before)
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o640


def test_what_is_no_file_is_written_to_and_not_replaced():
    write_text(os.devnull, "text")
    assert not os.path.isfile(os.devnull)


def test_a_folder_is_not_written_over(tmp_path):
    with pytest.raises(Mistake, match="directory"):
        write_text(str(tmp_path), "text")


def test_a_json_file_of_another_encoding_is_told(tmp_path):
    path = tmp_path / "x.json"
    path.write_bytes(b'{"a": "\xff\xfe\xfa"}')
    with pytest.raises(Mistake, match="not UTF-8: byte 7"):
        read_json(str(path))


def test_huge_numbers_in_json_are_told(tmp_path):
    path = tmp_path / "x.json"
    path.write_text("9" * 10_000)
    with pytest.raises(Mistake, match="not JSON: a number of 10,000 digits is longer than 300"):
        read_json(str(path))
