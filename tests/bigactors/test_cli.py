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


def in_a_process(*words, **settings):
    return subprocess.run(
        [sys.executable, "-m", "bigactors", *words], capture_output=True, check=False, **settings
    )


def test_the_version_is_printed(bigactors):
    assert bigactors("--version") == (0, f"bigactors {__version__}\n", "")


def test_without_a_command_the_help_is_shown_and_nothing_is_a_success(bigactors):
    code, out, _ = bigactors()
    assert code == 2
    assert "write and check missions:" in out


def test_an_option_without_a_command_is_no_success_either(bigactors):
    code, out, err = bigactors("--color", "never")
    assert (code, err) == (2, "")
    assert out == bigactors()[1]


def test_the_front_page_lists_each_command_once_in_its_group(bigactors):
    listed = re.findall(r"^  ([a-z-]+) {2,}\w", bigactors("--help")[1].partition("options:")[0], re.MULTILINE)
    assert tuple(listed) == NAMES


@pytest.mark.parametrize("command", NAMES)
def test_the_help_of_each_command_shows_examples(bigactors, command):
    code, out, err = bigactors(command, "--help")
    assert (code, err) == (0, "")
    assert f"bigactors {command}" in out.partition("\nexamples:\n")[2]


def test_an_unknown_command_is_told_with_the_one_that_may_be_meant(bigactors):
    assert bigactors("chekc", "x") == (
        2,
        "",
        "bigactors: unknown command 'chekc'\n  hint: did you mean 'check'?\n",
    )


def test_an_unknown_option_is_told_with_the_one_that_may_be_meant(bigactors):
    code, _, err = bigactors("check", "x.mission", "--jsn=-")
    assert code == 2
    assert err == "bigactors: unknown option '--jsn=-'\n  hint: did you mean '--json'?\n"


def test_an_argument_too_many_is_told(bigactors):
    code, _, err = bigactors("say", "a", "home", "now")
    assert code == 2
    assert "'now' is one argument too many" in err


def test_options_are_not_abbreviated(bigactors):
    assert bigactors("check", "x.mission", "--no-tr")[0] == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("check", "x", "--max-configurations", "0"), "'0' is not a whole number from 1"),
        (("check", "x", "--max-configurations", "many"), "'many' is not a whole number from 1"),
        (("check", "x", "--max-time", "-3"), "'-3' is not a number of seconds above 0"),
        (("check", "x", "--max-time", "nan"), "'nan' is not a number of seconds above 0"),
        (("simulate", "x", "--seed", "1e9"), "'1e9' is not a whole number from 0"),
        (("world", "x", "--within", "1,2,3"), "'1,2,3' is no box"),
        (("world", "x", "--at", "noon"), "'noon' is no time"),
        (("check",), "FILE"),
        (("check", "x", "--json="), "the name of a file is missing"),
        (("fmt", "--check", "--stdout", "x"), "not allowed with"),
    ],
)
def test_a_value_that_makes_no_sense_is_told(bigactors, words, said):
    code, _, err = bigactors(*words)
    assert code == 2
    assert said in err
    assert "Traceback" not in err


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


def test_help_is_there_at_once_and_loads_no_library():
    code = (
        "import sys, bigactors.cli; bigactors.cli.main(['check', '--help']);"
        "heavy = {'shapely', 'pyproj', 'lark', 'resvg_py', 'numpy', 'networkx', 'checker', 'specs'};"
        "heavy &= set(sys.modules);"
        "sys.exit(str(sorted(heavy)) if heavy else 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.usefixtures("missions")
def test_a_reader_who_leaves_is_no_error_and_does_not_change_the_verdict():
    for mission, code in (("holds", 0), ("race", 1)):
        reading, writing = os.pipe()
        os.close(reading)
        done = subprocess.run(
            [sys.executable, "-m", "bigactors", "check", f"{mission}.mission"],
            stdout=writing,
            stderr=subprocess.PIPE,
            check=False,
        )
        os.close(writing)
        assert (done.returncode, done.stderr) == (code, b"")


@pytest.mark.usefixtures("missions")
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no full device here")
def test_a_full_disk_is_told():
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "bigactors", "explain"], stdout=full, stderr=subprocess.PIPE, check=False
        )
    assert done.returncode == 2
    assert b"cannot write the output" in done.stderr
    assert b"Traceback" not in done.stderr


@pytest.mark.usefixtures("missions")
def test_an_output_without_greek_letters_gets_words_and_marks_stay_distinct():
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = in_a_process("check", "race.mission", env=environment)
    assert done.returncode == 1
    assert b"\n  x race_freedom" in done.stdout
    assert b"<req_ctr : a, control(MOVE_HOST_TO searchArea0)>" in done.stdout
    assert done.stderr == b""


@pytest.mark.usefixtures("missions")
def test_in_a_pipe_there_are_no_colours_and_no_progress():
    done = in_a_process("check", "race.mission", "endless.mission", "--max-time", "1.2")
    assert b"\033" not in done.stdout + done.stderr
    assert b"\r" not in done.stdout + done.stderr


def test_main_takes_the_words_of_this_process_if_it_is_given_none(monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bigactors", "--version"])
    assert main() == 0
    assert __version__ in capsys.readouterr().out
