"""Peers are measured as processes of their own: nothing of the benchmark is in their figures."""

import os
import signal
import sys

import pytest
from scripts import script

machine = script("machine")


def test_a_peers_memory_is_its_own_and_not_that_of_what_started_it():
    ballast = bytearray(200 << 20)
    ballast[:: os.sysconf("SC_PAGE_SIZE")] = b"x" * len(ballast[:: os.sysconf("SC_PAGE_SIZE")])
    small = machine.run_peer(["true"])
    large = machine.run_peer([sys.executable, "-I", "-S", "-c", "held = bytearray(50 << 20)"])
    assert small.memory < 20
    assert 50 < large.memory < 90
    assert len(ballast) > 0


def test_what_a_peer_printed_and_how_it_ended_is_told(tmp_path):
    ran = machine.run_peer(["sh", "-c", "pwd; echo wrong >&2; exit 3"], folder=tmp_path)
    assert (ran.printed.splitlines(), ran.status) == ([str(tmp_path), "wrong"], 3)
    missing = machine.run_peer(["no_such_program"])
    assert (missing.status, missing.printed) == (127, "no_such_program: No such file or directory\n")


@pytest.mark.long
def test_a_peer_ends_with_its_time():
    ran = machine.run_peer(["sh", "-c", "while :; do :; done"], seconds=1)
    assert ran.status == -signal.SIGXCPU
    assert 0.9 < ran.seconds < 3
