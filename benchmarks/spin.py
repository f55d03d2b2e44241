"""Run SPIN as a peer: compile a Promela model, search it in full or within bounds, and read its report."""

import math
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from machine import resident, run_peer

TRANSLATE = ("spin", "-a", "-o3", "model.pml")
"""Statements are not merged: each is a step of its own."""

COMPILE = ("-O2", "-DSAFETY")
UNREDUCED = "-DNOREDUCE"
GROWING = "-DAUTO_RESIZE"
"""The hash table grows with what it holds; else it keeps its size."""

FIRST_DEPTH, MOST_DEPTH = 1_000_000, 256_000_000
"""How deep SPIN's stack is tried. All of it counts into SPIN's memory, so what is measured has the depth it needs."""

CLAIM_DEPTH = 100_000
"""How deep claims are searched: what is cut without an error is refused."""

BOUNDED_DEPTH = 100_000
"""How deep searches within bounds are: their models are shallow, or searched breadth-first."""

EVERY = 0.02
"""Seconds between two looks at what a search within bounds takes."""

GRACE = 1.0
"""Seconds that a search within bounds has at least: by then the verifier knows what to do when it is interrupted."""

EXACT = 99_999_999
"""Above it SPIN prints counts with eight digits."""

CUT = "max search depth too small"
"""What SPIN says beside "errors: 0" where it has not searched everything."""

_STORED = re.compile(r"^\s*(\S+) states, stored", re.MULTILINE)
_TRANSITIONS = re.compile(r"^\s*(\S+) transitions \(= stored\+matched\)", re.MULTILINE)
_MEMORY = re.compile(r"^\s*(\S+)\s+total actual memory usage", re.MULTILINE)
_ERRORS = re.compile(r"errors: (\d+)")
_REACHED = re.compile(r"depth reached (\d+)")
_PROGRESS = re.compile(r"States=\s*(\S+) Transitions=\s*(\S+) Memory=\s*(\S+)(?:\s+t=\s*(\S+))?")


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
        bounds: What cut it; nothing where it is complete.
        marks: What it said on its way, rounded to three digits.
    """

    configurations: int
    transitions: int
    seconds: float
    memory: float
    preparing: float
    bounds: tuple[str, ...] = ()
    marks: tuple[Mapping[str, float], ...] = ()

    @property
    def rate(self) -> float:
        """Configurations a second."""
        return self.configurations / max(self.seconds, 1e-9)


@dataclass(frozen=True, slots=True)
class Bounds:
    """Where a search ends at the latest."""

    minutes: float = math.inf
    gigabytes: float = math.inf
    configurations: float = math.inf

    def met(self, seconds: float, memory: float, configurations: float) -> str:
        """Say which is met, by so many seconds, megabytes and configurations; nothing where none is."""
        if seconds > 60 * self.minutes:
            return f"the time limit of {60 * self.minutes:g} s"
        if memory > 1024 * self.gigabytes:
            return f"the memory limit of {self.gigabytes:g} GiB"
        if configurations >= self.configurations:
            return f"stopped at {self.configurations:,.0f} configurations"
        return ""


def missing() -> tuple[str, ...]:
    """Return what SPIN needs and is not installed."""
    return tuple(tool for tool in ("spin", "gcc") if shutil.which(tool) is None)


def has_peer(*, wanted: bool) -> bool:
    """Tell whether SPIN takes part where it need not; say why where it was wanted and cannot."""
    if wanted and missing():
        sys.stderr.write(
            f"without SPIN, not installed: {', '.join(missing())} (Debian: apt-get install spin gcc)\n"
        )
    return wanted and not missing()


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


def bounded(
    promela: str, folder: Path, bounds: Bounds, *, reduced: bool = False, breadth_first: bool = False
) -> Searched:
    """Search a model as far as bounds allow, and say what cut it.

    Args:
        promela: The model.
        folder: For SPIN's files.
        bounds: Where to stop.
        reduced: By SPIN's partial order, which keeps deadlocks.
        breadth_first: Instead of depth-first.

    Raises:
        SpinError: The model is refused or violated.
    """
    options = [GROWING, *([] if reduced else [UNREDUCED]), *(["-DBFS"] if breadth_first else [])]
    preparing = _compile(promela, folder, *COMPILE, *options)
    report = _verify(folder, BOUNDED_DEPTH, bounds)
    return replace(report.searched(preparing), marks=tuple(_marks(report.text)))


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
    """What the verifier printed, seconds by the clock, megabytes at its peak, and the bound that it met."""

    text: str
    seconds: float
    memory: float
    met: str

    def searched(self, preparing: float) -> Searched:
        """Return the figures; SPIN counts storing the initial state as a transition, and here it is not one."""
        depth = f"the depth of {BOUNDED_DEPTH:,} steps" if CUT in self.text else ""
        return Searched(
            _count(_STORED, self.text),
            _count(_TRANSITIONS, self.text) - 1,
            self.seconds,
            self.memory,
            preparing,
            tuple(filter(None, (self.met, depth))),
        )


def _verify(folder: Path, depth: int, bounds: Bounds | None = None) -> _Report:
    """Run the verifier once."""
    report = folder / "report.txt"
    began = time.monotonic()
    met = ""

    def watch(verifier: int) -> None:
        nonlocal met
        met = "" if bounds is None else _watch(verifier, report, bounds)

    ran = run_peer(["./pan", "-E", f"-m{depth}"], folder=folder, output=report, while_it_runs=watch)
    seconds = time.monotonic() - began
    text = ran.printed
    if ran.status or "errors: 0" not in text:  # the verifier exits 0 on a violation too
        raise SpinError(f"the search failed: {text}")
    return _Report(text, seconds, ran.memory, met if "not completed" in text else "")


def _watch(verifier: int, report: Path, bounds: Bounds) -> str:
    """Wait for a verifier to end, and interrupt it at a bound, upon which it reports; return what was met."""
    began = time.monotonic()
    while Path(f"/proc/{verifier}/stat").exists():
        time.sleep(EVERY)
        seconds = time.monotonic() - began
        stored = _last_stored(report) if bounds.configurations < math.inf else 0
        met = bounds.met(seconds, resident("VmRSS", str(verifier)), stored)
        if met and seconds > GRACE:
            with suppress(ProcessLookupError):  # it has just ended
                os.kill(verifier, signal.SIGINT)
            return met
    return ""


def _last_stored(report: Path) -> float:
    found = _PROGRESS.findall(report.read_text(encoding="utf-8"))
    return float(found[-1][0]) if found else 0.0


def _marks(text: str) -> list[dict[str, float]]:
    names = ("configurations", "transitions", "memory", "seconds")
    return [
        dict(zip(names, (float(value or 0) for value in found), strict=True))
        for found in _PROGRESS.findall(text)
    ]


def _count(pattern: re.Pattern[str], output: str) -> int:
    return int(float(_found(pattern, output)))


def _found(pattern: re.Pattern[str], output: str) -> str:
    found = pattern.search(output)
    if found is None:
        raise SpinError(f"the report has no such figure: {output}")
    return found[1]
