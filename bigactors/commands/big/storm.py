"""Probabilities, rewards and strategies of `bigactors big check --storm`, by the model checker Storm.

Formulas are in Storm's language, with the file's predicates in their own notation. The explored system goes to Storm in
the files of `big full --storm`. Storm runs in a separate process (`storm_worker`).
"""

import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from bigactors.mistakes import Mistake
from bigraphs.claims import ClaimOutcome, Decided, Value, WitnessRun, WitnessStep, predicate_hint
from bigraphs.errors import NotationError
from bigraphs.exports.markov import KINDS, OWN_LABELS, MarkovKind, label_names
from bigraphs.exports.storm import storm_files
from bigraphs.likeliest import Likeliest, decisions, likeliest_run
from bigraphs.system import System
from bigraphs.transitions import TransitionSystem
from physical.wordings import counted, install_extra

EXAMPLES: Final = "write P=? [F goal], Pmax=? [a U b], P>=0.9 [G !bad], T=? [F goal] or R=? [C<=10]"
_OPERATORS: Final = "P|R|T|LRA"
WORDS: Final = re.compile(rf"(?:{_OPERATORS})(?:min|max)?|[SFGXUWCI]|true|false")
"""The words of Storm's language that cannot be labels."""
MOST_CHARACTERS: Final = 2_000

_PIECE: Final = re.compile(
    r"""(?P<number>\d[\w.]*(?:(?<=[eE])[+-]\d+)?)
      | (?P<quoted>"[^"]*")
      | (?P<name>[^\W\d][\w']*)(?P<arguments>\((?:[^()"]|"[^"]*")*\))?""",
    re.VERBOSE,
)


def translated(text: str, system: System) -> str:
    """Return a formula with predicates as labels; raises NotationError for a name that is no predicate.

    >>> from bigraphs.examples import example_text
    >>> from bigraphs.notation import read_system
    >>> translated("Pmax=? [F<=3 delivered]", read_system(example_text("mobile_ambients")))
    'Pmax=? [F<=3 "delivered"]'
    """
    if len(text) > MOST_CHARACTERS:
        message = f"a formula of more than {MOST_CHARACTERS:,} characters"
        raise NotationError("too-long", message, text, 0, hint="ask its parts one by one")
    labels = [predicate.label for predicate in system.predicates]
    known = dict(zip(labels, label_names(system), strict=True)) | {each: each for each in OWN_LABELS}
    pieces, at = [], 0
    while found := _PIECE.search(text, at):
        end, piece = _label(text, found, known)
        pieces += [text[at : found.start()], piece]
        at = end
    return "".join((*pieces, text[at:])).strip()


def _label(text: str, found: re.Match[str], known: dict[str, str]) -> tuple[int, str]:
    """Return the end of a piece of a formula, and its replacement."""
    if found["number"]:
        return found.end(), found["number"]
    if found["quoted"] is None and found["arguments"]:
        whole = (found["name"] + found["arguments"]).replace(" ", "")
        if whole in known:
            return found.end(), f'"{known[whole]}"'
    name = found["quoted"][1:-1] if found["quoted"] else found["name"]
    end = found.start() + len(found["quoted"] or name)
    if not found["quoted"] and WORDS.fullmatch(name):
        return end, name
    if name not in known:
        labels = [each for each in known if each not in OWN_LABELS]
        hint = predicate_hint(name, labels)
        raise NotationError(
            "predicate", f"unknown predicate '{name}'", text, found.start(), length=len(name), hint=hint
        )
    return end, f'"{known[name]}"'


def check_queries(queries: Sequence[str], system: System) -> None:
    """Refuse an invalid formula, and a missing Storm, before a long exploration.

    Raises:
        Mistake: Storm is not installed, or it does not understand a formula.
        NotationError: A name in a formula is no predicate.
    """
    if find_spec("stormpy") is None:
        raise Mistake("--storm needs Storm, which is not installed", install_extra("storm"))
    texts = [translated(each, system) for each in queries]
    for text, reply in zip(queries, _replies(texts), strict=True):
        _refuse(text, reply)
        if KINDS[system.kind] is MarkovKind.MDP and not reply["directed"]:
            asked, kind = " ".join(text.split()), system.kind.value
            message = f"'{asked}' has many values, since a system of kind {kind} has choices"
            raise Mistake(message, "ask for the least or the greatest: Pmin=?, Pmax=?, Rmin=?, ...")


def answers(found: TransitionSystem, queries: Sequence[str]) -> Iterator[Decided]:
    """Yield Storm's answer to each query about an explored system; a failed query leaves the other answers."""
    texts = [translated(each, found.system) for each in queries]
    replies = _each_reply(texts, storm_files(found))
    for text, reply in zip(queries, replies, strict=True):
        claim = f"storm {' '.join(text.split())}"
        if "error" in reply:
            yield Decided(
                claim, ClaimOutcome.INCOMPLETE, note=_without_answer(text, reply["error"], found.system)
            )
        else:
            yield answer(found, claim, reply)


def _each_reply(texts: list[str], files: dict[str, str]) -> list[dict[str, Any]]:
    """Return Storm's replies; if a call fails as a whole, call Storm for each formula alone."""
    try:
        return _replies(texts, files)
    except Mistake as failed:
        if len(texts) == 1:
            return [{"error": failed.message}]
        return [reply for text in texts for reply in _each_reply([text], files)]


def _without_answer(text: str, error: str, system: System) -> str:
    """Return the reason why there is no answer, and the remedy."""
    rewarded = any(each.reward for each in system.predicates) or any(each.reward for each in system.actions)
    if text.lstrip().startswith("R") and not rewarded:
        return "no answer: the system has no rewards; give a predicate one, as in preds = { p[2] }"
    return f"no answer: {_said(error)}"


def answer(found: TransitionSystem, claim: str, reply: dict[str, Any]) -> Decided:
    """Return Storm's answer to one query; for an incomplete system it covers only the explored part."""
    outcome = ClaimOutcome.HOLDS if reply.get("true", True) else ClaimOutcome.VIOLATED
    note = ""
    if not found.complete:
        outcome = ClaimOutcome.INCOMPLETE
        note = f"of the {counted(found.expanded, 'state')} that were explored: beyond them nothing happens"
    value = Value(reply["value"], tuple(reply.get("bounds", ())), "true" in reply)
    strategy: list[int] | None = reply.get("choices")
    shown: dict[str, Any] = reply.get("shown") or {"goals": []}
    goals = set(shown["goals"])
    chosen = decisions(found, strategy, goals) if strategy else {}
    run, what = None, ""
    if strategy or "choices" not in reply:
        within = set(shown["within"]) if "within" in shown else None
        likeliest = likeliest_run(found, goals, within, strategy)
        run, what = _run(likeliest, strategy is not None, "against" in shown)
    return Decided(claim, outcome, run, what, note, value=value, strategy=chosen)


def _run(likeliest: Likeliest | None, has_strategy: bool, is_against: bool) -> tuple[WitnessRun | None, str]:
    """Return the likeliest run, and its description."""
    if likeliest is None:
        return None, ""
    steps = (
        WitnessStep(each.rules, each.target, each.action or "", chance)
        for each, chance in zip(likeliest.transitions, likeliest.chances, strict=True)
    )
    by, sort = "by this strategy " if has_strategy else "", "against it" if is_against else "that shows it"
    return WitnessRun(tuple(steps)), f"{by}the likeliest run {sort}, of probability {likeliest.chance:.6g}"


def _replies(texts: list[str], files: dict[str, str] | None = None) -> list[dict[str, Any]]:
    """Return Storm's reply to each formula, on the model in `files` if there is one; raises Mistake if Storm fails."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        for suffix, text in (files or {}).items():
            (folder / f"model{suffix}").write_text(text, encoding="utf-8")
        (folder / "request.json").write_text(json.dumps(texts), encoding="utf-8")
        command = [sys.executable, "-m", "bigactors.commands.big.storm_worker", name]
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
        reply = folder / "reply.json"
        if done.returncode or not reply.exists():
            last = (done.stderr or done.stdout).strip().splitlines()[-1:] or [f"exit code {done.returncode}"]
            raise Mistake(f"Storm failed: {last[0]:.300}", "try the formula on fewer states (--max-states)")
        found: list[dict[str, Any]] = json.loads(reply.read_text(encoding="utf-8"))
        return found


def _refuse(text: str, reply: dict[str, Any]) -> None:
    if "error" not in reply:
        return
    raise Mistake(f"Storm cannot answer '{' '.join(text.split())}': {_said(reply['error'])}", EXAMPLES)


def _said(error: str) -> str:
    """Return Storm's message in one line, without the names of its classes."""
    said = re.sub(r"\b\w+Exception:\s*", "", error).split("\nNote that")[0]
    said = re.sub(r"Parsing error at [\d:]+:\s*|\s*\^\s*$", "", " ".join(said.split()))
    return f"{said:.400}"
