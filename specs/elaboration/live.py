"""The live phase: fallbacks and time limits of live runs."""

from __future__ import annotations

from semantics.live_policy import Fallback, LivePolicy, TimeLimit
from specs import syntax as s
from specs.codes import Code
from specs.elaboration.names import Names
from specs.elaboration.statements import check_duration


def elaborate_live(mission: s.Mission, names: Names) -> LivePolicy:
    """Return the fallbacks and time limits of a mission.

    By default vehicles hold on a broken assumption, and go on after a broken property.
    """
    written = [item for section in mission.each(s.Live) for item in section.precautions]
    limits = [item for item in written if isinstance(item, s.TimeLimit)]
    fallbacks: dict[str, Fallback] = {}
    for item in written:
        if not isinstance(item, s.OnBroken):
            continue
        if item.what in fallbacks:
            message = f"'on broken {item.what}' is written twice"
            names.findings.add(Code.REPEATED_SETTING, item, message, "leave one of the two out")
        fallbacks.setdefault(item.what, Fallback(item.fallback))
    return LivePolicy(
        fallbacks.get("assumption", Fallback.HOLD),
        tuple(_limit(item, names) for item in _different(limits, names)),
        fallbacks.get("property", Fallback.CONTINUE),
    )


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
