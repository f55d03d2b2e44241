"""Recordings, logs and keys are for their owner alone, whatever the umask is and whoever made them before."""

import os
import stat

import pytest

from adapters.mavlink import signing
from adapters.mavlink.signing import Signing
from adapters.private_files import open_private, others_may_read
from adapters.recording.mcap_files import McapWriter
from adapters.stations.journal import Journal
from bigactors.flight_watchers import Log


def mode_of(path):
    return stat.S_IMODE(path.stat().st_mode)


@pytest.fixture(autouse=True)
def loose():
    """Work where new files are readable by all."""
    before = os.umask(0o000)
    yield
    os.umask(before)


def recording(path):
    McapWriter(path, {}).close()


def journal(path):
    Journal(path, "gcs0", "sha256:0").close()


def tlog(path):
    log = Log(path)
    log(1.0, b"frame")
    log.close()


def key(path):
    signing.save(Signing(bytes(32)), path)


MAKERS = (recording, journal, tlog, key)


@pytest.mark.parametrize("make", MAKERS, ids=lambda make: make.__name__)
def test_what_is_made_is_its_owners_alone(tmp_path, make):
    make(tmp_path / "made")
    assert mode_of(tmp_path / "made") == 0o600
    assert [each.name for each in tmp_path.iterdir()] == ["made"]


@pytest.mark.parametrize("make", [journal, tlog, key], ids=lambda make: make.__name__)
def test_what_was_there_before_becomes_its_owners_alone(tmp_path, make):
    path = tmp_path / "made"
    make(path)
    path.chmod(0o644)
    make(path)
    assert mode_of(path) == 0o600


def test_what_a_killed_process_left_beside_a_key_is_tightened_before_the_key_is_in_it(tmp_path):
    beside = tmp_path / "key.new"
    beside.touch(0o666)
    key(tmp_path / "key")
    assert mode_of(tmp_path / "key") == 0o600


def test_what_is_no_file_keeps_its_mode():
    before = os.stat("/dev/null").st_mode
    with open_private(os.devnull, "ab") as file:
        file.write(b"x")
    assert os.stat("/dev/null").st_mode == before


@pytest.mark.parametrize(
    ("mode", "told"), [(0o600, ""), (0o400, ""), (0o640, "0640"), (0o604, "0604"), (0o620, "0620")]
)
def test_who_else_has_a_right_to_a_file_is_told_by_its_mode(tmp_path, mode, told):
    path = tmp_path / "file"
    path.touch()
    path.chmod(mode)
    assert others_may_read(path) == told


@pytest.mark.parametrize("mode", ["ab", "wb", "a+b"])
def test_nothing_is_written_through_a_symbolic_link(tmp_path, mode):
    precious = tmp_path / "precious"
    precious.write_text("mine")
    precious.chmod(0o644)
    (tmp_path / "link").symlink_to(precious)
    with pytest.raises(OSError, match="this is a symbolic link"):
        open_private(tmp_path / "link", mode)
    assert (precious.read_text(), precious.stat().st_mode & 0o777) == ("mine", 0o644)
