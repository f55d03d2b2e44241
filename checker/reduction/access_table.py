"""The cells that each rule reads and writes on the shipped missions, and what each read is for, as a table."""

from collections import defaultdict, deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from typing import Any, Final

from checker.recording.whole_cells import recorded_cells, writes_of
from semantics.behaviours.expressions import Fault
from semantics.bigactor_rules import EXTENSION, say
from semantics.rules import RULES, TIMED_RULES, env
from semantics.state.cell_values import MONITOR
from semantics.state.configuration import Configuration, Transition
from semantics.successors import rules_of, successors

FIRST: Final = 60
"""The number of first configurations of each mission in which the rules run."""

PENDING: Final = "η"
WORDS: Final = dict.fromkeys(("line", "sends", "queue"), PENDING)
"""The cells of pending requests, as the scheduler has them: the table has one word for them."""

Accesses = dict[str, list[str]]
"""The kinds of cells that each rule accesses."""

_STATEMENT: Final = {"code": "(its next statement)", "store": "(the variables there)", "host": "(`HOST`)"}
_REQUEST: Final = {**_STATEMENT, PENDING: "(the end of its line)"}
_LINK: Final = {
    "host": "(the nodes that are to share a link)",
    "links": "(the links of both in L)",
    "channels": "(those in P)",
    "placement": "(whether both are in P)",
    "down": "(which links are down)",
}
_CONTROL: Final = {
    PENDING: "(the request)",
    "host": "(whether it is in the match)",
    "parent": "(the match in L, and that L stays a forest)",
    "links": "(the match in L)",
    "placement": "(consistency with P, and P′)",
    "channels": "(consistency of links)",
    "down": "(consistency of links)",
}

PURPOSES: Final[dict[str, dict[str, str]]] = {
    "fun": _STATEMENT,
    "req_obs": _REQUEST,
    "sense": {
        PENDING: "(the request)",
        "placement": "(the answer)",
        "channels": "(the answer's links)",
        "down": "(the answer's links)",
        "parent": "(what L ⊕ L_q keeps)",
        "links": "(what L ⊕ L_q keeps)",
        "host": "(what cannot be missed)",
    },
    "rcv_obs": {**_STATEMENT, "code": "(the cases of its `react`)", PENDING: "(the first observation)"},
    "req_ctr": _REQUEST,
    "actuate": _CONTROL,
    "env": {
        "placement": "(what the clause moves)",
        "channels": "(what the clause takes from it)",
        "down": "(whether the link is down)",
    },
    "command": _CONTROL,
    "commit": {key: value for key, value in _CONTROL.items() if key != "host"}
    | {"placement": "(whether it flies there, consistency, and P′)"},
    "req_snd": _REQUEST,
    "snd": {PENDING: "(the message)", **_LINK, "mailbox": "(its end)"},
    "rcv_msg": {**_STATEMENT, "code": "(the cases of its `react`)", "mailbox": "(the messages)"},
    "timeout": {
        **_STATEMENT,
        "code": "(the cases of its `react`)",
        "mailbox": "(that no case takes a message)",
        PENDING: "(that no case takes an observation)",
    },
    "req_mgr": _REQUEST,
    "migrate": {PENDING: "(the request)", **_LINK},
    "say": {"says": "(how often it may still be said)", "mailbox": "(its end)"},
}
"""What each read is for."""


def access_table(missions: Iterable[Configuration]) -> Iterator[str]:
    """Yield the lines of the table, from the first configurations of some missions.

    Raises:
        ValueError: A read has no purpose in `PURPOSES`.
    """
    reads, writes = accesses(missions)
    yield "| rule | reads, each for | writes |"
    yield "| --- | --- | --- |"
    for rule in (each.__name__ for each in (*RULES, env, *TIMED_RULES, *EXTENSION, say)):
        if rule in reads:
            yield f"| `{rule}` | {'; '.join(_purposes(rule, reads[rule]))} | {_listed(writes[rule])} |"


def _purposes(rule: str, reads: Iterable[str]) -> Iterator[str]:
    """Yield the purposes of reads, each with its kinds of cells."""
    found: dict[str, list[str]] = {}
    for word in sorted(reads, key=list(PURPOSES[rule]).index):
        found.setdefault(PURPOSES[rule][word], []).append(word)
    return (f"{_listed(words)} {purpose}" for purpose, words in found.items())


def _listed(words: Iterable[str]) -> str:
    return ", ".join(f"`{word}`" for word in words)


def accesses(missions: Iterable[Configuration]) -> tuple[Accesses, Accesses]:
    """Return the kinds of cells that each rule reads, of those that some rule writes, and those that it writes."""
    reads: defaultdict[str, set[str]] = defaultdict(set)
    writes: defaultdict[str, set[str]] = defaultdict(set)
    for mission in missions:
        for c in first_configurations(mission):
            for rule, about in _rules(c):
                read, wrote = _run(c, rule, about)
                reads[rule.__name__] |= read
                writes[rule.__name__] |= wrote
    varying = set[str]().union(*writes.values())
    return {rule: sorted(found & varying) for rule, found in reads.items() if writes[rule]}, {
        rule: sorted(found) for rule, found in writes.items()
    }


def first_configurations(initial: Configuration) -> list[Configuration]:
    """Return the first configurations of a mission, breadth-first."""
    found, waiting = {initial: None}, deque([initial])
    while waiting and len(found) < FIRST:
        new = dict.fromkeys(step.target for step in successors(waiting.popleft()))
        waiting.extend(each for each in new if each not in found)
        found |= new
    return list(found)


def _rules(c: Configuration) -> Iterator[tuple[Callable[..., Iterable[Transition]], Any]]:
    yield from ((rule, a) for rule in rules_of(c.setting.control) for a in c.alpha.names())
    yield from ((rule, clause) for rule in (env, say) for clause in c.setting.environment)


def _run(
    c: Configuration, rule: Callable[..., Iterable[Transition]], about: Any
) -> tuple[set[str], set[str]]:
    """Return the kinds of cells that a rule reads and writes where it applies; the race monitor's don't count."""
    asked, over = recorded_cells(c, lambda _: True)
    steps: list[Transition] = []
    with suppress(Fault):
        steps.extend(rule(over, about))
    wrote = {cell for step in steps for cell in writes_of(step)}
    return _kinds(ask.cell for ask in asked) if steps else set(), _kinds(wrote)


def _kinds(cells: Iterable[tuple[str, ...]]) -> set[str]:
    return {WORDS.get(cell[0], cell[0]) for cell in cells} - {MONITOR}
