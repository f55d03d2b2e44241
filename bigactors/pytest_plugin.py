"""A pytest plugin: it collects mission files, makes each property a test, and shows its shortest trace on failure.

Missions are tests only on request: those matched by `mission_files` in the configuration, and those given as
arguments of pytest (docs/how-to/python.md). A mission is explored once in a process, when the first of its tests
runs.

pytest loads this module in every run, so it imports nothing slow. PYTEST_DONT_REWRITE: it has no assertions.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator
from fnmatch import fnmatchcase
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from checker import Limits, Report, Verdict
    from checker.reports.results import CheckResult, Issue
    from semantics import Property
    from specs.elaboration import ElaboratedMission, Variation


class MissionWarning(UserWarning):
    """A warning on a mission: on its text, on a vacuous verdict, or on an unreachable part."""


class PropertyViolatedError(Exception):
    """A violated property. A test listed in `mission_violated` expects it."""


class PropertyUndecidedError(Exception):
    """A property that the search did not decide within its limits."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the command-line options and the configuration settings of missions."""
    group = parser.getgroup("missions", "missions of bigactors")
    group.addoption(
        "--mission-engine", choices=("reference", "fast"), help="the engine that explores missions"
    )
    group.addoption("--mission-control", choices=("atomic", "timed"), help="whether control takes time")
    group.addoption(
        "--mission-scheduler",
        choices=("program_order", "unordered", "fcfs"),
        help="which request is served next",
    )
    group.addoption(
        "--mission-max-configurations",
        metavar="N",
        type=_value("at_least_one"),
        help="visit no more than N configurations of a mission",
    )
    group.addoption(
        "--mission-max-time",
        metavar="SECONDS",
        type=_value("seconds"),
        help="of each mission (default: no limit)",
    )
    parser.addini(
        "mission_files", "patterns of mission files that are tests, such as missions/*.mission", "linelist"
    )
    parser.addini(
        "mission_violated",
        "patterns of tests that expect a violated property, such as missions/broken.mission::race_freedom",
        "linelist",
    )


def _value(name: str) -> Callable[[str], Any]:
    """Return the command line's parser of an option's value; it is loaded at the first use."""

    def read(text: str) -> Any:
        from bigactors.arguments import values  # noqa: PLC0415 - only runs with the option need it

        return getattr(values, name)(text)

    return read


def pytest_configure(config: pytest.Config) -> None:
    """Declare the marker `mission`."""
    config.addinivalue_line("markers", "mission: a property of a mission (bigactors); every one has it")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> MissionFile | None:
    """Collect a mission file, if it is requested."""
    if file_path.suffix != ".mission":
        return None
    asked = any(map(file_path.match, parent.config.getini("mission_files")))
    if asked or parent.session.isinitpath(file_path):
        return MissionFile.from_parent(parent, path=file_path)
    return None


class MissionFile(pytest.File):
    """A mission, as the collector of its properties."""

    def collect(self) -> Iterator[PropertyItem]:
        """Yield a test for each property; a mistake in the mission is a collection error."""
        from specs import MissionError  # noqa: PLC0415 - pytest loads this module in every run

        try:
            properties = self.mission.properties
        except MissionError as error:
            raise self.CollectError(str(error)) from error
        for each in properties:
            yield PropertyItem.from_parent(self, name=each.name, asked=each)

    @cached_property
    def mission(self) -> ElaboratedMission:
        """The mission, under the scheduler and the control of the options."""
        from specs.elaboration import load_mission, require_bigactor  # noqa: PLC0415 - the same

        mission = load_mission(Path(os.path.relpath(self.path)), _variation(self.config))
        require_bigactor(mission)
        return mission

    @cached_property
    def report(self) -> Report:
        """The report of an exploration on the selected properties."""
        from checker import Engine, check  # noqa: PLC0415 - the same

        engine = self.config.getoption("mission_engine")
        selected = [
            item.asked
            for item in self.session.items
            if isinstance(item, PropertyItem) and item.parent is self
        ]
        return check(
            self.mission,
            selected,
            _limits(self.config),
            engine=engine and Engine(engine),
            suspected=self.mission.suspicions,
        )

    @cached_property
    def result(self) -> CheckResult:
        """The report with line numbers in the mission's text."""
        from bigactors.check_outputs import result_on  # noqa: PLC0415 - the same

        return result_on(self.mission, self.mission.source.name, self.report)

    @cached_property
    def unsaid(self) -> list[Issue]:
        """The warnings on the whole mission that are still to be given."""
        return [*self.result.cautions, *self.result.gaps()]

    def warn_of(self, verdict: Verdict) -> None:
        """Warn of the limits of a verdict; with the first verdict, also give the warnings on the whole mission."""
        while self.unsaid:
            self.warn_at(self.unsaid.pop(0))
        for issue in self.result.remarks_of(verdict):
            self.warn_at(issue)

    def warn_at(self, issue: Issue) -> None:
        """Warn at a line of the mission."""
        warnings.warn_explicit(MissionWarning(issue.message), None, str(self.path), issue.line)


class PropertyItem(pytest.Item):
    """A property of a mission: a test."""

    parent: MissionFile

    def __init__(self, *, asked: Property, **more: Any) -> None:
        super().__init__(**more)
        self.asked = asked
        self.funcargs: dict[
            str, object
        ] = {}  # no fixtures, but plugins such as pytest-lsp read this of every test
        self.add_marker("mission")
        if any(fnmatchcase(self.nodeid, pattern) for pattern in self.config.getini("mission_violated")):
            reason = "mission_violated"
            self.add_marker(pytest.mark.xfail(raises=PropertyViolatedError, strict=True, reason=reason))

    def runtest(self) -> None:
        """Pass if the property holds."""
        from checker import Outcome  # noqa: PLC0415 - pytest loads this module in every run
        from checker.reports.results import placed_text  # noqa: PLC0415 - the same

        result = self.parent.result
        verdict = self.parent.report.verdicts[self.name]
        self.parent.warn_of(verdict)
        said = "\n\n".join(placed_text(result, issue) for issue in result.issues_of(verdict))
        if verdict.outcome is Outcome.VIOLATED:
            raise PropertyViolatedError(said)
        if verdict.outcome is Outcome.INCOMPLETE:
            raise PropertyUndecidedError(said)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text of a property's or a mission's failure, and a traceback of anything else."""
        if isinstance(excinfo.value, PropertyViolatedError | PropertyUndecidedError | MissionWarning):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the file and the line of the property."""
        return self.path, self.asked.line - 1 if self.asked.line else None, self.name


def _variation(config: pytest.Config) -> Variation:
    from semantics import Control, Scheduler  # noqa: PLC0415 - pytest loads this module in every run
    from specs.elaboration import Variation  # noqa: PLC0415 - the same

    scheduler, control = config.getoption("mission_scheduler"), config.getoption("mission_control")
    return Variation(scheduler and Scheduler(scheduler), control and Control(control))


def _limits(config: pytest.Config) -> Limits:
    from checker import Limits  # noqa: PLC0415 - the same

    seconds, most = config.getoption("mission_max_time"), config.getoption("mission_max_configurations")
    return Limits(most or Limits().configurations, seconds)
