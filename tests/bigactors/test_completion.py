"""Command lines completed by real shells."""

import os
import re
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from bigactors.commands.completion import SHELLS

MISSION = """
signature { kind Location contains UAV  kind UAV driven }
world {
  field: Location = box (0, 0) (1, 1)
  glider: UAV = point (0.5, 0.5)
}
BigActor pilot hosted_at glider with_behavior { observe(ALL) }
"""
INTERACTIVE = {
    "bash": (["--norc", "--noprofile", "-i"], 'eval "$(bigactors completion bash)"'),
    "zsh": (["-f", "-i"], 'autoload -U compinit; compinit -D -u; eval "$(bigactors completion zsh)"'),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "gliding.mission").write_text(MISSION)
    (tmp_path / "notes.txt").write_text("")
    (tmp_path / "older").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("TERM", "xterm")


LINES = {
    "bigactors ch": {"check"},
    "bigactors check oil_": {"oil_spill", "oil_spill_timed"},
    "bigactors check gl": {"gliding.mission"},
    "bigactors check older": {"older/"},
    "bigactors check --engine f": {"fast"},
    "bigactors check --reduce s": {"symmetry"},
    "bigactors check --max-m": {"--max-memory"},
    "bigactors run gliding.mission --fence f": {"field"},
    "bigactors run oil_spill --fence oilSpill": {"oilSpill0"},
    "bigactors say p": {"pilot"},
    "bigactors give-back g": {"glider"},
    "bigactors explain LS20": {f"LS20{digit}" for digit in "12345"},
    "bigactors fmt ": {"gliding.mission", "older/"},
    "bigactors completion z": {"zsh"},
}
ASKED = """
import os, sys
from bigactors.commands.completion import complete

for line in sys.argv[1:]:
    if os.fork() == 0:
        os.environ |= {"COMP_LINE": line, "COMP_POINT": str(len(line))}
        complete()
    os.wait()
    os.write(8, b"\\0")
"""


@pytest.mark.usefixtures("folder")
def test_what_could_come_next_is_offered():
    asked = {"_ARGCOMPLETE": "1", "_ARGCOMPLETE_IFS": "\n", "_ARGCOMPLETE_SUPPRESS_SPACE": "1"}
    asked |= {"COMP_TYPE": "9", "_ARGCOMPLETE_SHELL": "fish"}
    reading, writing = os.pipe()
    command = ["bash", "-c", f'exec "$@" 8>&{writing}', "-", sys.executable, "-c", ASKED, *LINES]
    subprocess.run(command, env={**os.environ, **asked}, pass_fds=[writing], check=True)
    os.close(writing)
    with os.fdopen(reading) as answers:
        found = [set(re.findall(r"^(\S+)", answer, re.MULTILINE)) for answer in answers.read().split("\0")]
    for line, words in zip(LINES, found, strict=False):
        is_option = line.split()[-1].startswith("-")
        assert {word for word in words if is_option or not word.startswith("-")} == LINES[line], line


def typed(shell, setup, line):
    """Return what an interactive shell shows after a line and a tab."""
    options, first = setup
    terminal, theirs = os.openpty()
    stdio = {"stdin": theirs, "stdout": theirs, "stderr": theirs, "start_new_session": True}
    process = subprocess.Popen([shell, *options], **stdio)
    os.close(theirs)
    shown = ""

    def wait_for(pattern):
        nonlocal shown
        until = time.monotonic() + 60
        while not re.search(pattern, shown):
            if not select.select([terminal], [], [], max(0.0, until - time.monotonic()))[0]:
                raise AssertionError(f"{pattern} was not shown: {shown!r}")
            shown += os.read(terminal, 10_000).decode(errors="replace")

    os.write(terminal, f"{first}; echo rea'dy'\n".encode())
    wait_for(r"\nready|\rready")
    os.write(terminal, f"{line}\t".encode())
    wait_for("rendezvous")
    os.close(terminal)
    process.kill()
    process.wait()
    return shown


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("shell", INTERACTIVE)
def test_a_shell_completes_a_mission_that_ships(shell):
    if shutil.which(shell) is None:
        pytest.skip(f"there is no {shell} here")
    assert "rendezvous" in typed(shell, INTERACTIVE[shell], "bigactors check rendez")


@pytest.mark.usefixtures("folder")
@pytest.mark.skipif(shutil.which("fish") is None, reason="there is no fish here")
def test_fish_completes_a_mission_that_ships_and_one_that_lies_here():
    program = "bigactors completion fish | source; complete -C 'bigactors check '"
    done = subprocess.run(["fish", "--no-config", "-c", program], capture_output=True, text=True, check=True)
    words = {line.split("\t")[0] for line in done.stdout.splitlines()}
    assert words >= {"gliding.mission", "oil_spill", "handover"}
    assert "notes.txt" not in words


@pytest.mark.parametrize("shell", SHELLS)
def test_every_shell_gets_a_script(done, shell):
    out = done("completion", shell)
    assert "bigactors" in out
