"""`bigactors warm-up`: afterwards the checks of other missions compile nothing."""

import os
import subprocess
import sys

import pytest

ENGINE = ("--engine", "fast", "--no-traces")
CHECKS = (("handover",), ("rendezvous", "--reduce", "por"), ("oil_spill_timed",), ("takeover",))


def bigactors(folder, *words):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder)}
    line = [sys.executable, "-m", "bigactors", *words]
    return subprocess.run(line, env=environment, capture_output=True, text=True, check=True, timeout=1_200)


def loops(folder):
    return {path.name for path in folder.rglob("*.nbc")}


@pytest.mark.long
def test_afterwards_checks_compile_nothing(tmp_path):
    shown = bigactors(tmp_path, "warm-up").stdout
    assert len(shown.splitlines()) == 14
    compiled = loops(tmp_path)
    assert len(compiled) > 50
    for words in CHECKS:
        bigactors(tmp_path, "check", *words, *ENGINE)
    assert loops(tmp_path) == compiled
