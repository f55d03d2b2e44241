"""The words of reports: the meaning of each, and a remedy for each fault."""

from collections.abc import Mapping
from inspect import getdoc
from typing import Final

WORDS: Final[Mapping[str, str]] = {
    "holds": """
        No reachable configuration contradicts the property, and all were explored.""",
    "violated": """
        The property is false. A shortest trace leads to the violation: replay it with
        `bigactors replay`, or step through its page (`check --trace DIR`).""",
    "incomplete": """
        The search stopped at a limit (exit code 3). This is no success: raise the limit, bound the mission's
        environment, or use `--reduce`.""",
    "complete": "All reachable configurations were explored.",
    "configuration": """
        ⟨α | S | η⟩: the bigActors with their remaining programs, the logical and the physical model, and the
        pending requests.""",
    "transition": "A step from one configuration to another by one rule.",
    "depth": """
        The length of the shortest run to the configuration that was found last.""",
    "trace": """
    A run, step by step: `c0 --⟨rule : agent, subject⟩--> c1`. Traces of violations are shortest ones. A trace of `ltl`
    ends in a cycle, which repeats for ever.""",
    "witness": """
        A trace to an examined case that satisfies the property: so the property is not vacuous.""",
    "examined": "The number of cases of a property that were met and satisfy it.",
    "vacuous": """
        The property holds, but is weaker than it seems: its case never occurs, or one of its parts is never
        needed. Look for a mistake.""",
    "never needed": """
        The property holds with any formula in the place of that part. Usually its condition is never true, or
        another part implies it. Look for a mistake in it, or leave it out.""",
    "by ownership": """
        Race-freedom was shown without a search: no bigActor may write anything that another's control reads,
        tests or writes.""",
    "at rest": """
    Only the environment can move. This is no deadlock if each bigActor has ended, or waits at the `react` of an
    outermost `loop` or for a message of `says`.""",
    "coverage": """
        The statements, branches and clauses of the environment that some run reaches. The rest is
        listed.""",
    "never used": "A rule without a step in any run: the mission may differ from your intention.",
    "weak fairness": "A step that is enabled without a break from some point on is taken at some time.",
    "strong fairness": """
        A step that is enabled again and again is taken at some time, even if it is disabled in between.""",
    "believed": """
        A claim about L, on which bigActors act: `uav0 in searchArea0`. `actually` asks P.""",
    "unmatched": """
    A control is next in line, and its redex does not match L: its assumptions are wrong. Observe before it, and test
    the observation.""",
    "inconsistent": """
        A control is next in line, and L no longer agrees with P. Observe the nodes of the control just before
        it, or prevent the change.""",
    "unrealisable": """
    A control is next in line, and no change of the world makes its reactum true: the node is not driven, or its new
    place may not contain it or has no room.""",
    "control race": """
        Two controls are enabled, and serving one disables the other, or the two orders end
        differently. Let one bigActor do both, or let one wait for a message of the other.""",
    "stale-observation race": """
        A control depends on the answer to an observation, and another bigActor's control has changed that
        answer since. Let one bigActor decide, or pass the permission on by messages.""",
    "deadlock": """
        Only the environment can move, and a request is pending or a bigActor waits. The message names each
        cause: a message without a sender, or a missing link.""",
    "not arrived": """
    Only flights are left, and they need not end. Where a vehicle always arrives, declare it in the environment: `uav0
    arrives`.""",
    "unserved request": """
        A request is never served in some fair run. Its enabling condition may come and go: then
        only strong fairness serves it.""",
    "late": """
    The formula of `within` is not true in time on some run. The *critical path* lists the steps that took the time;
    where a step has no bound, a line of `timing` is missing.""",
    "exhausted": """
        A vehicle is away from its place of restoration for longer than it lasts. Shorten its way, let it
        wait less, or restore it in between.""",
    "time stops": """
        Steps that take no time follow one another for ever: no later moment is reached. Give one
        of them a time: `agents take 1 s to 2 s`.""",
    "critical path": """
        The successive steps that add up to a date: the duration of each, its bound, and its line of `timing`.""",
    "zone": """
        A set of ages of the running clocks, in one configuration: the fast engine explores missions with
        `timing` by zones.""",
    "tick": """
        The unit of time, of which all durations are whole numbers: `tick 100 ms`, a second without it.""",
    "diverges": """
        A computation reaches no command: a loop runs for ever without observing, controlling or
        receiving.""",
    "fails": """
        A computation meets a wrong value: the first member of an empty set, a `match`
        without a case.""",
    "L": "The logical model: the bigraph of the beliefs. Observations bring it nearer to P.",
    "P": "The physical model: the true places and channels of all nodes.",
    "η": "The pending requests: OBS, READY, CTR, FLY, SND and MGR.",
    "OBS": "A pending observation: OBS(agent, query). `sense` answers it.",
    "READY": "An observation that was made and not yet received: a `react` takes it.",
    "CTR": """
        A pending control: CTR(agent, action). `actuate` carries it out, `command` sends it to a
        vehicle.""",
    "FLY": "A control under way (`control timed`): `commit` ends it where the vehicle arrives.",
    "in transit": "A vehicle between `command` and `commit` (`control timed`): it is in no place.",
    "SND": """
        A message on its way: it is delivered when both hosts are one node or share a link, in L and
        in P.""",
    "MGR": "A bigActor that wants to move to another host: `migrate` serves it where the hosts are linked.",
    "possibly": """
        `possibly uav0 in place0`: on its way, or at rest, uav0 may be in place0. To stay out is `not possibly
        uav0 in place0`. In doubt it is true.""",
    "surely": """
    `surely uav0 in place0`: uav0 is in place0 wherever it may be on its way, or at rest. In doubt it is false.""",
    "at least": """
    `uav0 at least 50 m from uav1`: they are never nearer, wherever they may be. In doubt it is false.""",
    "region": """
    All points and altitudes where an entity may be while a configuration lasts. `possibly`, `surely`, `at least` and
    `within` are decided on regions.""",
    "strays": """
        `UAV strays at most 30 m`: the farthest that a vehicle is from the shortest lines between its waypoints.""",
    "redex": """
        The left side of a control's reaction rule: its precondition. The right side, the reactum, is its effect.""",
}
"""The words that are neither rules nor properties."""

SHORTEST: Final = 3
"""The most letters that are too few to find a word by its beginning."""

PROPERTIES: Final[Mapping[str, str]] = {
    "local_consistency": """
    Every control next in line can be served in the present world. Otherwise it is *unmatched*, *inconsistent* or
    *unrealisable*; the usual remedy is to observe the nodes of a control just before it.""",
    "race_freedom": """
        No bigActor changes anything that another's control depends on. Otherwise there is a *control race* or
        a *stale-observation race*.""",
    "deadlock_freedom": """
        Some bigActor can move as long as one has work left. Otherwise there is a
        *deadlock*.""",
    "arrival": "No run waits for ever for the end of a flight. Otherwise it has *not arrived*.",
    "computation": "No bigActor's computation *fails* or *diverges*. This is always checked.",
    "invariant": 'A proposition is true of every configuration: `invariant "name": formula`.',
    "reachable": """
        A proposition is true of some configuration: `reachable "name": formula`; the witness shows
        how.""",
    "ltl": """
        A formula of linear time is true of every fair run: `ltl "name": formula`, with `[]`, `<>`,
        `X` and `U`.""",
    "ctl": """
        A formula of branching time is true of the tree of fair runs: `ctl "name": formula`, where
        each of `G`, `F`, `X` and `U` directly follows `A` or `E`.""",
    "progress": "Every request is served in every fair run. Otherwise there is an *unserved request*.",
    "within": """
        A proposition becomes true in time on every run: `within 40 min "name": formula`. With `F leads to G`, G
        follows in time whenever F is true. Between names it compares distances: `uav0 within 3 km of gcs0`.""",
    "endurance": """
    No vehicle is ever away from its place of restoration for longer than it lasts, by the bounds of the section
    `timing`: `uav0 lasts 45 min, restored in base0 after 20 min`.""",
    "time": """
        The earliest and the latest moment at which a proposition first becomes true, or that it
        may never: `time "name": formula`.""",
}
"""The meaning of each kind of properties, by its word."""

RULES: Final = (
    *("fun", "req_obs", "sense", "rcv_obs", "req_ctr", "actuate", "env", "command", "commit"),
    *("req_snd", "snd", "rcv_msg", "timeout", "req_mgr", "migrate", "spawn", "say"),
)
"""The rules; their docstrings are imported on demand, since that is slow."""

ALL: Final = (*PROPERTIES, *WORDS, *RULES)
"""All words with an entry."""


def find_word(asked: str) -> tuple[str, str] | None:
    """Return a word of reports with its meaning; hyphens, underscores, case and endings may differ.

    >>> find_word("stale-observation")[0], find_word("Race Freedom")[0], find_word("unserved OBS")[0]
    ('stale-observation race', 'race_freedom', 'unserved request')
    """
    word = _found(asked)
    if word is None:
        return None
    if word in RULES:
        return word, _rule(word)
    return word, " ".join((PROPERTIES.get(word) or WORDS[word]).split())


def word_list() -> str:
    """Return all words but the rules, in Markdown, for the documentation."""
    return "".join(
        f"- **{word}**: {' '.join(text.split())}\n" for word, text in {**PROPERTIES, **WORDS}.items()
    )


def _found(asked: str) -> str | None:
    if asked in ALL:
        return asked
    spelt = {_spelling(each): each for each in reversed(ALL)}
    wanted = _spelling(asked)
    near = (each for spelling, each in spelt.items() if _begins(spelling, wanted))
    return spelt.get(wanted) or next(near, None)


def _begins(word: str, asked: str) -> bool:
    """Return whether the word begins as asked, or with the first of several words asked."""
    first, *rest = asked.split() or [""]
    return len(asked) > SHORTEST and (word.startswith(asked) or (bool(rest) and word.startswith(f"{first} ")))


def _spelling(word: str) -> str:
    return word.replace("-", " ").replace("_", " ").lower().strip()


def _rule(name: str) -> str:
    from semantics import bigactor_rules, rules  # noqa: PLC0415 - slow to import

    return getdoc(getattr(rules, name, None) or getattr(bigactor_rules, name)) or ""
