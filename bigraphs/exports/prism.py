"""PRISM's explicit files: transitions, labels, the same labels as formulas, and rewards of states and choices."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from bigraphs.exports.markov import Markov, MarkovKind, MatrixEntry, number, to_markov
from bigraphs.transitions import TransitionSystem


def prism_files(system: TransitionSystem) -> dict[str, str]:
    """Return the file texts by suffix: `.tra`, `.lab`, `.csl`, `.srew`, and `.trew` for an MDP.

    Read them with `prism -importmodel model.tra,lab,srew -dtmc` (or `-ctmc`, `-mdp`).
    """
    model = to_markov(system)
    files = {
        ".tra": _lines(_transitions(model)),
        ".lab": _lines(_labels(model)),
        ".csl": _lines(_formulas(model)),
        ".srew": _lines(_state_rewards(model)),
    }
    if model.kind is MarkovKind.MDP:
        files[".trew"] = _lines(_choice_rewards(model))
    return files


def _lines(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def _transitions(model: Markov) -> Iterator[str]:
    if model.kind is MarkovKind.MDP:
        yield f"{model.states} {model.choices} {len(model.moves)}"
    else:
        yield f"{model.states} {len(model.moves)}"
    for move in model.moves:
        action = f" {move.action}" if move.action and model.kind is MarkovKind.MDP else ""
        yield f"{_row(model, move)} {move.target} {number(move.weight)}{action}"


def _row(model: Markov, move: MatrixEntry) -> str:
    return f"{move.source} {move.choice}" if model.kind is MarkovKind.MDP else str(move.source)


def _labels(model: Markov) -> Iterator[str]:
    yield " ".join(f'{place}="{name}"' for place, (name, _) in enumerate(model.labels))
    held: dict[int, list[int]] = {}
    for place, (_, states) in enumerate(model.labels):
        for state in states:
            held.setdefault(state, []).append(place)
    for state in sorted(held):
        yield f"{state}: {' '.join(map(str, held[state]))}"


def _formulas(model: Markov) -> Iterator[str]:
    for name, states in model.labels[2:]:  # PRISM defines init and deadlock itself
        yield f'label "{name}" = {" | ".join(f"x={state}" for state in states) or "false"};'


def _state_rewards(model: Markov) -> Iterator[str]:
    yield f"{model.states} {len(model.rewards)}"
    for state, reward in model.rewards:
        yield f"{state} {number(reward)}"


def _choice_rewards(model: Markov) -> Iterator[str]:
    earning = [move for move in model.moves if move.reward]
    yield f"{model.states} {model.choices} {len(earning)}"
    for move in earning:
        yield f"{move.source} {move.choice} {move.target} {number(move.reward)}"
