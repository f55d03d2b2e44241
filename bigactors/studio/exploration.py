"""The explorer: the steps that are possible, taken one by one, as answers to requests in JSON.

A run is an address, the numbers of its steps: `0.2.1`. With times, a step may have its tick: `0.2@15.1`. A run from a
file that the mission's own choices do not make begins with the number of its steps: `~7.0` is its first seven, and one
choice. Each request has the whole address, so that a link, a reload or another page comes back to the same run.
"""

from __future__ import annotations

import random
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from bigactors.commands.simulate.one_run import Choice, OneRun, nothing_more
from bigactors.mission_lookup import digest_of
from bigactors.mistakes import Mistake
from bigactors.studio.configuration_graph import (
    MOST_AROUND,
    MOST_NODES,
    ConfigurationGraph,
    graph_json,
    reached,
)
from bigactors.studio.recorded_run import RecordedRun, run_in_bytes, run_in_file, run_in_trace
from bigactors.studio.run_address import CHOSEN, joined, parts_of
from bigactors.studio.run_views import parts_json, run_json, sections_of
from bigactors.studio.values_here import Visit, values_here, wrong_here
from checker import Limits, ReplayError, Trace, check, to_json
from checker.properties.ownership import owned
from checker.properties.stale_steps import stale_steps
from checker.reports.causes import Cause, causes_of, formulas_of
from checker.reports.plain_steps import step_words
from checker.verdicts import Violation
from physical.wordings import counted
from semantics.properties.kinds import PropertyKind
from semantics.properties.property import Property, watching
from semantics.properties.propositions import holds
from semantics.races.monitor import monitored
from semantics.state.cell_values import MONITOR
from semantics.state.configuration import Configuration
from semantics.successors import expand
from semantics.timing.dates import clock_text
from specs import MissionError, Source
from specs import syntax as s
from specs.elaboration import ElaboratedMission, Variation, elaborate
from specs.parser import parse

MOST_STEPS: Final = 1_000
"""The longest run."""

MOST_TRIED: Final = 20_000
"""The most configurations of a search for a proposition."""

SECONDS: Final = 10.0
"""The most seconds of a search."""

GOAL: Final = "go to where"


class ExplorationError(ValueError):
    """A request that cannot be answered; the message says why."""


class Exploration:
    """An exploration of one mission by hand: a function of its requests, with the last run and that of the last file.

    `given` is the file of the request that loads `given`.
    """

    def __init__(
        self, mission: ElaboratedMission, directory: Path | None = None, given: Path | None = None
    ) -> None:
        self.mission = mission
        self._directory = Path(mission.source.name).parent if directory is None else directory
        self._given = given
        initial = watching(mission.initial, mission.properties)
        races = any(each.kind is PropertyKind.RACE_FREEDOM for each in mission.properties)
        self.initial = monitored(initial) if races and not owned(initial) else initial
        self._run, self._tokens = OneRun(self.initial), list[str]()
        self._recorded: RecordedRun | None = None
        self._origin = ""

    def handle(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Answer a request; a request that cannot be answered gets the reason as `error`.

        `{"ask": "run", "run": ADDRESS, "at": K}` shows a run at its configuration K, by default at its end. `random`
        (with `count` and `seed`), `goto` (with `where`, a proposition) and `load` (with `trace`, with the `content` of
        a file in base 64, or with `given`) show another run. `save` returns a trace, and `graph` the configurations
        around.
        """
        asked = {
            "run": self._look,
            "random": self._random,
            "goto": self._goto,
            "load": self._load,
            "save": self._save,
            "graph": self._graph,
        }.get(str(request.get("ask")))
        try:
            if asked is None:
                raise ExplorationError("this is no request of the explorer")
            return asked(request)
        except MissionError as error:
            found = error.diagnostics[0]
            return {"error": f"{found.message}{f': {found.hint}' if found.hint else ''}"}
        except (Mistake, ReplayError, ValueError) as error:
            return {"error": str(error)}

    # --- runs -------------------------------------------------------------------------------------------------

    def _go(self, address: object) -> OneRun:
        """Return the run of an address."""
        if not isinstance(address, str):
            raise ExplorationError("give the run, as the numbers of its steps: '0.2.1'")
        origin, tokens = parts_of(address)
        if len(tokens) > MOST_STEPS:
            raise ExplorationError(f"the run is longer than {MOST_STEPS:,} steps")
        if origin != self._origin:
            self._begin(origin)
        same = 0
        while same < min(len(tokens), len(self._tokens)) and tokens[same] == self._tokens[same]:
            same += 1
        while len(self._tokens) > same:
            self._tokens.pop()
            self._run.undo()
        for token in tokens[same:]:
            self._take(token)
        return self._run

    def _begin(self, origin: str) -> None:
        """Begin a run anew: with no step, or with the first steps of the run from a file."""
        self._run, self._origin, self._tokens = self._first_steps(origin), origin, []

    def _first_steps(self, origin: str) -> OneRun:
        if not origin:
            return OneRun(self.initial)
        if self._recorded is None:
            raise ExplorationError("the run began with steps from a file: open that file again")
        trace, count = self._recorded.trace, int(origin[1:])
        if count > len(trace):
            raise ExplorationError(f"the run from the file has only {counted(len(trace), 'step')}")
        steps, dates = trace.steps[:count], trace.dates[:count]
        return OneRun.following(replace(trace, steps=steps, dates=dates, loop=None, race=None))

    def _take(self, token: str) -> None:
        found, choices = CHOSEN.fullmatch(token), self._run.choices()
        if found is None or int(found[1]) >= len(choices):
            raise ExplorationError(
                f"c{len(self._run.taken)} has no step {token[:20]!r}: the mission may have changed"
            )
        self._run.take(choices[int(found[1])], None if found[2] is None else int(found[2]))
        self._tokens.append(token)

    @property
    def _address(self) -> str:
        return joined(self._origin, *self._tokens)

    def _address_at(self, at: int) -> str:
        """Return the address of the run up to one of its configurations."""
        own = at - self._first
        return f"~{at}" if own < 0 else joined(self._origin, *self._tokens[:own])

    @property
    def _first(self) -> int:
        """The number of steps that the run has from a file."""
        return len(self._run.taken) - len(self._tokens)

    def _look(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Show a run, and one of its configurations."""
        run = self._go(request.get("run"))
        at = request.get("at", len(run.taken))
        if not isinstance(at, int) or isinstance(at, bool) or not 0 <= at <= len(run.taken):
            raise ExplorationError(f"there is no c{str(at)[:20]}: the run ends with c{len(run.taken)}")
        trace = _told(run.trace)
        own = at - self._first
        c, before = trace.configurations[at], trace.configurations[at - 1] if at else None
        here = self._visit(trace, at)
        return {
            "run": self._address,
            "here": self._address_at(at),
            "next": self._tokens[own] if 0 <= own < len(self._tokens) else "",
            "at": at,
            "length": len(trace),
            **self._run_json(trace),
            "choices": [self._choice_json(rank, c, each) for rank, each in enumerate(here.choices)],
            "nothing": "" if here.choices else nothing_more(run),
            "values": values_here(self.mission.properties, here),
            "parts": parts_json(c, before),
            "view": sections_of(c, before, self.mission.fixed, at),
        }

    def _run_json(self, trace: Trace) -> dict[str, Any]:
        """Return a run in lanes; steps of a live run have their seconds since its first one."""
        told = run_json(trace, self._causes(trace))
        times = self._recorded.times if self._origin and self._recorded is not None else ()
        for step, time_ in zip(told["steps"][: self._first], times, strict=False):
            seconds = max(0.0, time_ - times[0])
            step |= {"date": f"{seconds:.1f} s", "at": round(1000 * seconds)}
        return told

    def _visit(self, trace: Trace, at: int) -> Visit:
        c, raced = trace.configurations[at], trace.race is not None and trace.race.acted == at
        return Visit(c, expand(c), self._run.choices(at), raced)

    def _causes(self, trace: Trace) -> tuple[Cause, ...]:
        """Return the causes of what is wrong at the end of a run; nothing if all is well there."""
        end = self._visit(trace, len(trace))
        for asked in self.mission.properties:
            for each in wrong_here(asked, end):
                violation = Violation(each.kind, each.message, trace, each.details, each.subject)
                return causes_of(trace, violation, formulas_of(asked))
        return causes_of(trace)

    def _choice_json(self, rank: int, c: Configuration, choice: Choice) -> dict[str, Any]:
        label, target = choice.transition.label, choice.transition.target
        told = {
            "step": rank,
            "agent": label.agent,
            "words": step_words(c, label, target),
            "label": str(label),
        }
        timing = self.initial.setting.timing
        if choice.earliest is None or timing is None:
            return told
        latest = None if choice.latest is None else clock_text(choice.latest * timing.tick)
        first = clock_text(choice.earliest * timing.tick)
        return told | {
            "from": first,
            "to": latest,
            "ticks": [choice.earliest, choice.latest],
            "tick": timing.tick,
        }

    # --- other runs -------------------------------------------------------------------------------------------

    def _random(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Lengthen a run by some steps at random."""
        run, count, seed = self._go(request.get("run")), request.get("count", 1), request.get("seed", 0)
        if not isinstance(count, int) or not isinstance(seed, int) or not 0 < count <= MOST_STEPS:
            raise ExplorationError(f"a walk has 1 to {MOST_STEPS:,} steps")
        chance, end = random.Random(seed), time.monotonic() + SECONDS
        for _ in range(min(count, MOST_STEPS - len(run.taken))):
            choices = run.choices()
            if not run.take_by_chance(chance) or time.monotonic() > end:
                break
            self._tokens.append(self._token(choices))
        return self._look({"run": self._address})

    def _token(self, choices: tuple[Choice, ...]) -> str:
        """Return the part of the address for the step just taken."""
        step, dates = self._run.taken[-1], self._run.dates
        rank = next(
            rank
            for rank, each in enumerate(choices)
            if (each.transition.label, each.transition.target) == (step.label, step.target)
        )
        return f"{rank}@{dates[-1]}" if dates and dates[-1] != choices[rank].earliest else str(rank)

    def _load(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Show the run of a file: as choices of the mission where it consists of such, else as it was recorded."""
        if "content" in request:
            found = run_in_bytes(request["content"], self.mission)
        elif request.get("given") and self._given is not None:
            found = run_in_file(self._given, self.mission)
        else:
            found = run_in_trace(request.get("trace"), self.mission)
        if found.is_made_of_choices(self.mission.setting):
            return self._follow(found.trace)
        self._recorded, self._origin = found, ""
        self._begin("")
        return self._look({"run": f"~{len(found.trace)}"})

    def _follow(self, trace: Trace) -> dict[str, Any]:
        run = self._go("")
        for number, step in enumerate(trace.steps):
            found = [
                (rank, each)
                for rank, each in enumerate(run.choices())
                if str(each.transition.label) == str(step.label)
            ]
            same = [(rank, each) for rank, each in found if _is_alike(each.transition.target, step.target)]
            rank, choice = (same or found)[0]
            date = trace.dates[number] if trace.dates else choice.earliest
            self._take(str(rank) if date == choice.earliest else f"{rank}@{date}")
        return self._look({"run": self._address})

    def _goto(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Show a shortest run to where a proposition is true: from here, or with times from the start."""
        goal = self._goal(request.get("where"))
        run = self._go(request.get("run"))
        if not run.is_timed:
            found = _shortest(run.at, goal)
            return self._look({"run": joined(self._address, *found)})
        report = check(watching(self.mission.initial, [goal]), [goal], Limits(MOST_TRIED, SECONDS))
        (verdict,) = report.verdicts
        if verdict.witness is None:
            reason = (
                "no run"
                if report.complete
                else f"no run among {counted(report.configurations, 'configuration')}"
            )
            raise ExplorationError(f"{reason} comes to where that is true")
        return self._follow(verdict.witness)

    def _goal(self, where: object) -> Property:
        """Return the property that some configuration makes a proposition true; raises MissionError."""
        if not isinstance(where, str) or not 0 < len(where) <= 2_000:
            raise ExplorationError("give a proposition, such as 'uav0 in gate0'")
        asked = f'check {{ reachable "{GOAL}": {where}\n}}'
        tree = parse(Source(GOAL, asked)).declarations
        match tree:
            case (s.Check(properties=(s.Reachable(),)),):
                pass
            case _:
                raise ExplorationError("give one proposition, such as 'uav0 in gate0'")
        source = Source(self.mission.source.name, f"{self.mission.source.text}\n{asked}\n")
        variation = Variation(self.initial.setting.scheduler, self.initial.setting.control)
        mission = elaborate(parse(source), source, self._directory, variation)
        return next(each for each in mission.properties if each.name == GOAL)

    # --- traces and graphs ------------------------------------------------------------------------------------

    def _save(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Return the run as a trace, which `bigactors replay` takes."""
        trace = _told(self._go(request.get("run")).trace)
        scheduler, control = trace.initial.setting.scheduler, trace.initial.setting.control
        digest = digest_of(self.mission.under(scheduler, control))
        variation = {"scheduler": scheduler.value, "control": control.value}
        return {"trace": to_json(trace, self.mission.source.name, digest) | variation}

    def _graph(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Return the graph of all configurations if they are few, else of those around the run's end.

        With times, each step is taken as early as it may be.
        """
        run = self._go(request.get("run"))
        whole, passed, timed = self._address, list(run.trace.configurations), run.is_timed
        graph = ConfigurationGraph(whole=False)
        if not self._origin:
            graph = reached({self.initial: ("", 0)}, self._choices_at, MOST_NODES)
        if not graph.whole:
            starts = {c: (self._address_at(at), at) for at, c in reversed(list(enumerate(passed)))}
            near = list(starts)[: MOST_AROUND // 2]
            graph = reached({c: starts[c] for c in near}, self._choices_at, MOST_AROUND)
            graph.whole = False
            graph.follow(run.trace)
        answer = graph_json(graph, passed, self._is_bad)
        self._go(whole)
        return answer | {"run": whole, "timed": timed}

    def _choices_at(self, address: str, c: Configuration) -> tuple[Choice, ...]:
        if not self._run.is_timed:
            return tuple(map(Choice, expand(c).transitions))
        return self._go(address).choices()

    def _is_bad(self, c: Configuration) -> bool:
        expansion = expand(c)
        here = Visit(c, expansion, tuple(map(Choice, expansion.transitions)), raced=False)
        return any(each["bad"] for each in values_here(self.mission.properties, here))


def _told(trace: Trace) -> Trace:
    """Return the run with the three steps of the stale-observation race that it ends in, if it does."""
    race = stale_steps(trace.initial, trace.steps)
    return trace if race is None else replace(trace, race=race)


def _is_alike(one: Configuration, other: Configuration) -> bool:
    """Whether two configurations are equal apart from the monitor's memory."""
    return all(cell[0] == MONITOR for cell in one.state.changed(other.state))


def _shortest(start: Configuration, goal: Property) -> list[str]:
    """Return the numbers of the steps of a shortest run to where a proposition is true."""
    known: dict[Configuration, tuple[Configuration, int] | None] = {start: None}
    waiting, end = [start], time.monotonic() + SECONDS
    for c in waiting:
        if holds(goal.formula, c):
            steps = []
            while (by := known[c]) is not None:
                steps.append(str(by[1]))
                c = by[0]  # noqa: PLW2901 - the search ends here
            return steps[::-1]
        if len(known) > MOST_TRIED or time.monotonic() > end:
            raise ExplorationError(f"that is true in none of the next {len(known):,} configurations")
        for rank, transition in enumerate(expand(c).transitions):
            if transition.target not in known:
                known[transition.target] = (c, rank)
                waiting.append(transition.target)
    raise ExplorationError("no run from here comes to where that is true")
