"""The live phase: fallbacks and time limits of live runs."""

from __future__ import annotations

from semantics.live_policy import Fallback, LivePolicy, TimeLimit
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.names import Names
from specs.elaboration.statements import check_duration


def elaborate_live(mission: s.Mission, names: Names) -> LivePolicy:
    """Return the fallbacks and time limits of a mission; by default vehicles hold on a broken assumption."""
    written = [item for section in mission.each(s.Live) for item in section.precautions]
    on_broken = [item for item in written if isinstance(item, s.OnBroken)]
    limits = [item for item in written if isinstance(item, s.TimeLimit)]
    for again in on_broken[1:]:
        message = "'on broken assumption' is written twice"
        names.findings.add(Code.REPEATED_SETTING, again, message, "leave one of the two out")
    fallback = Fallback(on_broken[0].fallback) if on_broken else Fallback.HOLD
    return LivePolicy(fallback, tuple(_limit(item, names) for item in _different(limits, names)))


def _limit(node: s.TimeLimit, names: Names) -> TimeLimit:
    agent = None if node.agent is None else names.agent(node.agent)
    check_duration(node.limit, names.findings)
    return TimeLimit(node.request, agent, node.limit.seconds, Fallback(node.fallback))


def _different(limits: list[s.TimeLimit], names: Names) -> list[s.TimeLimit]:
    seen: set[tuple[str | None, s.Agent | None, float]] = set()
    for node in limits:
        key = (node.request, node.agent, node.limit.seconds)
        if key in seen:
            message = "this time limit is written twice"
            names.findings.add(Code.REPEATED_SETTING, node, message, "leave one of the two out")
        seen.add(key)
    return limits
