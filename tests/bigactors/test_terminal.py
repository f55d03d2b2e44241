"""What a terminal shows: colours as asked for, and lines that are broken between words."""

import fcntl
import json
import os
import re
import struct
import subprocess
import sys
import termios
from threading import Thread

import pytest

from bigactors.arguments import parser_of
from bigactors.cli import main
from bigactors.commands import NAMES
from bigactors.terminal import COLOUR, broken

pytestmark = pytest.mark.usefixtures("missions")

SIGN = re.compile(r"\x1b\[\d*m")
UNSET = {"NO_COLOR": "", "FORCE_COLOR": "", "TERM": "xterm", "COLUMNS": ""}


@pytest.fixture
def shown(monkeypatch, capsys):
    """Return what a command prints, into a pipe or onto a terminal of so many columns."""

    def run(line, *, columns=None, **environment):
        COLOUR.set("auto")  # whatever another line has chosen
        for name, value in (UNSET | environment).items():
            monkeypatch.setenv(name, value)
        if columns is None:
            main(line)
            return "".join(capsys.readouterr())
        with monkeypatch.context() as patch:
            return on_a_terminal(line, columns, patch)

    return run


def on_a_terminal(line, columns, patch):
    ours, theirs = os.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    found = []
    reader = Thread(target=lambda: found.extend(parts_of(ours)))
    reader.start()
    with open(theirs, "w", encoding="utf-8") as stream:
        for name in ("stdout", "stderr", "__stdout__", "__stderr__"):
            patch.setattr(sys, name, stream)
        main(line)
    reader.join()
    return b"".join(found).decode().replace("\r\n", "\n")


def parts_of(descriptor):
    """Yield what a terminal shows, until its other end is closed."""
    with os.fdopen(descriptor, "rb", buffering=0) as file:
        try:
            while part := file.read(10_000):
                yield part
        except OSError:
            return


def words(text):
    """Return the words of a text, without colours and times."""
    return re.sub(r"[\d.]+ s\b", "", SIGN.sub("", re.sub(r"\r[^\n]*\r", "", text))).split()


@pytest.mark.parametrize("columns", [40, 80, 120, 200])
@pytest.mark.parametrize(
    "line", ["check race.mission", "check nowhere.mission", "explain LS201", "check --bad"]
)
def test_a_terminal_shows_the_words_of_the_pipe_none_of_them_broken(shown, line, columns):
    onto = shown(line.split(), columns=columns)
    assert words(onto) == words(shown(line.split()))
    longest = max(len(word) for word in words(onto))
    assert max(len(SIGN.sub("", each)) for each in onto.split("\n")) <= max(columns, longest + 20)


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
    ("", {}, None, False),
    ("", {}, 80, True),
    ("", {"NO_COLOR": "1"}, 80, False),
    ("", {"TERM": "dumb"}, 80, False),
    ("", {"FORCE_COLOR": "1"}, None, True),
    ("", {"FORCE_COLOR": "1", "NO_COLOR": "1"}, 80, False),
    ("", {"FORCE_COLOR": "1", "TERM": "dumb"}, None, True),
    ("--color always", {"NO_COLOR": "1"}, None, True),
    ("--color never", {"FORCE_COLOR": "1"}, 80, False),
]


@pytest.mark.parametrize(("option", "environment", "columns", "coloured"), COLOURED)
def test_colours_are_for_terminals_and_for_those_who_ask_on_the_line_most(
    shown, option, environment, columns, coloured
):
    for line in (f"{option} check race.mission --no-traces", f"check {option} race.mission --no-traces"):
        found = shown(line.split(), columns=columns, **environment)
        assert ("\x1b[31m✗\x1b[0m race_freedom" in found) == coloured
        assert ("\x1b" in found) == coloured


@pytest.mark.parametrize("closed", [">&-", "<&- >&- 2>&-"])
def test_what_the_shell_has_closed_changes_no_verdict_and_no_file(missions, closed):
    line = f'"$0" -m bigactors check holds.mission --verdict v.json --output json:r.json {closed}'
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    ran = subprocess.run(
        ["sh", "-c", line, sys.executable], check=False, capture_output=True, env=environment
    )
    assert ran.returncode == 0
    assert all(json.loads((missions / name).read_text()) for name in ("v.json", "r.json"))
