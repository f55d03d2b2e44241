"""Run SPIN as a peer: compile a Promela model, search it in full, and read its report."""

import re
import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from machine import run_peer

TRANSLATE = ("spin", "-a", "-o3", "model.pml")
"""Statements are not merged: each is a step of its own."""

COMPILE = ("-O2", "-DSAFETY")
UNREDUCED = "-DNOREDUCE"
FIRST_DEPTH, MOST_DEPTH = 1_000_000, 256_000_000
"""How deep SPIN's stack is tried. All of it counts into SPIN's memory, so what is measured has the depth it needs."""

CLAIM_DEPTH = 100_000
"""How deep claims are searched: what is cut without an error is refused."""

EXACT = 99_999_999
"""Above it SPIN prints counts with eight digits."""

CUT = "max search depth too small"
"""What SPIN says beside "errors: 0" where it has not searched everything."""

_STORED = re.compile(r"^\s*(\S+) states, stored", re.MULTILINE)
_TRANSITIONS = re.compile(r"^\s*(\S+) transitions \(= stored\+matched\)", re.MULTILINE)
_MEMORY = re.compile(r"^\s*(\S+)\s+total actual memory usage", re.MULTILINE)
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


def agree(counts: Sequence[int], printed: Sequence[int]) -> bool:
    """Tell whether counts are those that SPIN printed, as far as it prints them.

    >>> agree((18, 119_745_396), (18, 119_745_400)), agree((18,), (19,))
    (True, False)
    """
    return all(a == b or (b > EXACT and abs(a - b) <= b * 1e-7) for a, b in zip(counts, printed, strict=True))


@dataclass(frozen=True, slots=True)
class Prepared:
    """A compiled verifier.

    Attributes:
        folder: Where it is.
        depth: How deep its stack has to be.
        preparing: The seconds that translating and compiling took.
        cores: On how many it searches.
    """

    folder: Path
    depth: int
    preparing: float
    cores: int = 1


def search(promela: str, folder: Path) -> Searched:
    """Search all of a model's state space, in a folder for SPIN's files.

    Raises:
        SpinError: The model is refused, violated, or too deep.
    """
    return searched(prepared(promela, folder))


def prepared(promela: str, folder: Path) -> Prepared:
    """Compile a model, and find by a search that is not measured how deep it is."""
    preparing = _compile(promela, folder, *COMPILE, UNREDUCED)
    return Prepared(folder, _depth(folder), preparing)


def prepared_for(cores: int, promela: str, folder: Path, depth: int) -> Prepared:
    """Compile a model for a search on several cores, which is as deep as on one at most."""
    return Prepared(folder, depth, _compile(promela, folder, *COMPILE, UNREDUCED, f"-DNCORE={cores}"), cores)


def searched(model: Prepared) -> Searched:
    """Search all of a prepared model; of several processes, which share memory, SPIN says how much they take."""
    report = _verify(model.folder, model.depth)
    if CUT in report.text:
        raise SpinError(f"the search was cut at {model.depth:,} steps")
    found = report.searched(model.preparing)
    return found if model.cores == 1 else replace(found, memory=float(_found(_MEMORY, report.text)))


def verdicts(promela: str, claims: Mapping[str, str], folder: Path) -> dict[bool, dict[str, bool]]:
    """Return of each claim in linear time, in SPIN's syntax and by name, whether it holds of a small model.

    They are decided twice: over all runs (False), and over those that are weakly fair to each process (True).

    Raises:
        SpinError: The model or a claim is refused, or the search was cut.
    """
    written = "".join(f"ltl {name} {{ {formula} }}\n" for name, formula in claims.items())
    _compile(promela + written, folder, UNREDUCED)
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
        report = _verify(folder, depth)
        if CUT not in report.text:
            return _count(_REACHED, report.text) + 10
        depth *= 4
    raise SpinError(f"the search is deeper than {MOST_DEPTH:,} steps")


def _compile(promela: str, folder: Path, *options: str) -> float:
    """Translate and compile a model; return the seconds that it took."""
    began = time.monotonic()
    (folder / "model.pml").write_text(promela, encoding="ascii")
    _run(*TRANSLATE, folder=folder)
    _run("gcc", *options, "-o", "pan", "pan.c", folder=folder)
    return time.monotonic() - began


def _run(*command: str, folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SpinError(f"{command[0]} refused the model: {done.stdout}{done.stderr}")


class _Report(NamedTuple):
    """What the verifier printed, seconds by the clock, and megabytes at its peak."""

    text: str
    seconds: float
    memory: float

    def searched(self, preparing: float) -> Searched:
        """Return the figures; SPIN counts storing the initial state as a transition, and here it is not one."""
        stored, followed = _count(_STORED, self.text), _count(_TRANSITIONS, self.text) - 1
        return Searched(stored, followed, self.seconds, self.memory, preparing)


def _verify(folder: Path, depth: int) -> _Report:
    """Run the verifier once."""
    began = time.monotonic()
    ran = run_peer(["./pan", "-E", f"-m{depth}"], folder=folder)
    seconds = time.monotonic() - began
    if ran.status or "errors: 0" not in ran.printed:  # the verifier exits 0 on a violation too
        raise SpinError(f"the search failed: {ran.printed}")
    return _Report(ran.printed, seconds, ran.memory)


def _count(pattern: re.Pattern[str], output: str) -> int:
    return int(float(_found(pattern, output)))


def _found(pattern: re.Pattern[str], output: str) -> str:
    found = pattern.search(output)
    if found is None:
        raise SpinError(f"the report has no such figure: {output}")
    return found[1]
