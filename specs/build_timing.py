"""Build the syntax tree of the `timing` section: one method for each rule of the grammar, with its name."""

# ruff: noqa: D102 - each method builds the grammar rule of its name, and mission.lark shows that rule

from __future__ import annotations

from lark import Token, Transformer

from specs import syntax as s
from specs.building import Children, RuleResult, agent, cover, decimal, name, names, nodes, once, optional


class BuildTiming(Transformer[Token, s.Mission]):
    """Build the bounds on durations, speeds and times."""

    def timing(self, c: Children) -> s.Timing:
        return s.Timing(nodes(c), span=cover(c))

    def tick(self, c: Children) -> s.Tick:
        return s.Tick(c[1], span=cover(c))

    def motion(self, c: Children) -> s.Motion:
        said = once([each for each in c if isinstance(each, RuleResult)], c[0])
        climbs, circles = (said[word].value if word in said else None for word in ("climbs", "circles"))
        return s.Motion(name(c[0]), c[3], climbs, circles, span=cover(c))

    def motion_clause(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), c[-1], str(c[0]))

    def speeds(self, c: Children) -> s.Speeds:
        return s.Speeds(c[0], c[2] or c[0], span=cover(c))

    def speed(self, c: Children) -> s.Speed:
        return s.Speed(decimal(None, c[0]), str(c[1]), span=cover(c))

    def lasting(self, c: Children) -> s.Lasting:
        return s.Lasting(name(c[0]), c[2], names(c[5:]), c[-1], span=cover(c))

    def within(self, c: Children) -> s.Lapse:
        return s.Lapse(None, c[1], span=cover(c))

    def take(self, c: Children) -> s.Lapse:
        if c[1] == "at":
            return s.Lapse(c[3], None, span=cover(c))
        return s.Lapse(c[1], c[3] or c[1], span=cover(c))

    def reaction_time(self, c: Children) -> s.ReactionTime:
        return s.ReactionTime(c[-1], span=cover(c))

    def sensing_time(self, c: Children) -> s.SensingTime:
        return s.SensingTime(c[-1], span=cover(c))

    def message_time(self, c: Children) -> s.MessageTime:
        return s.MessageTime(name(c[2]) if c[1] == "over" else None, c[-1], span=cover(c))

    def step_time(self, c: Children) -> s.StepTime:
        return s.StepTime(name(c[0]), c[-1], span=cover(c))

    def drift_time(self, c: Children) -> s.DriftTime:
        return s.DriftTime(name(c[0]), c[2].value, span=cover(c))

    def drop_time(self, c: Children) -> s.DropTime:
        return s.DropTime(name(c[0]), *_every_and_returning(c), span=cover(c))

    def leave_time(self, c: Children) -> s.LeaveTime:
        return s.LeaveTime(name(c[0]), name(c[2]), *_every_and_returning(c), span=cover(c))

    def every(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), c[-1], "every")

    def returning(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), c[-1], "returning")

    def presence_time(self, c: Children) -> s.PresenceTime:
        return s.PresenceTime(name(c[0]), str(c[1]), *_between(c[2:]), span=cover(c))

    def say_time(self, c: Children) -> s.SayTime:
        return s.SayTime(c[2], optional(c[4], agent), *_between(c[5:]), span=cover(c))


def _every_and_returning(c: Children) -> tuple[s.Duration | None, s.Duration | None]:
    said = {part.word: part.value for part in c if isinstance(part, RuleResult)}
    return said.get("every"), said.get("returning")


def _between(c: Children) -> tuple[s.Duration | None, s.Duration | None]:
    """Return the duration behind `after`, and the one behind the closing word."""
    return (c[1], c[4]) if c[0] == "after" else (None, c[1])
