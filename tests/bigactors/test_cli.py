"""What every command shares: help, mistakes on the line, exit codes, broken pipes, encodings."""

import os
import re
import subprocess
import sys

import pytest

from bigactors import __version__
from bigactors.cli import main
from bigactors.commands import NAMES
from bigactors.commands import explain as command

pytestmark = pytest.mark.usefixtures("missions")


def in_a_process(*words, **settings):
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    return subprocess.run([sys.executable, "-m", "bigactors", *words], check=False, **streams | settings)


def test_without_a_command_the_help_is_shown_and_nothing_is_a_success(bigactors):
    code, out, err = bigactors()
    assert (code, err) == (2, "")
    assert "write and check missions:" in out
    assert bigactors("--color", "never") == (2, out, "")


def test_the_front_page_lists_each_command_once_in_its_group(bigactors):
    listed = re.findall(r"^  ([a-z-]+) {2,}\w", bigactors("--help")[1].partition("options:")[0], re.MULTILINE)
    assert tuple(listed) == NAMES


@pytest.mark.parametrize(
    ("library", "line", "extra"),
    [
        ("cryptography", "from bigactors import cli; sys.exit(cli.main(['keygen', 'k']))", "live"),
        ("lsprotocol", "from bigactors import cli; sys.exit(cli.main(['lsp']))", "lsp"),
        ("hypothesis", "import bigactors.strategies", "strategies"),
    ],
)
def test_without_an_extra_the_way_to_install_it_is_told(library, line, extra):
    program = f"import sys; sys.modules['{library}'] = None; {line}"
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert ended.returncode in (1, 2)
    assert f"pip install '.[{extra}]'" in ended.stderr


@pytest.mark.parametrize("command", NAMES)
def test_the_help_of_each_command_shows_examples(done, command):
    out = done(command, "--help")
    assert f"bigactors {command}" in out.partition("\nexamples:\n")[2]


def test_a_bug_of_ours_is_told_as_one(bigactors, monkeypatch):
    monkeypatch.setattr(command, "run", lambda _: 1 / 0)
    code, _, err = bigactors("explain", "LS101")
    assert code == 4
    assert "ZeroDivisionError" in err
    assert "please report" in err


def test_an_interruption_is_incomplete(bigactors, monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "run", interrupted)
    assert bigactors("explain", "LS101") == (3, "", "bigactors: interrupted, nothing is decided\n")


def test_a_reader_who_leaves_is_no_error_and_does_not_change_the_verdict():
    for mission, code in (("holds", 0), ("race", 1)):
        reading, writing = os.pipe()
        os.close(reading)
        done = in_a_process("check", f"{mission}.mission", stdout=writing)
        os.close(writing)
        assert (done.returncode, done.stderr) == (code, b"")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no full device here")
def test_a_full_disk_is_told():
    with open("/dev/full", "wb") as full:
        done = in_a_process("explain", stdout=full)
    assert done.returncode == 2
    assert b"cannot write the output" in done.stderr
    assert b"Traceback" not in done.stderr


def test_an_output_without_greek_letters_gets_words_and_marks_stay_distinct():
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = in_a_process("check", "race.mission", env=environment)
    assert done.returncode == 1
    assert b"\n  x race_freedom" in done.stdout
    assert b"<req_ctr : a, control(MOVE_HOST_TO searchArea0)>" in done.stdout
    assert done.stderr == b""


def test_main_takes_the_words_of_this_process_if_it_is_given_none(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bigactors", "--version"])
    assert main() == 0
    assert __version__ in capsys.readouterr().out
