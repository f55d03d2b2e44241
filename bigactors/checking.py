"""Check one mission: its report, or the failure."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from bigactors.code_digest import build_digest
from bigactors.diagnostic_output import diagnostic_json
from bigactors.exits import Exit
from bigactors.files import file_stem
from bigactors.mission_lookup import checkable, digest_of, open_mission
from bigactors.mistakes import Mistake, describe_bug
from bigactors.progress import watching
from bigactors.terminal import tell
from checker import (
    CheckpointError,
    Cluster,
    ClusterError,
    CombinationError,
    CompilerError,
    Engine,
    Keeping,
    Limits,
    MachineError,
    Reduction,
    RefusedError,
    Report,
    check,
    report_json,
)
from checker.engines.capabilities import REDUCTIONS, Feature, require
from checker.engines.contract import TickError, ZoneClock
from checker.properties.findings import MOST_VIOLATIONS
from physical import RegionError
from semantics.state.canonical import digest
from semantics.state.setting import Control
from semantics.state.signature import Name
from semantics.timing.dates import lapse_text
from specs.elaboration import ElaboratedMission, Variation

FAILURE_SCHEMA = "bigactors.failure/1"
REPORTS_SCHEMA = "bigactors.reports/1"

REFUSALS: dict[type[Exception], tuple[Exit, str]] = {
    CheckpointError: (Exit.MISTAKE, "leave --resume out to begin anew"),
    ClusterError: (Exit.MISTAKE, "leave --engine ray out to check it in one process"),
    CompilerError: (
        Exit.INCOMPLETE,
        "set NUMBA_CACHE_DIR to a folder that you may write, or add --engine reference",
    ),
    TickError: (Exit.MISTAKE, "give timing a larger tick, or shorter times"),
    CombinationError: (Exit.MISTAKE, ""),
    RefusedError: (Exit.MISTAKE, "check it without, or with the other reduction alone"),
    MachineError: (Exit.INCOMPLETE, "try again when less else runs here, or leave --engine out"),
    MemoryError: (Exit.INCOMPLETE, "explore less: --max-memory SIZE, --max-configurations N"),
}
"""The exit code and the hint for each refusal or failure of an exploration; an exception's own `remedy` comes first."""


@dataclass(frozen=True, slots=True)
class Checked:
    """A mission and its report.

    Attributes:
        name: The mission's path or name, as the user gave it.
        mission: The elaborated mission.
        digest: The digest of its content.
        report: Its report.
        interrupted: Whether the user ended the check.
    """

    name: str
    mission: ElaboratedMission
    digest: str
    report: Report
    interrupted: bool

    @property
    def exit(self) -> Exit:
        """The exit code: 0, 1 or 3."""
        return Exit(self.report.exit_code)

    def as_json(self) -> dict[str, Any]:
        """Return the report as plain data."""
        report = report_json(self.name, self.digest, self.report, self.mission.setting.control)
        source, warnings = self.mission.source, self.mission.warnings_after(self.report.suspected)
        return report | {"warnings": [diagnostic_json(each, source) for each in warnings]}


@dataclass(frozen=True, slots=True)
class FailedMission:
    """A mission without a report: it has a mistake (2), was interrupted or not begun (3), or we have a bug (4)."""

    name: str
    exit: Exit
    message: str
    details: tuple[dict[str, object], ...] = ()
    interrupted: bool = False

    def as_json(self) -> dict[str, Any]:
        """Return the failure as plain data."""
        return {
            "schema": FAILURE_SCHEMA,
            "mission": self.name,
            "complete": False,
            "exit_code": int(self.exit),
            "message": self.message,
            "diagnostics": list(self.details),
        }


@dataclass(frozen=True, slots=True)
class How:
    """The keyword arguments of `check`, the same for all missions.

    With `regions`, ways are computed where they can be, and nothing is refused.
    """

    engine: Engine | None = None
    violations: int = MOST_VIOLATIONS
    reduce: tuple[Reduction, ...] = ()
    keeping: Keeping | None = None
    cluster: Cluster | None = None
    threads: int | None = None
    clock: ZoneClock = ZoneClock.LOCAL
    times: bool = False
    ways: bool = False
    regions: bool = False


def check_mission(
    name: str,
    limits: Limits,
    variation: Variation,
    how: How | None = None,
) -> Checked | FailedMission:
    """Check one mission. Print a failure on the standard error, and return it."""
    how = how or How()
    try:
        mission = checkable(open_mission(name, variation))
        with watching(mission.name, limits.interruption) as watch:
            report = check(
                mission,
                limits=limits,
                report=watch,
                engine=how.engine,
                violations=how.violations,
                reduce=how.reduce,
                keeping=how.keeping and _of_this(how.keeping, mission, limits),
                cluster=how.cluster,
                threads=how.threads,
                clock=how.clock,
                times=how.times,
                ways=how.ways or (how.regions and unlisted_ways(mission, how) is None),
                suspected=mission.suspicions,
            )
        if how.times:
            _check_times(name, mission, report)
        for short in short_limits(mission, dict(report.flights)):
            tell(f"{name}: {short}: `run` refuses that")
        return Checked(name, mission, digest_of(mission), report, watch.interrupted)
    except tuple(REFUSALS) as refused:
        code, hint = next(said for kind, said in REFUSALS.items() if isinstance(refused, kind))
        hint = getattr(refused, "remedy", hint)
        mistake = Mistake(str(refused) or "there is not enough memory", hint, name)
        tell(str(mistake))
        return FailedMission(name, code, mistake.message, mistake.details)
    except RegionError as error:
        what = f"{error.where}: {error.message}" if error.where else error.message
        return _failed(name, Mistake(f"a property asks for a region, and {what}", error.hint, name))
    except Mistake as mistake:
        return _failed(name, mistake)
    except KeyboardInterrupt:
        message = "interrupted: nothing is decided of it"
        tell(f"{name}: {message}")
        return FailedMission(name, Exit.INCOMPLETE, message, interrupted=True)
    except Exception as error:  # any other exception is our bug; the remaining missions are still checked
        tell(f"{name}:\n{describe_bug(error)}")
        return FailedMission(name, Exit.BUG, f"internal error: {type(error).__name__}: {error}")


def unlisted_ways(mission: ElaboratedMission, how: How) -> str | None:
    """Return why the ways of a mission's flights cannot be listed, None if they can."""
    asked = {Feature.WAYS, *(REDUCTIONS[each] for each in how.reduce)}
    try:
        require(frozenset(asked | ({Feature.ATOMIC} if mission.setting.control is Control.ATOMIC else set())))
    except CombinationError as unmet:
        return str(unmet)
    return None


def _failed(name: str, mistake: Mistake) -> FailedMission:
    tell(str(mistake))
    return FailedMission(name, Exit.MISTAKE, mistake.message, mistake.details)


def _check_times(name: str, mission: ElaboratedMission, report: Report) -> None:
    """Explain a report without the times that the user asked for."""
    if mission.setting.timing is None:
        tell(f"{name}: it has no times: no duration is given; write a section timing {{ ... }}")
    elif report.schedule is None:
        tell(f"{name}: it has no times: time stops; see the verdict on computation")


def _of_this(keeping: Keeping, mission: ElaboratedMission, limits: Limits) -> Keeping:
    """Bind checkpoints to the mission with its variation, to the build, and to the limit of pending requests."""
    bound = digest((digest_of(mission), build_digest(), limits.pending))
    folder = keeping.folder and str(Path(keeping.folder) / file_stem(mission.name))
    return replace(keeping, folder=folder, digest=bound)


def check_missions(
    names: list[str], limits: Limits, variation: Variation, how: How | None = None
) -> Iterator[Checked | FailedMission]:
    """Check missions in turn; after an interruption, the rest fail as not begun."""
    interrupted = False
    for name in names:
        if interrupted:
            yield FailedMission(name, Exit.INCOMPLETE, "not begun")
            continue
        result = check_mission(name, limits, variation, how)
        interrupted = result.interrupted
        yield result


def results_json(results: list[Checked | FailedMission], code: Exit) -> dict[str, Any]:
    """Return the results as plain data: the one report, or a list of several."""
    if len(results) == 1:
        return results[0].as_json()
    reports = [result.as_json() for result in results]
    return {"schema": REPORTS_SCHEMA, "exit_code": int(code), "reports": reports}


def short_limits(mission: ElaboratedMission, flights: Mapping[Name, float]) -> Iterator[str]:
    """Yield a sentence for each live limit that a flight may reach within its allowed time.

    `flights` is the longest flight of each bigActor in seconds.
    """
    for limit in mission.precautions.limits:
        for agent, seconds in sorted(flights.items()):
            if limit.covers("FLY", agent) and limit.seconds < seconds:
                given, most = (lapse_text(round(1000 * each)) for each in (limit.seconds, seconds))
                yield f"live lets {agent} fly for {given}, but by the times its flight may take {most}"
