"""SPIN as a peer: compile a Promela model, search all of it without reduction, and say what that took."""

import os
import re
import shutil
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

COMPILE = ("-O2", "-DSAFETY", "-DNOREDUCE")
"""No reduction and no compression of states: every one is stored as it is."""

FIRST_DEPTH, MOST_DEPTH = 1_000_000, 256_000_000
"""How deep SPIN's stack is tried. All of it counts into SPIN's memory, so what is measured has the depth it needs."""

CLAIM_DEPTH = 100_000
"""How deep claims are searched: what is cut without an error is refused."""

CUT = "max search depth too small"
"""What SPIN says beside "errors: 0" where it has not searched everything."""

_STORED = re.compile(r"^\s*(\d+) states, stored", re.MULTILINE)
_TRANSITIONS = re.compile(r"^\s*(\d+) transitions \(= stored\+matched\)", re.MULTILINE)
_ERRORS = re.compile(r"errors: (\d+)")
_REACHED = re.compile(r"depth reached (\d+)")


class SpinError(Exception):
    """SPIN or its compiler refused the model, or the search was cut."""


@dataclass(frozen=True, slots=True)
class Searched:
    """What a search found and took.

    Attributes:
        configurations: How many.
        transitions: How many.
        seconds: By the clock, apart from what had to be prepared.
        memory: Of the process at its peak, in MB.
        preparing: Seconds for what comes before: translating, compiling, loading.
    """

    configurations: int
    transitions: int
    seconds: float
    memory: float
    preparing: float


def missing() -> tuple[str, ...]:
    """Return what SPIN needs and is not installed."""
    return tuple(tool for tool in ("spin", "gcc") if shutil.which(tool) is None)


@dataclass(frozen=True, slots=True)
class Prepared:
    """A compiled verifier, how deep its stack has to be, and the seconds that translating and compiling took."""

    folder: Path
    depth: int
    preparing: float


def search(promela: str, folder: Path) -> Searched:
    """Search all of a model's state space, in a folder for SPIN's files.

    Raises:
        SpinError: The model is refused, violated, or too deep.
    """
    return searched(prepared(promela, folder))


def prepared(promela: str, folder: Path) -> Prepared:
    """Compile a model, and find by a search that is not measured how deep it is."""
    began = time.monotonic()
    (folder / "model.pml").write_text(promela, encoding="ascii")
    _run("spin", "-a", "model.pml", folder=folder)
    _run("gcc", *COMPILE, "-o", "pan", "pan.c", folder=folder)
    preparing = time.monotonic() - began
    return Prepared(folder, _depth(folder), preparing)


def searched(model: Prepared) -> Searched:
    """Search all of a prepared model. SPIN counts storing the initial state as a transition; here it is not one."""
    output, seconds, memory = _verify(model.folder, model.depth)
    if CUT in output:
        raise SpinError(f"the search was cut at {model.depth:,} steps")
    stored, transitions = _count(_STORED, output), _count(_TRANSITIONS, output)
    return Searched(stored, transitions - 1, seconds, memory, model.preparing)


def verdicts(promela: str, claims: Mapping[str, str], folder: Path) -> dict[bool, dict[str, bool]]:
    """Return of each claim in linear time, in SPIN's syntax and by name, whether it holds of a small model.

    They are decided twice: over all runs (False), and over those that are weakly fair to each process (True).

    Raises:
        SpinError: The model or a claim is refused, or the search was cut.
    """
    written = "".join(f"ltl {name} {{ {formula} }}\n" for name, formula in claims.items())
    (folder / "model.pml").write_text(promela + written, encoding="ascii")
    _run("spin", "-a", "model.pml", folder=folder)
    _run("gcc", "-DNOREDUCE", "-o", "pan", "pan.c", folder=folder)
    return {fair: {name: _holds(name, folder, fair=fair) for name in claims} for fair in (False, True)}


def _holds(claim: str, folder: Path, *, fair: bool) -> bool:
    command = ["./pan", "-a", *(["-f"] if fair else []), f"-m{CLAIM_DEPTH}", "-N", claim]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    found = _ERRORS.search(done.stdout)
    if done.returncode or found is None or (found[1] == "0" and CUT in done.stdout):
        raise SpinError(f"the search failed: {done.stdout}{done.stderr}")
    return found[1] == "0"


def _depth(folder: Path) -> int:
    """Return how deep the stack has to be, by a search that is not measured: an uncut one."""
    depth = FIRST_DEPTH
    while depth <= MOST_DEPTH:
        output, _, _ = _verify(folder, depth)
        if CUT not in output:
            return _count(_REACHED, output) + 10
        depth *= 4
    raise SpinError(f"the search is deeper than {MOST_DEPTH:,} steps")


def _run(*command: str, folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SpinError(f"{command[0]} refused the model: {done.stdout}{done.stderr}")


def _verify(folder: Path, depth: int) -> tuple[str, float, float]:
    """Run the verifier once: its output, seconds by the clock, and megabytes at its peak."""
    report = folder / "report.txt"
    began = time.monotonic()
    with report.open("w", encoding="utf-8") as output:
        verifier = subprocess.Popen(
            ["./pan", "-E", f"-m{depth}"], cwd=folder, stdout=output, stderr=subprocess.STDOUT
        )
        _, status, usage = os.wait4(verifier.pid, 0)
        verifier.returncode = os.waitstatus_to_exitcode(status)
    seconds = time.monotonic() - began
    text = report.read_text(encoding="utf-8")
    if verifier.returncode or "errors: 0" not in text:  # the verifier exits 0 on a violation too
        raise SpinError(f"the search failed: {text}")
    return text, seconds, usage.ru_maxrss / 1024


def _count(pattern: re.Pattern[str], output: str) -> int:
    found = pattern.search(output)
    if found is None:
        raise SpinError(f"the report has no count: {output}")
    return int(found[1])
