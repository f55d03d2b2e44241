"""Build the syntax tree of declarations: one method for each rule of the grammar, with its name."""

# ruff: noqa: D102 - each method builds the grammar rule of its name, and mission.lark shows that rule

from __future__ import annotations

from lark import Token

from specs import syntax as s
from specs.build_timing import BuildTiming
from specs.building import (
    BuildingMistake,
    Children,
    RuleResult,
    agent,
    check_hemispheres,
    cover,
    decimal,
    degrees,
    name,
    names,
    nodes,
    once,
    optional,
    rule_body,
    span_of,
    text,
    whole,
)
from specs.codes import Code
from specs.diagnostics import Diagnostic

SCHEDULERS = ("program_order", "unordered", "fcfs")
CONTROL_MODES = ("atomic", "timed")
FALLBACKS = ("hold", "return", "continue")


class BuildWorld(BuildTiming):
    """Build declarations, beliefs, geometry, environment and checks."""

    def mission(self, c: Children) -> s.Mission:
        return s.Mission(c[0].value if c[0] else None, nodes(c[1:]), span=cover(c))

    def header(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), name(c[1]))

    # --- signature

    def signature(self, c: Children) -> s.Signature:
        return s.Signature(nodes(c), c[1] is not None and str(c[1]) == "standard", span=cover(c))

    def kind(self, c: Children) -> s.Kind:
        said = once(c[2:], c[1])
        contains, carries = (said[word].value if word in said else () for word in ("contains", "carries"))
        return s.Kind(name(c[1]), contains, carries, "driven" in said, "passive" in said, span=cover(c))

    def kind_clause(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), names(c[1:]), str(c[0]))

    # --- world

    def world(self, c: Children) -> s.World:
        return s.World(nodes(c), span=cover(c))

    def entity(self, c: Children) -> s.Entity:
        said = once(c[5:], c[0])
        carrier = said["carried"].value[0] if "carried" in said else None
        channels = said["linked"].value if "linked" in said else ()
        return s.Entity(name(c[0]), name(c[2]), c[4], carrier, channels, "absent" in said, span=cover(c))

    entity_clause = kind_clause

    def channel(self, c: Children) -> s.ChannelDeclaration:
        return s.ChannelDeclaration(name(c[1]), span=cover(c))

    def from_source(self, c: Children) -> s.FromSource:
        keep = tuple(item for item in c if isinstance(item, s.Keep))
        limit = None if c[-1] is None else whole(c[-1])
        prefix, time = optional(c[3], name), optional(c[5], text)
        return s.FromSource(text(c[1]), prefix, time, c[7], keep, limit, span=cover(c))

    def keep(self, c: Children) -> s.Keep:
        return s.Keep(name(c[0]), name(c[0] if c[2] is None else c[2]), c[4], span=cover(c))

    # --- geometry

    def placement(self, c: Children) -> s.Placement:
        return s.Placement(c[0], c[1], span=cover(c))

    def altitude(self, c: Children) -> s.AltitudeBand:
        return s.AltitudeBand(c[1], c[3] or c[1], span=cover(c))

    def point(self, c: Children) -> s.Point:
        return s.Point(c[1], span=cover(c))

    def box(self, c: Children) -> s.Box:
        return s.Box(c[1], c[2], span=cover(c))

    def polygon(self, c: Children) -> s.Polygon:
        return s.Polygon(nodes(c), span=cover(c))

    def circle(self, c: Children) -> s.Circle:
        return s.Circle(c[1], c[3], span=cover(c))

    def length(self, c: Children) -> s.Length:
        return s.Length(c[0].value, str(c[1]), span=cover(c))

    def coordinate(self, c: Children) -> s.Coordinate:
        latitude, longitude = c[1], c[3]
        check_hemispheres(latitude, longitude)
        written = (latitude.word, longitude.word)
        return s.Coordinate(latitude.value, longitude.value, written, span=cover(c))

    def number(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), decimal(c[0], c[1]))

    def degrees(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), *degrees(c[0]))

    # --- beliefs

    def believes(self, c: Children) -> s.Believes:
        return s.Believes(nodes(c), span=cover(c))

    def believed_in(self, c: Children) -> s.BelievedIn:
        place = None if c[2].type == "REGION" else name(c[2])
        return s.BelievedIn(name(c[0]), place, span=cover(c))

    def believed_unknown(self, c: Children) -> s.BelievedUnknown:
        return s.BelievedUnknown(name(c[0]), span=cover(c))

    def believed_linked(self, c: Children) -> s.BelievedLinked:
        return s.BelievedLinked(name(c[0]), names(c[2:]), span=cover(c))

    # --- rules

    def rule(self, c: Children) -> s.Rule:
        return s.Rule(name(c[1]), nodes(c[2:-1]), rule_body(c[-1]), span=cover(c))

    def parameter(self, c: Children) -> s.Parameter:
        return s.Parameter(name(c[0]), name(c[2]), span=cover(c))

    # --- environment

    def environment(self, c: Children) -> s.Environment:
        return s.Environment(nodes(c), span=cover(c))

    def drifts_among(self, c: Children) -> s.DriftsAmong:
        return s.DriftsAmong(name(c[0]), nodes(c[3:]), span=cover(c))

    def drifts_within(self, c: Children) -> s.DriftsWithin:
        return s.DriftsWithin(name(c[0]), name(c[3]), span=cover(c))

    def drops(self, c: Children) -> s.Drops:
        return s.Drops(name(c[0]), c[3] is not None, span=cover(c))

    def leaves(self, c: Children) -> s.Leaves:
        return s.Leaves(name(c[0]), name(c[2]), c[4] is not None, span=cover(c))

    def appears(self, c: Children) -> s.Appears:
        return s.Appears(name(c[0]), nodes(c[3:]), names(c[3:]), span=cover(c))

    def vanishes(self, c: Children) -> s.Vanishes:
        return s.Vanishes(name(c[0]), span=cover(c))

    def says(self, c: Children) -> s.Says:
        times = 1 if c[7] is None else c[7].value
        return s.Says(c[2], optional(c[4], agent), times, span=cover(c))

    def times(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), 1 if c[0].type == "ONCE" else whole(c[0]))

    def arrives(self, c: Children) -> s.Arrives:
        return s.Arrives(name(c[0]), span=cover(c))

    def strays(self, c: Children) -> s.Strays:
        return s.Strays(name(c[0]), c[4], span=cover(c))

    def misses(self, c: Children) -> s.Misses:
        return s.Misses(names(c[3:]), span=cover(c))

    def place_name(self, c: Children) -> s.Name:
        return name(c[0])

    # --- scheduler, control and checks

    def scheduler(self, c: Children) -> s.Scheduler:
        return s.Scheduler(option("scheduler", c[1], SCHEDULERS), span=cover(c))

    def control_mode(self, c: Children) -> s.ControlMode:
        return s.ControlMode(option("control", c[1], CONTROL_MODES), span=cover(c))

    def check(self, c: Children) -> s.Check:
        return s.Check(nodes(c), span=cover(c))

    def standard_property(self, c: Children) -> s.StandardProperty:
        return s.StandardProperty(str(c[0]), span=cover(c))

    def fair_deadlock_freedom(self, c: Children) -> s.FairDeadlockFreedom:
        return s.FairDeadlockFreedom(c[2].value, c[1], span=cover(c))

    def invariant(self, c: Children) -> s.Invariant:
        return s.Invariant(c[1], c[3], span=cover(c))

    def reachable(self, c: Children) -> s.Reachable:
        return s.Reachable(c[1], c[3], span=cover(c))

    def temporal(self, c: Children) -> s.TemporalProperty:
        fairness = () if c[2] is None else c[2].value
        return s.TemporalProperty(str(c[0]), c[1], c[4], fairness, span=cover(c))

    def progress(self, c: Children) -> s.Progress:
        return s.Progress(() if c[2] is None else c[2].value, c[1], span=cover(c))

    def under(self, c: Children) -> RuleResult:
        return RuleResult(cover(c), nodes(c))

    def fairness(self, c: Children) -> s.Fairness:
        return s.Fairness(str(c[0]), nodes(c), span=cover(c))

    def steps(self, c: Children) -> s.Steps:
        return s.Steps(tuple(agent(word) for word in c if word is not None), span=cover(c))

    def deadline(self, c: Children) -> s.Deadline:
        return s.Deadline(c[1], c[2], c[4], span=cover(c))

    def first_time(self, c: Children) -> s.FirstTime:
        return s.FirstTime(c[1], c[3], span=cover(c))

    # --- live runs

    def live(self, c: Children) -> s.Live:
        return s.Live(nodes(c), span=cover(c))

    def on_broken(self, c: Children) -> s.OnBroken:
        return s.OnBroken(str(c[2]), option("fallback", c[4], FALLBACKS), span=cover(c))

    def time_limit(self, c: Children) -> s.TimeLimit:
        request = None if c[0] is None else str(c[0])
        who = None if c[1] == "anyone" else agent(c[1])
        return s.TimeLimit(request, who, c[3], option("fallback", c[5], FALLBACKS), span=cover(c))

    # --- formulas

    def connective(self, c: Children) -> s.Connective:
        operator = {"||": "or", "&&": "and"}.get(c[1], str(c[1]))
        return s.Connective(operator, c[0], c[2], span=cover(c))

    def negation_of(self, c: Children) -> s.Negation:
        return s.Negation(c[1], span=cover(c))

    def quantified(self, c: Children) -> s.Quantified:
        first, *others = names(c[1:-8])
        among, behaviour, host = name(c[-7]), optional(c[-5], name), optional(c[-3], name)

        def of(variable: s.Name, body: s.Formula, *, joined: bool) -> s.Quantified:
            return s.Quantified(str(c[0]), variable, among, body, behaviour, host, joined, span=cover(c))

        body = c[-1]
        for variable in reversed(others):
            body = of(variable, body, joined=True)
        return of(first, body, joined=False)

    def path_prefix(self, c: Children) -> s.PathPrefix:
        words = " ".join(map(str, c[:-1]))
        return s.PathPrefix(s.SIGNS.get(words, words), c[-1], span=cover(c))

    def path_operation(self, c: Children) -> s.PathOperation:
        return s.PathOperation(str(c[1]), c[0], c[2], span=cover(c))

    def leads_to(self, c: Children) -> s.LeadsTo:
        return s.LeadsTo(c[0], c[3], span=cover(c))

    def path_quantifier(self, c: Children) -> s.PathQuantifier:
        quantifier, letter = str(c[0][0]), str(c[0][1:])
        span = cover(c)
        if not letter:
            return s.PathQuantifier(quantifier, c[1], span=span)
        path = s.PathPrefix(s.SIGNS[letter], c[1], span=s.Span(span.start + 1, span.end))
        return s.PathQuantifier(quantifier, path, span=span)

    def taken(self, c: Children) -> s.Taken:
        return s.Taken(c[1], span=cover(c))

    def enabled(self, c: Children) -> s.Enabled:
        return s.Enabled(c[1], span=cover(c))

    def formula_group(self, c: Children) -> s.Formula:
        formula: s.Formula = c[1]
        return formula

    def inside(self, c: Children) -> s.Inside:
        return s.Inside(name(c[1]), name(c[4]), c[2] is not None, c[0] is not None, span=cover(c))

    def possibly_in(self, c: Children) -> s.PossiblyIn:
        return s.PossiblyIn(name(c[1]), name(c[3]), span=cover(c))

    def surely_in(self, c: Children) -> s.SurelyIn:
        return s.SurelyIn(name(c[1]), name(c[3]), span=cover(c))

    def apart_from(self, c: Children) -> s.ApartFrom:
        return s.ApartFrom(agent(c[0]), agent(c[8]), c[3], c[5], span=cover(c))

    def within_range_of(self, c: Children) -> s.WithinRangeOf:
        return s.WithinRangeOf(agent(c[0]), agent(c[4]), c[2], span=cover(c))

    def linked_to(self, c: Children) -> s.LinkedTo:
        return s.LinkedTo(name(c[1]), name(c[3]), c[0] is not None, span=cover(c))

    def present(self, c: Children) -> s.Present:
        return s.Present(agent(c[1]), span=cover(c))

    def known(self, c: Children) -> s.Known:
        return s.Known(name(c[1]), span=cover(c))

    def pending(self, c: Children) -> s.Pending:
        return s.Pending(agent(c[2]), None if c[1] is None else str(c[1]), span=cover(c))

    def ended(self, c: Children) -> s.Ended:
        return s.Ended(agent(c[1]), span=cover(c))

    def waiting(self, c: Children) -> s.Waiting:
        return s.Waiting(agent(c[1]), span=cover(c))

    def hosted_at(self, c: Children) -> s.HostedAt:
        return s.HostedAt(agent(c[0]), name(c[2]), span=cover(c))

    def same_name(self, c: Children) -> s.Formula:
        return _equal(c[1], s.SameName(agent(c[0]), agent(c[2]), span=cover(c)))

    def stored(self, c: Children) -> s.Formula:
        operator = "==" if c[3] == "!=" else str(c[3])
        return _equal(c[3], s.Stored(agent(c[0]), name(c[2]), c[4], operator, span=cover(c)))

    def has_value(self, c: Children) -> s.HasValue:
        return s.HasValue(agent(c[1]), name(c[3]), span=cover(c))


def option(owner: str, token: Token, options: tuple[str, ...]) -> str:
    """Return the option that a word names; raises BuildingMistake for another word."""
    if str(token) in options:
        return str(token)
    message = f"'{token}' is no {owner}"
    hint = f"write {', '.join(options[:-1])} or {options[-1]}"
    raise BuildingMistake(Diagnostic(Code.UNKNOWN_OPTION, span_of(token), message, hint))


def _equal(operator: Token, claim: s.SameName | s.Stored) -> s.Formula:
    return s.Negation(claim, span=claim.span) if operator == "!=" else claim
