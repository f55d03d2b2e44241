"""The canonical layout of the `timing` section."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from specs import syntax as s
from specs.construct_text import constant, separated, write


def _motion(node: s.Motion) -> list[str]:
    clauses = [f"{write(node.name)} flies at {write(node.speeds)}"]
    if node.climbs:
        clauses.append(f"climbs at {write(node.climbs)}")
    if node.circles:
        clauses.append(f"circles {write(node.circles)}")
    return [*(f"{clause}," for clause in clauses[:-1]), clauses[-1]]


def _lasting(node: s.Lasting) -> list[str]:
    head = f"{write(node.name)} lasts {write(node.lasts)}"
    if not node.places:
        return [head]
    after = [f"after {write(node.after)}"] if node.after else []
    return [f"{head},", *separated("restored in", node.places), *after]


def _lapse(node: s.Lapse, verb: str = "takes") -> str:
    match node.least, node.most:
        case None, s.Duration() as most:
            return f"within {write(most)}"
        case s.Duration() as least, None:
            return f"{verb} at least {write(least)}"
        case s.Duration() as least, s.Duration() as most:
            return f"{verb} {write(least)}" + ("" if least == most else f" to {write(most)}")
    return ""


def _reaction_time(node: s.ReactionTime) -> list[str]:
    return [f"agents {'' if node.lapse.least else 'react '}{_lapse(node.lapse, 'take')}"]


def _message_time(node: s.MessageTime) -> list[str]:
    where = f"over {write(node.channel)}" if node.channel else "on one host"
    return [f"messages {where} {_lapse(node.lapse, 'take')}"]


def _repeated(head: str, node: s.DropTime | s.LeaveTime) -> list[str]:
    back = f"returns within {write(node.returns)}" if node.returns else ""
    if node.every is None:
        return [head, f"and {back}"]
    every = f"{head} at most every {write(node.every)}"
    return [f"{every},", back] if back else [every]


def _between(after: s.Duration | None, word: str, end: s.Duration | None) -> str:
    said = [f"{each} {write(at)}" for each, at in (("after", after), (word, end)) if at]
    return ", ".join(said)


def _said(node: s.SayTime) -> list[str]:
    to = f" to {write(node.recipient)}" if node.recipient else ""
    return [f"someone says {constant(node.message)}{to}", _between(node.after, "until", node.until)]


TIMING_PIECES: Final[dict[type[s.Node], Callable[..., list[str]]]] = {
    s.Tick: lambda node: [f"tick {write(node.duration)}"],
    s.Motion: _motion,
    s.Lasting: _lasting,
    s.ReactionTime: _reaction_time,
    s.SensingTime: lambda node: [f"sense {_lapse(node.lapse)}"],
    s.MessageTime: _message_time,
    s.StepTime: lambda node: [f"{write(node.word)} {_lapse(node.lapse)}"],
    s.DriftTime: lambda node: [f"{write(node.entity)} drifts at most every {write(node.every)}"],
    s.DropTime: lambda node: _repeated(f"{write(node.channel)} drops", node),
    s.LeaveTime: lambda node: _repeated(f"{write(node.entity)} leaves {write(node.channel)}", node),
    s.PresenceTime: lambda node: [
        f"{write(node.entity)} {node.verb} {_between(node.after, 'within', node.within)}"
    ],
    s.SayTime: _said,
}
"""The function that returns each construct's text in pieces."""
