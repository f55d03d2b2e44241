"""Storm's explicit files: the transitions with the kind of model, the labels, and the rewards."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from bigraphs.exports.markov import Markov, MarkovKind, number, to_markov
from bigraphs.transitions import TransitionSystem


def storm_files(system: TransitionSystem) -> dict[str, str]:
    """Return the file texts by suffix: `.tra`, `.lab`, and `.srew` and `.trew` if there are rewards.

    Read them with `storm --explicit model.tra model.lab --staterew model.srew --transrew model.trew`.
    """
    model = to_markov(system)
    files = {
        ".tra": _lines(_transitions(model)),
        ".lab": _lines(_labels(model)),
        ".srew": _lines(f"{state} {number(reward)}" for state, reward in model.rewards),
    }
    if model.kind is MarkovKind.MDP:
        files[".trew"] = _lines(
            f"{move.source} {move.choice} {move.target} {number(move.reward)}"
            for move in model.moves
            if move.reward
        )
    return {suffix: text for suffix, text in files.items() if text}  # Storm rejects an empty file


def _lines(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _transitions(model: Markov) -> Iterator[str]:
    yield model.kind.value
    for move in model.moves:
        choice = f" {move.choice}" if model.kind is MarkovKind.MDP else ""
        yield f"{move.source}{choice} {move.target} {number(move.weight)}"


def _labels(model: Markov) -> Iterator[str]:
    yield "#DECLARATION"
    yield " ".join(name for name, _ in model.labels)
    yield "#END"
    held: dict[int, list[str]] = {}
    for name, states in model.labels:
        for state in states:
            held.setdefault(state, []).append(name)
    for state in sorted(held):
        yield f"{state} {' '.join(held[state])}"
