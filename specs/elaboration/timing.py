"""The timing phase: the durations of all steps, in whole ticks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import gcd
from typing import Any, Final, TypeVar

from semantics.behaviours.commands import COMMANDS
from semantics.behaviours.durations import UNITS, duration_text
from semantics.behaviours.values import show
from semantics.environment import Appears, Clause, Drifts, Drops, Leaves, Says, Vanishes
from semantics.state.setting import Control
from semantics.timing.intervals import ANY_TIME, Interval
from semantics.timing.timing import (
    ONE_HOST,
    ClauseTimes,
    Endurance,
    Every,
    Motion,
    Sayable,
    Timing,
    Window,
)
from specs import syntax as s
from specs.codes import Code
from specs.construct_text import write
from specs.elaboration.constant_values import elaborate_constant
from specs.elaboration.mission_mistakes import Findings, a
from specs.elaboration.names import Names
from specs.elaboration.vehicles import named_vehicles
from specs.elaboration.world import InitialWorld
from specs.mission_layout import pieces
from specs.timing_mistakes import BEGINNING

LONGEST: Final = 7 * 24 * 3600
"""The longest duration in seconds."""

SECOND: Final = 1000
FASTEST: Final = 12_000.0
"""The largest speed of an entity in metres per second; anything faster leaves the earth."""

OTHER_STEPS: Final = ("migrate", "spawn")

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class TickConversion:
    """Converts durations to ticks of `tick` milliseconds; reports those that are no whole number of ticks."""

    tick: int
    findings: Findings

    def count(self, written: s.Duration) -> int:
        """Return a duration in ticks."""
        milliseconds = milliseconds_of(written)
        if milliseconds > LONGEST * SECOND:
            hint = f"give it at most {LONGEST // UNITS['h']:g} h"
            self.findings.add(Code.BAD_DURATION, written, f"{write(written)} is too long", hint)
        elif milliseconds % self.tick:
            message = f"{write(written)} is no whole number of ticks of {duration_text(self.tick / SECOND)}"
            common = gcd(self.tick, int(milliseconds)) if milliseconds.denominator == 1 else 1
            hint = f"round it, or give timing a shorter tick: tick {_tick_text(common)}"
            self.findings.add(Code.BAD_DURATION, written, message, hint)
        return int(milliseconds // self.tick)

    def maybe(self, written: s.Duration | None) -> int | None:
        """Return a duration in ticks, None if it is not written."""
        return None if written is None else self.count(written)

    def interval(self, lapse: s.Lapse) -> Interval:
        """Return a duration interval in ticks; reports an empty one."""
        return Interval(*self.ordered(lapse, lapse.least, lapse.most))

    def ordered(
        self, where: s.Node, least: s.Duration | None, most: s.Duration | None
    ) -> tuple[int, int | None]:
        """Return two durations in ticks; reports the pair if the second is shorter."""
        lo, hi = self.maybe(least) or 0, self.maybe(most)
        if least is not None and most is not None and hi is not None and hi < lo:
            _report_order(self.findings, where, write(least), write(most))
            return 0, None
        return lo, hi


def milliseconds_of(written: s.Duration) -> Fraction:
    """Return the exact milliseconds of a written duration.

    >>> milliseconds_of(s.Duration(1.001, "s"))
    Fraction(1001, 1)
    """
    return Fraction(repr(written.value)) * round(UNITS[written.unit] * SECOND)


def _tick_text(milliseconds: int) -> str:
    return f"{milliseconds} ms" if milliseconds % SECOND else duration_text(milliseconds / SECOND)


def _report_order(findings: Findings, where: s.Node, first: str, second: str) -> None:
    findings.add(Code.EMPTY_INTERVAL, where, f"{first} to {second} ends before it begins", "exchange the two")


@dataclass(slots=True)
class _Said:
    """The state of the phase.

    Attributes:
        clauses: The environment's clauses that have no mistake.
        whole: Whether no clause has a mistake.
        times: The times of each clause, by its number.
        seen: The subjects of bounds so far, to find repetitions.
        motions: The motion of each vehicle; bounds of kinds come first, and those of single vehicles replace them.
    """

    names: Names
    world: InitialWorld
    ticks: TickConversion
    clauses: tuple[Clause, ...]
    whole: bool
    times: dict[int, ClauseTimes] = field(default_factory=dict)
    seen: set[tuple[object, ...]] = field(default_factory=set)
    motions: dict[str, Motion] = field(default_factory=dict)
    endurances: dict[str, Endurance] = field(default_factory=dict)
    react: Interval = ANY_TIME
    sense: Interval = ANY_TIME
    messages: dict[str, Interval] = field(default_factory=dict)
    commands: dict[str, Interval] = field(default_factory=dict)

    @property
    def findings(self) -> Findings:
        return self.names.findings

    def is_new(self, node: s.Node, *key: object) -> bool:
        """Whether this is the first bound of its subject; reports a repetition."""
        if key not in self.seen:
            self.seen.add(key)
            return True
        message = f"this has two bounds: {' '.join(pieces(node))}"
        self.findings.add(Code.REPEATED_SETTING, node, message, "leave one of the two out")
        return False


def elaborate_timing(
    mission: s.Mission,
    names: Names,
    world: InitialWorld,
    clauses: tuple[Clause, ...],
    control: Control,
    *,
    whole: bool,
) -> Timing | None:
    """Return the time bounds of a mission; None if it has no `timing` section.

    `clauses` is its environment; `whole` is false if a clause of it has a mistake.
    """
    sections = mission.each(s.Timing)
    if not sections:
        return None
    if control is not Control.TIMED:
        message = "a mission with 'timing' has control that takes time"
        says_timed = any(each.name == Control.TIMED.value for each in mission.each(s.ControlMode))
        hint = "the mission sets it: leave --control atomic out" if says_timed else "write: control timed"
        names.findings.add(Code.NOT_TIMED, _head(sections[0]), message, hint)
    bounds = [each for section in sections for each in section.bounds]
    said = _Said(names, world, TickConversion(_tick(bounds, names.findings), names.findings), clauses, whole)
    for bound in sorted(
        bounds, key=lambda each: _is_of_one(said, each)
    ):  # a bound of one vehicle replaces that of its kind
        _ELABORATE[type(bound)](said, bound)
    _warn_of_short_endurances(said, [each for each in bounds if isinstance(each, s.Lasting)])
    source = names.findings.source
    return Timing(
        said.ticks.tick,
        _sorted(said.motions),
        _sorted(said.endurances),
        said.react,
        said.sense,
        _sorted(said.messages),
        _sorted(said.commands),
        tuple(said.times.get(number, ClauseTimes()) for number in range(len(clauses))) if said.times else (),
        tuple(
            (" ".join(pieces(each)), source.line(each.span.start))
            for each in bounds
            if not isinstance(each, s.Tick)
        ),
    )


def _sorted(by_name: Mapping[str, T]) -> tuple[tuple[str, T], ...]:
    return tuple(sorted(by_name.items(), key=lambda item: item[0]))


def _head(section: s.Timing) -> s.Span:
    return s.Span(section.span.start, section.span.start + len("timing"))


def _is_of_one(said: _Said, bound: s.Bound) -> bool:
    return isinstance(bound, s.Motion | s.Lasting) and bound.name.text in said.names.kinds


def _tick(bounds: Iterable[s.Bound], findings: Findings) -> int:
    written = [bound for bound in bounds if isinstance(bound, s.Tick)]
    for again in written[1:]:
        findings.add(Code.REPEATED_SETTING, again, "'tick' is written twice", "leave one of the two out")
    if not written:
        return SECOND
    milliseconds = milliseconds_of(written[0].duration)
    if milliseconds.denominator != 1 or not 0 < milliseconds <= LONGEST * SECOND:
        message = f"a tick of {write(written[0].duration)}"
        findings.add(
            Code.BAD_DURATION, written[0], message, "a tick is a whole number of milliseconds, 1 or more"
        )
        return SECOND
    return int(milliseconds)


# --- vehicles


def _motion(said: _Said, node: s.Motion) -> None:
    vehicles = named_vehicles(said.names, node.name, "flies")
    speed = _speeds(said, node.speeds)
    climb = None if node.climbs is None else _speeds(said, node.climbs)
    circle = 0.0 if node.circles is None else 2 * node.circles.metres
    if said.is_new(node, "motion", node.name.text):
        said.motions |= dict.fromkeys(vehicles, Motion(speed, climb, circle))


def _speeds(said: _Said, node: s.Speeds) -> tuple[float, float]:
    least, greatest = node.least.metres_per_second, node.greatest.metres_per_second
    for each in (node.least, node.greatest):
        if not 0 < each.metres_per_second <= FASTEST:
            hint = f"speeds are above 0 m/s, and at most {FASTEST:g} m/s"
            said.findings.add(Code.BAD_DURATION, each, f"a speed of {write(each)}", hint)
    if greatest < least:
        _report_order(said.findings, node, write(node.least), write(node.greatest))
    return least, greatest


def _lasting(said: _Said, node: s.Lasting) -> None:
    vehicles = named_vehicles(said.names, node.name, "lasts")
    lasts, after = said.ticks.count(node.lasts), said.ticks.maybe(node.after) or 0
    for place in node.places:
        around = said.names.entity(place)
        kinds = {said.names.kinds[each] for each in vehicles}
        if around is not None and kinds and not kinds & said.names.signature.within(around, directly=False):
            message = f"it is never there: {a(around)} cannot contain {a(min(kinds))}"
            hint = f"name a place of another kind, or declare it: kind {around} contains {min(kinds)}"
            said.findings.warn(Code.NEVER_INSIDE, place, message, hint)
    places = tuple(sorted({place.text for place in node.places}))
    if said.is_new(node, "lasts", node.name.text):
        said.endurances |= dict.fromkeys(vehicles, Endurance(lasts, places, after))


def _warn_of_short_endurances(said: _Said, written: list[s.Lasting]) -> None:
    """Warn of vehicles whose endurance is too short for any flight from a restoring place."""
    for node in written:
        vehicle = node.name.text
        found = said.endurances.get(vehicle)
        needed = _shortest_flight(said, vehicle, found.places) if found is not None else None
        if found is not None and needed is not None and found.lasts * said.ticks.tick < needed * SECOND:
            message = f"'{vehicle}' lasts {write(node.lasts)}, and every flight from its place of restoration is longer"
            hint = f"the nearest other place is {duration_text(round(needed))} away at its greatest speed"
            said.findings.warn(Code.BOUNDS_NOTHING, node, message, hint)


def _shortest_flight(said: _Said, vehicle: str, places: tuple[str, ...]) -> float | None:
    """Return the seconds of the shortest flight from a restoring place to another place for the vehicle."""
    from physical.extents import extent, least_distance  # noqa: PLC0415 - geometry takes its time to load

    kind, motion = said.names.kinds[vehicle], said.motions.get(vehicle)
    others = {
        name for name, of in said.names.kinds.items() if said.names.signature[of].may_contain(kind)
    }.difference(places)
    begins, ends = list(_geometries(said, places)), list(_geometries(said, others))
    if motion is None or not begins or not ends:
        return None
    return (
        min(least_distance(extent(begin), extent(end)) for begin in begins for end in ends) / motion.speed[1]
    )


def _geometries(said: _Said, names: Iterable[str]) -> Iterator[Any]:
    placed = (said.world.position(name) for name in sorted(names))
    return (each.geometry for each in placed if each is not None)


# --- agents


def _reaction_time(said: _Said, node: s.ReactionTime) -> None:
    if said.is_new(node, "agents"):
        said.react = said.ticks.interval(node.lapse)


def _sensing_time(said: _Said, node: s.SensingTime) -> None:
    if said.is_new(node, "sense"):
        said.sense = said.ticks.interval(node.lapse)


def _message_time(said: _Said, node: s.MessageTime) -> None:
    channel = ONE_HOST if node.channel is None else node.channel.text
    if node.channel is not None:
        said.names.channel(node.channel)
    if said.is_new(node, "messages", channel):
        said.messages[channel] = said.ticks.interval(node.lapse)


def _step_time(said: _Said, node: s.StepTime) -> None:
    word = node.word.text
    command = COMMANDS.get(word)
    if command is not None and command.travels:
        message = f"the duration of {word} follows from the way"
        hint = "give its speed: UAV flies at 18 m/s to 25 m/s; and until it begins: agents react within 1 s"
        said.findings.add(Code.TAKES_ITS_WAY, node, message, hint)
    elif command is None and word not in (*OTHER_STEPS, *said.names.rules):
        among = [
            *said.names.rules,
            *OTHER_STEPS,
            *(name for name, each in COMMANDS.items() if not each.travels),
        ]
        otherwise = _meant(said.names, word) or f"it is one of {', '.join(among)}"
        said.findings.unknown(node.word, among, sort="command or rule", otherwise=otherwise)
    if said.is_new(node, "step", word):
        said.commands[word] = said.ticks.interval(node.lapse)


def _meant(names: Names, word: str) -> str:
    """Return the correct form of a bound on a word that takes no time by itself."""
    if word in names.channels:
        return f"write messages over {word} within 5 s"
    if word in names.behaviours:
        return "the duration of a behaviour follows from its steps: agents react within 1 s, sense within 5 s"
    if word == "FLY":
        return "give its speed: UAV flies at 18 m/s to 25 m/s"
    return BEGINNING.get(word, "")


# --- the environment


def _time_clauses(
    said: _Said, node: s.Bound, fits: Callable[[Any], bool], missing: str, hint: str, times: ClauseTimes
) -> None:
    """Add the times of all matching clauses; reports if there are none."""
    found = [number for number, clause in enumerate(said.clauses) if fits(clause)]
    if not found and said.whole:
        said.findings.add(Code.NOT_IN_ENVIRONMENT, node, missing, f"write in the environment: {hint}")
    for number in found:
        before = said.times.get(number, ClauseTimes())
        said.times[number] = replace(times, step=times.step or before.step)


def _drift_time(said: _Said, node: s.DriftTime) -> None:
    name = node.entity.text
    if said.names.entity(node.entity) and said.is_new(node, "drifts", name):
        _time_clauses(
            said,
            node,
            lambda clause: isinstance(clause, Drifts) and clause.entity == name,
            f"'{name}' never drifts",
            f"{name} drifts among ...",
            ClauseTimes(Every(said.ticks.count(node.every))),
        )


def _drop_time(said: _Said, node: s.DropTime) -> None:
    channel = node.channel.text
    if said.names.channel(node.channel) and said.is_new(node, "drops", channel):
        _time_absence(
            said,
            node,
            lambda clause: isinstance(clause, Drops) and clause.channel == channel,
            f"'{channel}' never drops",
            f"{channel} drops",
        )


def _leave_time(said: _Said, node: s.LeaveTime) -> None:
    entity, channel = node.entity.text, node.channel.text
    known = said.names.entity(node.entity) is not None
    if said.names.channel(node.channel) and known and said.is_new(node, "leaves", entity, channel):
        _time_absence(
            said,
            node,
            lambda clause: (
                isinstance(clause, Leaves) and (clause.entity, clause.channel) == (entity, channel)
            ),
            f"'{entity}' never leaves '{channel}'",
            f"{entity} leaves {channel}",
        )


def _time_absence(
    said: _Said, node: s.DropTime | s.LeaveTime, fits: Callable[[Any], bool], missing: str, clause: str
) -> None:
    every = None if node.every is None else Every(said.ticks.count(node.every))
    returns = said.ticks.maybe(node.returns)
    back = f"{clause} and returns"
    _time_clauses(said, node, fits, missing, back if node.returns else clause, ClauseTimes(every, returns))
    if node.returns is not None and any(
        fits(each) and not getattr(each, "returns", True) for each in said.clauses
    ):
        message = f"{missing.partition(' ')[0]} does not return"
        said.findings.add(Code.NOT_IN_ENVIRONMENT, node, message, f"write in the environment: {back}")


def _presence_time(said: _Said, node: s.PresenceTime) -> None:
    name, sort = node.entity.text, Appears if node.verb == "appears" else Vanishes
    if said.names.entity(node.entity) and said.is_new(node, node.verb, name):
        _time_clauses(
            said,
            node,
            lambda clause: isinstance(clause, sort) and clause.entity == name,
            f"'{name}' never {node.verb}",
            f"{name} {node.verb}{' at ...' if sort is Appears else ''}",
            ClauseTimes(Window(*said.ticks.ordered(node, node.after, node.within))),
        )


def _say_time(said: _Said, node: s.SayTime) -> None:
    message = elaborate_constant(node.message, said.names)
    agent = None if node.recipient is None else said.names.agent(node.recipient)
    if node.recipient is not None and agent is None:
        return
    if said.is_new(node, "says", message, agent):
        to = "" if agent is None else f" to {agent}"
        _time_clauses(
            said,
            node,
            lambda clause: (
                isinstance(clause, Says) and clause.message == message and agent in (None, clause.agent)
            ),
            f"no clause of the environment says {show(message)}{to}",
            f"says {write(node.message)}{to}",
            ClauseTimes(Sayable(*said.ticks.ordered(node, node.after, node.until))),
        )


_ELABORATE: Final[Mapping[type[s.Node], Callable[[_Said, Any], None]]] = {
    s.Tick: lambda _said, _node: None,
    s.Motion: _motion,
    s.Lasting: _lasting,
    s.ReactionTime: _reaction_time,
    s.SensingTime: _sensing_time,
    s.MessageTime: _message_time,
    s.StepTime: _step_time,
    s.DriftTime: _drift_time,
    s.DropTime: _drop_time,
    s.LeaveTime: _leave_time,
    s.PresenceTime: _presence_time,
    s.SayTime: _say_time,
}
