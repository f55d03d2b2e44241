"""A check: its settings, the exploration, the printed report, and the written files."""

from __future__ import annotations

import re
import sys
from argparse import Namespace
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from bigactors.check_outputs import Output, cautions_of, outputs_of, unexplained, write_outputs
from bigactors.checking import Checked, FailedMission, How, check_missions
from bigactors.exits import Exit, worst
from bigactors.files import check_writable, file_stem, make_folder, write_json
from bigactors.mission_lookup import variation_of
from bigactors.mistakes import Mistake
from bigactors.terminal import paint, say, tell
from checker import Cluster, CombinationError, Engine, Interruption, Keeping, Limits, Reduction, report_text
from checker.check import reductions_of
from checker.engines.capabilities import engines, features
from checker.engines.contract import ZoneClock
from checker.engines.fast.compiled.numba_loading import ALONE
from checker.limits import MOST_PENDING, Stop
from checker.reports.report import MARKS, SCREEN, coverage_text
from checker.reports.results import Issue, caution_text
from checker.verdicts import Outcome, Report
from physical.wordings import counted
from semantics.successors import rules_of

if TYPE_CHECKING:
    from bigactors.signatures import SigningKey
    from specs.elaboration import ElaboratedMission


MOST, MOST_OF_REFERENCE = 100_000_000, 2_000_000
"""The most configurations visited. Those of the reference explorer take a thousand bytes each."""


def settings_of(options: Namespace) -> tuple[Limits, How]:
    """Return the limits of the exploration and the way in which missions are explored.

    Raises:
        Mistake: Two options do not work together.
    """
    limits, how = _limits_of(options), _how_of(options)
    asked = features(limits, how.keeping, how.reduce, cluster=how.cluster, threads=how.threads, ways=how.ways)
    try:
        engines(asked, how.engine)
    except CombinationError as unmet:
        raise Mistake(str(unmet), unmet.remedy) from unmet
    if limits.spill is not None:
        make_folder(limits.spill)
    return limits, how


def _how_of(options: Namespace) -> How:
    return How(
        options.engine and Engine(options.engine),
        options.violations,
        tuple(map(Reduction, options.reduce or ())),
        _keeping_of(options),
        _cluster_of(options),
        options.threads,
        ZoneClock(options.clock),
        options.times,
        options.ways,
        any(name == "geojson" for name, _ in options.output),
    )


def _limits_of(options: Namespace) -> Limits:
    usual = MOST_OF_REFERENCE if options.engine == "reference" else MOST
    return Limits(
        options.max_configurations or usual * (options.workers or 1),
        options.max_time,
        pending=options.max_pending or MOST_PENDING,
        memory=options.max_memory,
        spill=options.spill,
    )


def _cluster_of(options: Namespace) -> Cluster | None:
    """Return the workers of the exploration; None without any option of them."""
    if options.workers is None and options.address is None:
        return None
    return Cluster(options.workers or Cluster().workers, options.address)


def _keeping_of(options: Namespace) -> Keeping | None:
    """Return the options on checkpoints and re-checking; None without any."""
    if options.checkpoint is None and options.paranoid is None and not options.resume:
        return None
    return Keeping(options.checkpoint, options.resume, every=options.every, doubted=options.paranoid or 0)


COLOURS = {Outcome.HOLDS: "green", Outcome.VIOLATED: "red", Outcome.INCOMPLETE: "yellow"}
SIGNS = {MARKS[outcome]: colour for outcome, colour in COLOURS.items()}

WORDS = {
    Exit.HOLDS: (MARKS[Outcome.HOLDS], "holds"),
    Exit.VIOLATED: (MARKS[Outcome.VIOLATED], "violated"),
    Exit.MISTAKE: ("!", "mistake"),
    Exit.INCOMPLETE: (MARKS[Outcome.INCOMPLETE], "incomplete"),
    Exit.BUG: ("!", "internal error"),
}


MOST_ALIKE, MOST_GAPS = 3, 5
"""The most warnings of one code, and the most gaps of coverage, on a screen."""


def check_and_report(options: Namespace) -> Exit:
    """Check missions, with `--watch` at each save; print the reports and write the requested files."""
    ALONE.set(True)
    limits, how = settings_of(options)
    if options.trace:
        make_folder(options.trace)
    key = _check_verdict(options)
    outputs = outputs_of(options)
    variation = variation_of(options)

    def check(interruption: Interruption) -> Iterator[Checked | FailedMission]:
        return check_missions(options.files, replace(limits, interruption=interruption), variation, how)

    def report(results: Iterable[Checked | FailedMission]) -> Exit:
        return report_all(results, options, outputs, key)

    if not options.watch:
        return report(check(Interruption()))
    from bigactors.commands.check.continuous_check import check_at_each_save  # only --watch needs it

    if any(output.to_standard_output for output in outputs):
        raise Mistake("--watch prints its reports", "give a file in the place of -")
    return check_at_each_save(options.files, variation, check, report)


def report_all(
    checked: Iterable[Checked | FailedMission],
    options: Namespace,
    outputs: Sequence[Output],
    key: SigningKey | None,
) -> Exit:
    """Print the reports as they come, and write the requested files."""
    alone = any(output.to_standard_output for output in outputs)
    results: list[Checked | FailedMission] = []
    folders: set[str] = set()
    for result in checked:
        results.append(result)
        if not alone:
            for line in report_lines(
                result, traces=not options.no_traces, ways=options.ways, everything=options.all
            ):
                say(coloured(line))
        if options.verdict and isinstance(result, Checked):
            keep_verdict(result, options, key)
        if options.trace and isinstance(result, Checked):
            keep_evidence(result, options, folders)
    code = worst(result.exit for result in results)
    if len(results) > 1 and not alone:
        for line in summary(results):
            say(coloured(line))
    write_outputs(outputs, results, code)
    return code


def report_lines(
    result: Checked | FailedMission, *, traces: bool, ways: bool = False, everything: bool = False
) -> Iterator[str]:
    """Yield the printed lines about one mission; none for a failed one, whose message is already printed.

    They fit a screen, about, unless everything is wanted.
    """
    if isinstance(result, FailedMission):
        return
    report = result.report if ways else replace(result.report, corridors=None)
    cautions = cautions_of(result.mission, result.report)
    before = list(_caution_lines(result.name, cautions, everything=everything))
    after = list(_tally_lines(result, report, cautions, everything=everything))
    yield from before
    screen = None if everything else SCREEN - len(before) - len(after)
    yield from report_text(result.name, report, traces=traces, screen=screen)
    yield from after


def _caution_lines(name: str, cautions: Sequence[Issue], *, everything: bool) -> Iterator[str]:
    """Yield the warnings on a text, by default a few of each code."""
    shown: Counter[str] = Counter()
    left: defaultdict[str, list[int]] = defaultdict(list)
    for caution in cautions:
        shown[caution.rule] += 1
        if everything or shown[caution.rule] <= MOST_ALIKE:
            yield from caution_text(name, caution)
        else:
            left[caution.rule].append(caution.line)
    for code, lines in left.items():
        where = sorted(set(lines))
        listed = f"line{'' if len(where) == 1 else 's'} {', '.join(map(str, where))}"
        yield f"{name}: warning: {code}: {len(lines)} more, in {listed}: --all"


def _tally_lines(
    result: Checked, report: Report, cautions: Sequence[Issue], *, everything: bool
) -> Iterator[str]:
    """Yield the unused rules, the remedies for an incomplete check, and the coverage."""
    silent = [
        rule.__name__
        for rule in rules_of(result.mission.setting.control)
        if rule.__name__ not in report.rules
    ]
    if silent:
        when = "never used" if report.complete and not report.reduced else "not used so far"
        yield f"  rules {when}: {', '.join(silent)}"
    if not report.complete:
        yield f"  to decide more: {remedies(result.mission, report)}"
    if report.coverage is not None:
        gaps = unexplained(report.coverage, cautions).gaps
        shown = gaps if everything else gaps[:MOST_GAPS]
        yield from coverage_text(
            result.name, replace(report.coverage, gaps=shown), result.mission.source.text
        )
        if len(shown) < len(gaps):
            yield f"  {counted(len(gaps) - len(shown), 'warning')} more: --all"


def remedies(mission: ElaboratedMission, report: Report) -> str:
    """Return remedies for an exploration that a limit cut off."""
    if all(bound.stop is Stop.PENDING for bound in report.bounds):
        waits = "let each loop wait for its requests (LS708 names the loops that don't)"
        return f"{waits}, or raise the limit that stopped it: --max-pending"
    less: tuple[str, ...] = ()
    if mission.setting.timing is not None:
        less = ("give timing a larger tick, of which all durations are whole numbers",)
    elif not report.reduced and (sound := reductions_of(mission)):
        less = (f"visit less with --reduce {','.join(map(str, sound))} (docs/explanation/reduction.md)",)
    smaller = "name fewer entities and places, or let fewer bigActors act at once"
    return "; ".join((*less, smaller, "or raise the limit that stopped it: --max-configurations, --max-time"))


def summary(results: list[Checked | FailedMission]) -> Iterator[str]:
    """Yield a line for each of several missions."""
    width = max(len(result.name) for result in results)
    yield ""
    for result in results:
        sign, word = WORDS[result.exit]
        if isinstance(result, Checked):
            report = result.report
            counts = f"{counted(report.configurations, 'configuration')}, {counted(report.transitions, 'transition')}"
        else:
            counts = result.message.splitlines()[0][:100]
        yield f"  {sign} {result.name:<{width}}  {word:<10}  {counts}"


def coloured(line: str) -> str:
    """Return a line with its mark coloured, if the output shows colours.

    >>> coloured("  ✓ deadlock_freedom  holds")
    '  ✓ deadlock_freedom  holds'
    """
    found = re.match(r"  ([✓✗?!]) ", line)
    if not found:
        return line
    colour = SIGNS.get(found[1], "red")
    return f"  {paint(found[1], colour, sys.stdout)} {line[4:]}"


def _check_verdict(options: Namespace) -> SigningKey | None:
    """Return the key that signs the verdict, if any; raises Mistake before the exploration."""
    if options.verdict is None:
        if options.sign is not None:
            raise Mistake("--sign signs a verdict", "give its file: --verdict FILE")
        return None
    if len(options.files) > 1:
        raise Mistake("--verdict writes the verdict of one mission", "check the missions one by one")
    check_writable(options.verdict)
    if options.sign is None:
        return None
    from bigactors.signatures import load_key  # few verdicts are signed

    return load_key(options.sign)


def keep_verdict(checked: Checked, options: Namespace, key: SigningKey | None) -> None:
    """Write the verdict on a mission, and print its path."""
    from bigactors.verdict_files import verdict_json  # few checks are for a flight

    data = verdict_json(checked, options.engine or "by size", key)
    write_json(options.verdict, data)
    tell(f"  verdict: {'holds' if data['holds'] else 'does not hold'}, written to {options.verdict}")


def keep_evidence(checked: Checked, options: Namespace, taken: set[str]) -> None:
    """Write the traces of a mission into a folder of its own, and print their paths."""
    from bigactors.trace_files import write_evidence  # only --trace waits for pictures

    folder, sources = options.trace, variation_of(options).sources
    stem = name = file_stem(Path(checked.name).stem)
    number = 2
    while name in taken:
        name, number = f"{stem}-{number}", number + 1
    taken.add(name)
    for written in write_evidence(checked, Path(folder) / name, sources):
        tell(f"  trace: {written}/trace.html, .txt, .json and .svg")
