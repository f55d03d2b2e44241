"""Signals that end a process: at each moment of a command they give one of its exit codes, and no traceback."""

import signal
import subprocess
import sys

import pytest
from processes import begun

from bigactors.ending_signals import ENDING

ALL = [signal.SIGINT, *ENDING]
INTERRUPTED = "bigactors: interrupted, nothing is decided\n"


def ended(prelude, *words):
    """Run a command in a process that sends itself a signal; return its exit code and its messages."""
    program = f"""
import atexit, os, sys
def send(*_, **__):
    os.kill(os.getpid(), {{number}})
from bigactors import cli
{prelude}
sys.argv[1:] = {list(words)!r}
sys.exit(cli.script())
"""

    def run(number):
        words = [sys.executable, "-c", program.format(number=int(number))]
        with begun(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            _, err = process.communicate(timeout=120)
            return process.returncode, err

    return run


@pytest.mark.parametrize("number", ALL, ids=lambda each: each.name)
def test_a_signal_while_the_process_ends_does_not_change_its_exit_code(number):
    assert ended("atexit.register(send)", "explain", "LS101")(number) == (0, "")
    assert ended("atexit.register(send)", "explain", "LS000")(number)[0] == 2


MOMENTS = {
    "parsing": ("import bigactors.arguments; bigactors.arguments.parse_arguments = send", INTERRUPTED),
    "running": ("import bigactors.commands.explain as command; command.run = send", INTERRUPTED),
    "answering": ("import bigactors.commands.explain as command; command.run = cli.tell = send", ""),
    "flushing": (
        "import bigactors.terminal as t; t._open_closed = lambda: atexit.register(send); t.write = send",
        "",
    ),
}


@pytest.mark.parametrize("number", ALL, ids=lambda each: each.name)
@pytest.mark.parametrize("moment", MOMENTS)
def test_a_signal_during_a_command_makes_it_incomplete(number, moment):
    prelude, said = MOMENTS[moment]
    assert ended(prelude, "explain", "LS101")(number) == (3, said)


def test_a_program_that_runs_a_command_keeps_its_handlers():
    program = """
import signal, sys
from bigactors.cli import main
sys.argv[1:] = ["explain", "LS101"]
before = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)]
assert main(["explain", "LS101"]) == main() == 0
assert [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)] == before
"""
    subprocess.run([sys.executable, "-c", program], check=True, stdout=subprocess.DEVNULL)
