"""`bigactors big sim --runs N`: the first times of predicates over many runs, as text, data and a picture."""

import time
from argparse import Namespace
from collections import Counter
from collections.abc import Iterator, Sequence
from math import isfinite
from pathlib import Path
from typing import Any, Final

from bigactors.commands.big.output import write_data
from bigactors.files import check_writable
from bigactors.mistakes import Mistake
from bigactors.pictures.hitting_times import Curve
from bigactors.progress import watching
from bigactors.terminal import is_terminal, say, tell
from bigraphs.sampling import (
    CONFIDENCE,
    End,
    FirstTimes,
    Sample,
    SampleEstimate,
    Sampler,
    first_times,
    mean,
    share,
    shares_until,
)
from bigraphs.simulation import Bounds
from bigraphs.system import System, SystemKind
from physical.map_style import PALETTE
from physical.wordings import counted

LOOK_EVERY: Final = 0.2
"""Seconds between two updates of the progress line."""

STEPS: Final = "steps of a run"

MOST_POINTS: Final = 300
"""The most steps of a drawn curve."""


def many_runs(options: Namespace, system: System) -> bool:
    """Take the runs and report their statistics; return whether all runs were taken."""
    check_outputs(options)
    begun = time.monotonic()
    samples = sampled(options, system)
    seconds = time.monotonic() - begun
    if not samples:
        raise Mistake("interrupted before a run had ended", "", options.file)
    found = first_times(system, samples)
    if options.json != "-":
        for line in lines(options, samples, found, seconds):
            say(line)
    if options.json:
        write_data(options.json, as_data(options, system, samples, found))
    if options.plot:
        _draw(options, system, samples, found)
        tell(f"  written: {options.plot}")
    return len(samples) == int(options.runs)


def check_outputs(options: Namespace) -> None:
    """Raise Mistake for an unwritable output file, before any run."""
    for path in (options.json, options.plot):
        if path and path != "-":
            check_writable(path)
    if options.plot and Path(options.plot).suffix.lower() not in (".svg", ".png"):
        raise Mistake("a picture is an .svg or a .png", "name it so", options.plot)


def sampled(options: Namespace, system: System) -> list[Sample]:
    """Take the runs, with progress on a terminal; after Ctrl-C, return the runs taken so far."""
    sampler = Sampler(system, Bounds(options.steps, options.until), options.seed)
    samples: list[Sample] = []
    with watching(Path(options.file).name) as watch:
        begun = looked = time.monotonic()
        for number in range(options.runs):
            samples.append(sampler.run(number))
            now = time.monotonic()
            if now - looked < LOOK_EVERY:
                continue
            looked = now
            if watch.interrupted:
                break
            if is_terminal(watch.stream):
                rate = len(samples) / (now - begun)
                left = (options.runs - len(samples)) / rate
                runs = f"{len(samples):,} of {counted(options.runs, 'run')}"
                watch.rewrite(f"{watch.name}: {runs}, {rate:,.0f}/s, {left:,.0f} s left")
    return samples


def lines(
    options: Namespace, samples: Sequence[Sample], found: Sequence[FirstTimes], seconds: float
) -> Iterator[str]:
    """Yield the lines of the report."""
    runs = f"{counted(len(samples), 'run')} of seed {options.seed}"
    yield f"{Path(options.file).name}: {runs}, {seconds:.2f} s"
    if len(samples) < options.runs:
        yield f"  interrupted: {counted(options.runs - len(samples), 'run')} more of those asked for"
    ends = Counter(each.end for each in samples)
    for end, words in (
        (End.STUCK, "ended where no rule applies"),
        (End.TIME, f"went on to time {options.until or 0:g}"),
        (End.STEPS, f"ended after {counted(options.steps, 'step')}, the limit of --steps"),
    ):
        if ends[end]:
            yield f"  {ends[end]:,} {words}"
    if ends[End.STEPS] and options.until is not None:
        yield "  warning: predicates count as never true after --steps cuts off a run before --until; raise --steps"
    width = max(len(label) for label in (STEPS, *(each.label for each in found)))
    yield f"  {STEPS.ljust(width)}  {_estimated(mean([float(each.steps) for each in samples]))} on average"
    for each in found:
        yield f"  {each.label.ljust(width)}  {_told(each)}"
    yield f"  in brackets: intervals of {CONFIDENCE:.0%}, Wilson's of shares and Student's of means"


def _told(found: FirstTimes) -> str:
    chance = found.share
    low, high = (f"{100 * each:.3g}" for each in (chance.low, chance.high))
    share = f"{100 * chance.value:.3g} % of the runs ({low} to {high})"
    if found.time is None:
        return share
    if not found.most:
        return f"{share}, from the start"
    return (
        f"{share}, first at {_estimated(found.time)} on average, "
        f"{found.least:.4g} at the earliest (--run {found.first_run}), {found.most:.4g} at the latest"
    )


def _estimated(found: SampleEstimate) -> str:
    if not isfinite(found.low):
        return f"{found.value:.4g}"
    return f"{found.value:.4g} ({found.low:.4g} to {found.high:.4g})"


def as_data(
    options: Namespace, system: System, samples: Sequence[Sample], found: Sequence[FirstTimes]
) -> dict[str, Any]:
    """Return the statistics of each predicate, and the runs themselves, as data."""
    labels = [predicate.label for predicate in system.predicates]
    return {
        "file": options.file,
        "kind": system.kind.value,
        "seed": options.seed,
        "runs": len(samples),
        "complete": len(samples) == options.runs,
        "steps": options.steps,
        "until": options.until,
        "confidence": CONFIDENCE,
        "ends": {end.name.lower(): sum(each.end is end for each in samples) for end in End},
        "predicates": [
            {
                "label": each.label,
                "runs": each.runs,
                "share": _estimate_data(each.share),
                "first": None
                if each.time is None
                else {
                    **_estimate_data(each.time),
                    "least": each.least,
                    "most": each.most,
                    "run": each.first_run,
                },
            }
            for each in found
        ],
        "samples": [
            {
                "run": each.number,
                "steps": each.steps,
                "time": each.time,
                "end": each.end.name.lower(),
                "first": dict(zip(labels, each.first, strict=True)),
            }
            for each in samples
        ],
    }


def _estimate_data(found: SampleEstimate) -> dict[str, Any]:
    interval = [found.low, found.high] if isfinite(found.low) else None
    return {"value": found.value, "interval": interval}


def curves(samples: Sequence[Sample], found: Sequence[FirstTimes]) -> Iterator[Curve]:
    """Yield for each predicate, as far as colours reach, the share of runs in which it was true by each time."""
    for number, each in enumerate(found[: len(PALETTE)]):
        points = list(shares_until(samples, number))
        apart = -(-len(points) // MOST_POINTS) or 1
        kept = [point for rank, point in enumerate(points, 1) if rank % apart == 0 or rank == len(points)]
        estimates = [share(runs, len(samples)) for _, runs in kept]
        yield Curve(
            each.label,
            [time for time, _ in kept],
            [estimate.value for estimate in estimates],
            [estimate.low for estimate in estimates],
            [estimate.high for estimate in estimates],
        )


def _draw(options: Namespace, system: System, samples: Sequence[Sample], found: Sequence[FirstTimes]) -> None:
    from bigactors.picture_files import draw_first_times  # only drawing needs pictures

    end = options.until if options.until is not None else max(each.time for each in samples)
    left = len(found) - len(PALETTE)
    gloss = f"the share of {counted(len(samples), 'run')} in which a predicate was true by then, with intervals of "
    gloss += f"{CONFIDENCE:.0%}" + (f"; {counted(left, 'more predicate')} not drawn" if left > 0 else "")
    draw_first_times(
        list(curves(samples, found)),
        options.plot,
        Path(options.file).name,
        gloss=gloss,
        axis="time" if system.kind is SystemKind.SBRS else "steps",
        end=end,
    )
