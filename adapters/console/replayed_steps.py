"""The steps of the run, replayed by its rules."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final

from adapters.console.alerts import tell
from adapters.console.facts import Change, Standing, Unreplayable
from adapters.console.flights import arrive
from adapters.console.mutable_facts import Draft
from adapters.console.parsing import count, text, texts
from adapters.console.ticks import tick
from adapters.live.due_times import HeadRequest
from adapters.live.request_timeouts import heads_of
from adapters.live.run_watchers import SHOWN_RULES
from semantics.state.brief import cut
from semantics.state.canonical import written
from semantics.state.configuration import Configuration, Label
from semantics.state.differences import differences
from semantics.state.requests import REQUESTS, SND

MOST: Final = 200
"""The number of newest steps that are kept."""

MOST_CHANGES: Final = 40

SORTS: Final = {"env": "world", "commit": "world", "say": "say"}
"""The sort of a tick, by its rule; `control` for the other rules of `SHOWN_RULES`."""

STRUCTURE: Final = frozenset({"parent", "links", "placement", "channels", "down", "names"})
"""The cells of L and P."""


def take_step(draft: Draft, time: float, data: Any) -> None:
    """Take in a step: the configuration after it, and the changes."""
    label, number = data.get("label"), count(data.get("number"))
    if not isinstance(label, str) or number is None:
        return
    before = draft.standing
    found = None if before is None else _followed(draft, before, number, time, data)
    rule = label.removeprefix("⟨").partition(" ")[0] if found is None else found.rule
    shown = texts(data.get("shown"))
    told = rule in SHOWN_RULES or bool(shown)
    changed: tuple[str, ...] = ()
    if before is not None and draft.standing is not None:
        changed = changes(before.configuration, draft.standing.configuration)
    draft.step = number
    draft.steps[str(number)] = {
        "time": time,
        "label": text(label),
        "rule": text(rule),
        "agent": None if found is None else found.agent,
        "about": text(label.partition(" : ")[2].removesuffix("⟩") if found is None else found.details),
        "changes": changed,
        "shown": shown,
        "told": told,
    }
    draft.steps.bounded(MOST)
    if rule in SHOWN_RULES:
        tick(draft, time, SORTS.get(rule, "control"))


def _followed(draft: Draft, standing: Standing, number: int, time: float, data: Any) -> Label | None:
    """Replay a step and return its label; if the rules do not allow it, give up the replay for good."""
    before = standing.configuration
    try:
        label, after = standing.rules.follow(before, data)
    except Unreplayable as error:
        tell(draft, f"the logical model is not known any more: {error}")
        draft.standing = None
        return None
    change = Change(number, before, after) if is_structural(before, after) else standing.change
    draft.standing = Standing(standing.rules, after, change, _heads(standing, label, after, time))
    arrive(draft, label, before)
    return label


def _heads(standing: Standing, label: Label, after: Configuration, time: float) -> Mapping[str, HeadRequest]:
    """Return the heads of lines after a step; the wait of a next request starts now, even if it is an equal one."""
    served = isinstance(label.about, REQUESTS) and not isinstance(label.about, SND)
    known = {key: each for key, each in standing.heads.items() if not (served and key == label.agent)}
    return heads_of(after, known, time)


@lru_cache(maxsize=1 << 12)
def changes(before: Configuration, after: Configuration) -> tuple[str, ...]:
    """Return descriptions of the changes of a step; cached, since observing loops repeat the same steps."""
    return tuple(cut(each, 200) for each in differences(before, after)[:MOST_CHANGES])


@lru_cache(maxsize=1 << 12)
def is_structural(before: Configuration, after: Configuration) -> bool:
    """Return whether a step has changed L or P."""
    return any(cell[0] in STRUCTURE for cell in written(before, after))
