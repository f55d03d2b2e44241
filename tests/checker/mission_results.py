"""Results of small missions, and one whose every text is hostile."""

from checked_missions import SPARE, load, moves, start

from checker import Bound, Limits, Outcome, Report, Stop, Trace, Verdict, Violation, check
from checker.reports.results import CheckResult, Issue, Level
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property

ENTERS = moves("gate0", "a", "uav0")
GAPS = """
BigActor a hosted_at uav0 with_behavior {
  observe(PARENT(HOST))
  react {
    case o if uav1 in o => control(MOVE_HOST_TO gate0)
    case o => skip
  }
}
check { local_consistency }
"""
"""A case that is never taken, and hence a property that says nothing."""
PILOTS = moves("south0", "a", "uav0") + moves("gate0", "b", "uav0")
HOSTILE = '<a b="c"> & ]]> ::error::%0A,line=1\n\r\t\x00\x07\x1b[31m\x9f\ud800\ufffe\'→'
"""Markup, commands, controls, a lone surrogate and a non-character."""


def result(text, name="m.mission", limits=SPARE):
    mission = load(text)
    report = check(mission, limits=limits)
    return CheckResult(name, name, report, check_line=7, text=mission.source.text)


def cut_off(text=ENTERS, name="m.mission"):
    return result(text, name, Limits(configurations=2))


def failed(*issues, name="m.mission"):
    return CheckResult(name, name, failures=issues)


MISTAKE = Issue(
    Level.WRONG, "LS201", "LS201", "unknown name 'gaet0'", 17, 24, 17, 29,
    identity=("LS201", "unknown name 'gaet0'"), details=("hint: did you mean 'gate0'?",),
)  # fmt: skip
UNPLACED = Issue(Level.WRONG, "mistake", "mistake", "there is no such file", identity=("mistake",))
NOT_BEGUN = Issue(Level.INCOMPLETE, "exploration", "incomplete", "not begun", identity=("incomplete",))
BUG = Issue(Level.BUG, "exploration", "internal error", "internal error: KeyError: 'x'", identity=("bug",))


def hostile():
    asked = (
        Property(PropertyKind.INVARIANT, HOSTILE, line=3),
        Property(PropertyKind.REACHABLE, f"{HOSTILE} never", line=4),
    )
    trace = Trace(start(ENTERS))
    verdicts = (
        Verdict(asked[0], Outcome.VIOLATED, (Violation(HOSTILE, HOSTILE, trace, (HOSTILE,)),), 1),
        Verdict(asked[1], Outcome.INCOMPLETE),
    )
    unkept = Bound(Stop.NO_CHECKPOINT, (HOSTILE, HOSTILE))
    return CheckResult(HOSTILE, HOSTILE, Report(verdicts, 1, 0, 0, (unkept,), notes=(HOSTILE,)))


def all_sorts():
    return [
        result(ENTERS, "holds.mission"),
        result(PILOTS, "race.mission"),
        cut_off(name="cut_off.mission"),
        failed(MISTAKE, UNPLACED, name="mistaken.mission"),
        failed(NOT_BEGUN, name="not_begun.mission"),
        failed(BUG, name="bug.mission"),
        hostile(),
    ]
