"""Elaboration of a mission: from a syntax tree to an elaborated mission, or to all its mistakes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import islice
from pathlib import Path
from typing import Final

from physical import open_file
from semantics.environment import Clause, Placing, Says
from semantics.live_policy import LivePolicy
from semantics.properties.property import Property, asks_of_regions, watched
from semantics.regions.suspicions import SuspectedWay, Suspicion
from semantics.state.brief import cut
from semantics.state.configuration import Configuration
from semantics.state.initial import initial
from semantics.state.physical_model import Carried
from semantics.state.setting import Control, Scheduler, Setting
from semantics.state.signature import Name
from specs import syntax as s
from specs.codes import Code
from specs.diagnostics import Diagnostic, MissionError, Source
from specs.elaboration.beliefs import check_forest, elaborate_beliefs, settled
from specs.elaboration.bodies import declare_behaviours, elaborate_bodies
from specs.elaboration.check_section import elaborate_checks, elaborate_control, elaborate_scheduler
from specs.elaboration.distances import RegionContext
from specs.elaboration.environment import appearing_channels, elaborate_environment
from specs.elaboration.independent_diagnostics import independent
from specs.elaboration.initial_actors import first_actors
from specs.elaboration.live import elaborate_live
from specs.elaboration.meeting_points import MOST_PAIRS, suspected_meeting_points
from specs.elaboration.misses import elaborate_misses
from specs.elaboration.mission_mistakes import Findings
from specs.elaboration.mobility import check_nesting, elaborate_mobility, fixed_entities, warn_of_outliers
from specs.elaboration.names import Names
from specs.elaboration.overflights import suspected_overflights
from specs.elaboration.realisability import Ground, check_controls
from specs.elaboration.rules import elaborate_rules
from specs.elaboration.signature import elaborate_signature
from specs.elaboration.strays import elaborate_strays
from specs.elaboration.suspicion_warnings import SuspicionWarning
from specs.elaboration.timing import TickConversion, elaborate_timing
from specs.elaboration.type_constraints import check_types
from specs.elaboration.value_types import Inference
from specs.elaboration.variation import AS_WRITTEN, Variation
from specs.elaboration.world import InitialWorld, elaborate_world
from specs.elaboration.world_files import Library
from specs.formatter import write_mission
from specs.missions import shipped_missions
from specs.parser import read
from specs.preprocessing import MAX_BYTES, decode
from specs.recovery import Recovered


@dataclass(frozen=True, eq=False)
class ElaboratedMission:
    """A mission ready to explore and check.

    Attributes:
        name: The mission's name: its header's, else the file's stem.
        source: Its text.
        setting: Its constants.
        properties: Its properties, in written order.
        notes: Notes on the world that accompany every verdict.
        fixed: Entities whose place neither agents nor the environment can ever change.
        spans: The declaration of each name, by sort (entity, kind, channel, agent, rule, behaviour) and name.
        precautions: The fallbacks and time limits of a live run.
        warned: Probable mistakes that are allowed, whatever an exploration finds.
        suspected: The warnings that an exploration may refute.
        begin: The function from a setting to the initial configuration, in the world already read.
        empty: Whether its text declares nothing.
    """

    name: str
    source: Source
    setting: Setting
    properties: tuple[Property, ...]
    notes: tuple[str, ...]
    fixed: frozenset[Name]
    spans: Mapping[tuple[str, str], s.Span]
    precautions: LivePolicy
    warned: tuple[Diagnostic, ...]
    suspected: tuple[SuspicionWarning, ...]
    begin: Callable[[Setting], Configuration] = field(repr=False)
    empty: bool

    def __repr__(self) -> str:
        return (
            f"<ElaboratedMission {cut(self.name)} agents={len(self.initial.alpha.names())} "
            f"entities={len(self.setting.kinds)} properties={len(self.properties)}>"
        )

    @cached_property
    def initial(self) -> Configuration:
        """The initial configuration, computed on first use; it has no mistakes left to report."""
        return self.begin(self.setting)

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Probable mistakes that are allowed, by position, as the text alone suggests them."""
        return self.warnings_after({})

    def warnings_after(self, decided: Mapping[Suspicion, SuspectedWay | None]) -> tuple[Diagnostic, ...]:
        """Return the warnings that stand after an exploration decided some suspicions."""
        standing = (each.after(decided) for each in self.suspected)
        found = (*self.warned, *(each for each in standing if each is not None))
        return MissionError(self.source, dict.fromkeys(found)).diagnostics

    @property
    def suspicions(self) -> tuple[Suspicion, ...]:
        """The suspicions about ways for an exploration to decide."""
        return tuple(dict.fromkeys(every for each in self.suspected for every in each.suspicions))

    def under(self, scheduler: Scheduler, control: Control) -> ElaboratedMission:
        """Return the mission under another scheduler and kind of control; no file is read again."""
        setting = self.setting.with_(scheduler=scheduler, control=control)
        return replace(self, setting=setting)

    def line(self, sort: str, name: str) -> int:
        """Return the line of a declaration, from 1; 0 if there is none."""
        span = self.spans.get((sort, name))
        return 0 if span is None else self.source.line(span.start)


def elaborate(
    mission: s.Mission, source: Source, directory: Path, variation: Variation = AS_WRITTEN
) -> ElaboratedMission:
    """Return the meaning of a mission; raises MissionError with all mistakes found, by position.

    Files of the world are sought in `directory`, unless the variation replaces them.
    """
    names = Names(Findings(source))
    elaborate_signature(mission, names)
    world = elaborate_world(mission, names, Library(directory, variation.sources))
    appearing_channels(mission, names)
    actors = first_actors(mission, names)
    declare_behaviours(mission, names, actors)
    mobility = elaborate_mobility(mission, names, world)
    check_nesting(names, world, mobility)
    mistakes = len(names.findings)
    clauses, clause_spans, arriving = elaborate_environment(mission, names, world, mobility)
    whole = len(names.findings) == mistakes
    warn_of_outliers(names, world, zip(clauses, clause_spans, strict=True))
    beliefs = elaborate_beliefs(mission, names)
    bodies, program = elaborate_bodies(mission, names, actors, elaborate_rules(mission, names))
    agents = {}
    for actor in actors:
        names.entity(actor.host)
        agents[actor.name] = (actor.host.text, bodies.agents[actor.name].block)
    fixed = fixed_entities(names, mobility)
    check_controls(bodies, Ground(names, world, mobility, fixed))
    scheduler, control = elaborate_scheduler(mission, names), elaborate_control(mission, names)
    scheduler, control = variation.scheduler or scheduler, variation.control or control
    timing = elaborate_timing(mission, names, world, clauses, control, whole=whole)
    strays = elaborate_strays(mission, names, timing)
    missable = elaborate_misses(mission, names)
    said = tuple(clause.message for clause in clauses if isinstance(clause, Says))
    inference = Inference(program, frozenset(names.kinds), frozenset(names.agents), said)
    types = check_types(names.demands, inference, names.findings)
    ticks = None if timing is None else TickConversion(timing.tick, names.findings)
    places = frozenset(_with_an_inside(world, clauses))
    properties = elaborate_checks(mission, names, bodies, types, ticks, RegionContext(control, places))
    precautions = elaborate_live(mission, names)
    _stop(names.findings)
    setting = Setting(
        names.signature,
        dict(names.kinds),
        program.watching(watched(properties)),
        clauses,
        scheduler,
        control,
        arriving,
        clause_lines=tuple(source.line(span.start) for span in clause_spans),
        timing=timing,
        strays=strays,
        missable=missable,
    )
    there = {name: world.channels[name] for name in world.placements}
    begin = partial(initial, placements=world.placements, channels=there, agents=agents)
    if beliefs.parents or beliefs.links:
        begin = partial(begin, beliefs=settled(beliefs, begin(setting)))
        check_forest(mission, begin(setting), names)
    _stop(names.findings)
    suspected = [*suspected_overflights(setting, partial(begin, setting), properties, names.findings)]
    if asks_of_regions(properties):
        from semantics.regions.possible_motions import region_facts  # noqa: PLC0415 - few missions ask for regions

        facts = region_facts(begin(setting))
        setting = setting.with_(regions=facts)
        suspected += islice(suspected_meeting_points(setting, facts, properties, names), MOST_PAIRS)
    called = mission.name.text if mission.name is not None else Path(source.name).stem
    return ElaboratedMission(
        called,
        source,
        setting,
        properties,
        tuple(world.notes),
        fixed,
        dict(names.spans),
        precautions,
        names.findings.warnings,
        tuple(suspected),
        begin,
        not mission.declarations,
    )


@dataclass(frozen=True, eq=False, slots=True)
class Diagnosis:
    """The result of elaborating a text: its meaning, or its mistakes.

    Attributes:
        mistakes: Its mistakes, by position.
        warnings: Probable mistakes that are allowed, by position.
        elaborated: The mission; None if there is a mistake.
    """

    mistakes: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...]
    elaborated: ElaboratedMission | None


def diagnose(
    found: Recovered, source: Source, directory: Path, variation: Variation = AS_WRITTEN
) -> Diagnosis:
    """Return the meaning of a parsed text, or all its mistakes: those of syntax, and those independent of them."""
    try:
        elaborated = elaborate(found.mission, source, directory, variation)
        meant = Diagnosis((), elaborated.warnings, elaborated)
    except MissionError as error:
        meant = Diagnosis(error.diagnostics, error.warnings, None)
    if not found.mistakes:
        return meant
    both = MissionError(source, (*found.mistakes, *independent(meant.mistakes, found.unread, source)))
    return Diagnosis(both.diagnostics, tuple(independent(meant.warnings, found.unread, source)), None)


def _with_an_inside(world: InitialWorld, clauses: Iterable[Clause]) -> Iterator[Name]:
    """Yield the entities that have an area, at first or later."""
    shapes = [(name, world.shape(name)) for name in world.placements]
    shapes += [
        (each.entity, at.shape if isinstance(at, Carried) else at)
        for each in clauses
        if isinstance(each, Placing)
        for at in each.placements
    ]
    yield from (name for name, at in shapes if at is not None and not at.geometry.is_point)


def require_bigactor(mission: ElaboratedMission) -> None:
    """Refuse a mission without a bigActor, since an empty check is no pass; raises MissionError."""
    if mission.initial.alpha.names():
        return
    if mission.empty:
        found = Diagnostic(Code.EMPTY_MISSION, _START, "the file declares nothing", "is it the right file?")
    else:
        hint = "add one: BigActor a hosted_at HOST with_behavior { ... }"
        found = Diagnostic(
            Code.NO_BIGACTOR, _START, "there is no bigActor in it: nothing would be checked", hint
        )
    raise MissionError(mission.source, [found])


def _stop(findings: Findings) -> None:
    if findings:
        raise findings.error()


def load_mission(mission: str | Path, variation: Variation = AS_WRITTEN) -> ElaboratedMission:
    """Return the elaborated mission of a file, or of a shipped mission by its name (`load_mission("oil_spill")`).

    Raises:
        MissionError: There is no such mission, it cannot be read, or it has mistakes; lists them all.
    """
    path = find_mission(mission) if isinstance(mission, str) else Path(mission)
    try:
        with open_file(path) as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise _unreadable(str(path), f"the file cannot be read: {reason}", "check its path") from error
    return _elaborated(decode(str(path), data), path.parent, variation)


def read_mission(
    text: str | s.Mission,
    directory: str | Path = ".",
    *,
    name: str = "<text>",
    variation: Variation = AS_WRITTEN,
) -> ElaboratedMission:
    """Return the elaborated mission of a text or of a syntax tree, which is written as a text.

    Files named with `from` are sought in a directory.

    Raises:
        MissionError: The text has mistakes; lists them all, with positions in `name`.
        ValueError: The tree cannot be written: one of its names or numbers has another meaning as text.
    """
    if isinstance(text, s.Mission):
        text = _written(text)
    if not isinstance(text, str):
        raise TypeError(
            f"read_mission takes a text or a Mission, and load_mission a file: {text!r} is neither"
        )
    return _elaborated(decode(name, text.encode("utf-8", "surrogatepass")), Path(directory), variation)


def _written(tree: s.Mission) -> str:
    text = write_mission(tree)
    if (found := read(Source("tree", text))).mistakes or found.mission != tree:
        raise ValueError(f"the tree is another mission than its text, which is:\n{text}")
    return text


def _elaborated(source: Source, directory: Path, variation: Variation) -> ElaboratedMission:
    found = read(source)
    if not found.mistakes:
        _check_sources(found.mission, source, variation)
    diagnosis = diagnose(found, source, directory, variation)
    if diagnosis.elaborated is None:
        raise MissionError(source, diagnosis.mistakes)
    return diagnosis.elaborated


def find_mission(word: str) -> Path:
    """Return the path of a mission: a file, or a shipped mission by its name; raises MissionError."""
    shipped = shipped_missions()
    try:
        if not word:
            raise _unreadable(word, "the path of the mission is empty", "")
        if word in shipped and not Path(word).is_file():
            return shipped[word]
        if Path(word).exists() and not Path(word).is_dir():
            return Path(word)
        reason = "this is a folder, not a mission" if Path(word).is_dir() else "there is no such file"
    except (OSError, ValueError):
        reason = "this is no path of a file"
    if "\n" in word or "{" in word:
        raise _unreadable(
            word, "this is the text of a mission, not its path", "write it to a file, and give its path"
        )
    near = Findings(Source(word, "")).suggest(word, shipped) if "/" not in word else ""
    if reason == "there is no such file" and Path(f"{word}.mission").is_file():
        near = f"did you mean '{word}.mission'?"
    otherwise = "give the path of a mission, or the name of one that ships: " + ", ".join(shipped)
    raise _unreadable(word, reason, near or otherwise)


def _unreadable(name: str, message: str, hint: str) -> MissionError:
    return MissionError(Source(cut(name), ""), [Diagnostic(Code.UNREADABLE_FILE, _START, message, hint)])


def files_named(mission: s.Mission) -> tuple[str, ...]:
    """Return the files of a mission's world, by the names that it gives."""
    entries = (entry for world in mission.each(s.World) for entry in world.entries)
    return tuple(entry.file.value for entry in entries if isinstance(entry, s.FromSource))


def _check_sources(mission: s.Mission, source: Source, variation: Variation) -> None:
    """Refuse a replacement for a file that the mission does not name."""
    named = set(files_named(mission))
    findings = Findings(source)
    for name in sorted(set(variation.sources) - named):
        known = ", ".join(sorted(named)) or "none"
        findings.add(
            Code.UNREADABLE_FILE, _START, f"the mission reads no file '{name}'", f"it reads: {known}"
        )
    _stop(findings)


_START: Final = s.Span(0, 0)
