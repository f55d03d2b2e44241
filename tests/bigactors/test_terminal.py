"""What a terminal shows: colours as asked for, and lines that are broken between words."""

import fcntl
import json
import os
import re
import struct
import subprocess
import sys
import termios

import pytest

from bigactors.arguments import parser_of
from bigactors.commands import NAMES
from bigactors.terminal import broken

ESCAPE = "\x1b"


def shown(line, *, columns=None, **environment):
    """Return what a command prints, into a pipe or onto a terminal of so many columns."""
    hidden = {"NO_COLOR": "", "FORCE_COLOR": "", "TERM": "xterm", "COLUMNS": ""}
    command = [sys.executable, "-m", "bigactors", *line]
    setting = {"env": {**os.environ, **hidden, **environment}, "stderr": subprocess.STDOUT}
    if columns is None:
        return subprocess.run(command, stdout=subprocess.PIPE, check=False, **setting).stdout.decode()
    ours, theirs = os.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    with subprocess.Popen(command, stdin=theirs, stdout=theirs, **{**setting, "stderr": theirs}):
        os.close(theirs)
        read = b""
        try:
            while part := os.read(ours, 10_000):
                read += part
        except OSError:  # the other end is closed
            pass
    os.close(ours)
    return read.decode().replace("\r\n", "\n")


def words(text):
    """Return the words of a text, without colours and times."""
    plain = re.sub(r"\x1b\[\d*m|\r[^\n]*\r", "", text)
    return re.sub(r"[\d.]+ s\b", "", plain).split()


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize("columns", [40, 80, 120, 200])
@pytest.mark.parametrize(
    "line",
    [["check", "race.mission"], ["check", "nowhere.mission"], ["explain", "LS201"], ["check", "--bad"]],
)
def test_a_terminal_shows_the_words_of_the_pipe_none_of_them_broken(line, columns):
    onto = shown(line, columns=columns)
    assert words(onto) == words(shown(line))
    longest = max(len(word) for word in words(onto))
    assert max(len(re.sub(r"\x1b\[\d*m", "", each)) for each in onto.split("\n")) <= max(
        columns, longest + 20
    )


@pytest.mark.parametrize("columns", [40, 80, 200])
@pytest.mark.parametrize("name", NAMES)
def test_help_breaks_no_word_and_no_option(name, columns, monkeypatch):
    monkeypatch.setenv("COLUMNS", "1000")
    whole = words(parser_of(name).format_help())
    monkeypatch.setenv("COLUMNS", str(columns))
    assert sorted(words(parser_of(name).format_help())) == sorted(whole)


def test_wide_characters_count_twice():
    assert broken("  水水 水水 水水", 12) == "  水水 水水\n    水水"


def test_an_excerpt_of_a_file_stays_above_its_caret():
    line = "   14 | " + "word " * 30
    assert broken(line, 40) == line


COLOURED = [
    ({}, None, False),
    ({}, 80, True),
    ({"NO_COLOR": "1"}, 80, False),
    ({"TERM": "dumb"}, 80, False),
    ({"FORCE_COLOR": "1"}, None, True),
    ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, 80, False),
    ({"FORCE_COLOR": "1", "TERM": "dumb"}, None, True),
]


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize(("environment", "columns", "coloured"), COLOURED)
def test_colours_are_for_terminals_and_for_those_who_ask(environment, columns, coloured):
    found = shown(["check", "race.mission", "--no-traces"], columns=columns, **environment)
    assert (ESCAPE in found) == coloured


@pytest.mark.usefixtures("missions")
@pytest.mark.parametrize(
    "line", [["check", "--color", "{}", "race.mission"], ["--color", "{}", "check", "race.mission"]]
)
def test_what_the_line_says_of_colours_counts_most(line):
    always, never = ([word.format(choice) for word in line] for choice in ("always", "never"))
    assert ESCAPE in shown(always, NO_COLOR="1")
    assert ESCAPE not in shown(never, columns=80, FORCE_COLOR="1")


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", "<&- >&- 2>&-"])
def test_what_the_shell_has_closed_changes_no_verdict_and_no_file(tmp_path, closed):
    (tmp_path / "m.mission").write_text(HOLDS)
    line = f'"$0" -m bigactors check m.mission --verdict v.json --output json:r.json {closed}'
    where = {"cwd": tmp_path, "env": {**os.environ, "PYTHONPATH": os.getcwd()}}
    assert (
        subprocess.run(
            ["sh", "-c", line, sys.executable], check=False, capture_output=True, **where
        ).returncode
        == 0
    )
    for name in ("v.json", "r.json"):
        assert json.loads((tmp_path / name).read_text())


HOLDS = """
signature { kind Location contains Station
            kind Station }
world { shore0: Location = box (37.1, -8.5) (37.0, -8.6)
        gcs0: Station = point (37.05, -8.53) }
BigActor op0 hosted_at gcs0 with_behavior { display("x") }
"""
