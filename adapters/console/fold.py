"""The fold: it applies the next messages of a recording to the facts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from adapters.console.agent_states import take_deadline
from adapters.console.alerts import take_finding, tell
from adapters.console.entity_tracks import take_arrival
from adapters.console.facts import Change, Facts, Opening, Standing, Unreplayable
from adapters.console.fates import take_order
from adapters.console.flights import take_command, take_flight, take_report, take_status, take_words
from adapters.console.giving_back import take_giving_back
from adapters.console.mutable_facts import Draft
from adapters.console.operator_actions import take_acknowledgement, take_note, take_saying
from adapters.console.parsing import text
from adapters.console.preflight_checklist import take_preflight
from adapters.console.replayed_steps import take_step
from adapters.console.run_header import run_of
from adapters.console.station_list import take_presence
from adapters.console.watched_ways import take_invariant, take_way
from adapters.live.request_timeouts import heads_of
from adapters.recording.foxglove import OTHERS
from adapters.recording.mcap_files import Message
from adapters.recording.recording_reader import checked_run

TOPICS: Final[dict[str, Callable[[Draft, float, Any], None]]] = {
    "arrivals": take_arrival,
    "steps": take_step,
    "deadlines": take_deadline,
    "flights": take_flight,
    "ways": take_way,
    "invariants": take_invariant,
    "commands": take_command,
    "reports": take_report,
    "sayings": take_saying,
    "given_back": take_giving_back,
    "orders": take_order,
    "findings": take_finding,
    "acknowledged": take_acknowledgement,
    "notes": take_note,
    "status": take_status,
    "said": take_words,
    "stations": take_presence,
    "preflight": take_preflight,
}
"""The handler of each topic's messages; the console shows nothing of other topics."""


def take(draft: Draft, message: Message, opening: Opening) -> None:
    """Take in a message; raises RecordingError if the recording is not of a run."""
    draft.changed = True
    if draft.run is None:
        if message.topic == "run":
            _begin(draft, message, opening)
        return
    draft.time = time_of(draft, message)
    if isinstance(message.data, dict):
        if message.topic == "end":
            draft.end(text(message.data.get("reason")) or "the run has ended", broken_off=False)
        elif message.topic in TOPICS:
            draft.begin = draft.time if draft.begin is None else draft.begin
            TOPICS[message.topic](draft, draft.time, message.data)


def time_of(facts: Facts | Draft, message: Message) -> float:
    """Return the time at which a message counts: time never goes back, even after the old messages of a resumed run.

    The topic `end` and those for other programs may use another clock; their messages count at the current time.
    """
    if facts.run is None or (facts.begin is None and message.topic != "end"):
        return message.time
    timeless = message.topic == "end" or message.topic.startswith(OTHERS)
    return facts.time if timeless else max(facts.time, message.time)


def _begin(draft: Draft, message: Message, opening: Opening) -> None:
    run = checked_run(message.data if isinstance(message.data, dict) else None)
    draft.run, draft.time = run_of(run, message.time), message.time
    try:
        rules = opening(run)
    except Unreplayable as error:
        tell(draft, f"the logical model is not known: {error}")
        return
    first = rules.initial
    draft.standing = Standing(rules, first, Change(0, first, first), heads_of(first, {}, message.time))
