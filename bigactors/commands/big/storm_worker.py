"""The separate process that runs Storm, which logs to standard output and may crash.

`python -m bigactors.commands.big.storm_worker FOLDER` reads `request.json` in the folder, and writes `reply.json`.
"""

import json
import sys
from pathlib import Path
from typing import Any, Final

FILES: Final = {
    "transitions": ".tra",
    "labeling": ".lab",
    "state_rewards": ".srew",
    "transition_rewards": ".trew",
}


def storm() -> Any:
    """Return Storm's module. It is an extra, and this module can be imported without it."""
    import stormpy

    return stormpy


def main(folder: Path) -> None:
    """Answer the request in a folder: parse each formula, and check it on the model if there is one."""
    formulas = json.loads((folder / "request.json").read_text(encoding="utf-8"))
    files = {name: folder / f"model{suffix}" for name, suffix in FILES.items()}
    given = {name: str(file) for name, file in files.items() if file.exists()}
    model = storm().build_model_from_explicit(**given) if given else None
    replies = [reply(text, model) for text in formulas]
    (folder / "reply.json").write_text(json.dumps(replies), encoding="utf-8")


def reply(text: str, model: Any) -> dict[str, Any]:
    """Return the reply to one formula; `error` is Storm's own message."""
    try:
        formulas = [each.get_raw_formula() for each in storm().parse_properties(text)]
        if len(formulas) != 1:
            return {"error": f"there are {len(formulas)} formulas in it, instead of one"}
        if not isinstance(formulas[0], operators()):
            return {"error": "no operator P, R, T or LRA stands first"}
        if model is None:
            return {"directed": formulas[0].has_bound or formulas[0].has_optimality_type}
        return answer(model, formulas[0])
    except (RuntimeError, TypeError, ValueError) as error:
        return {"error": str(error)}


def operators() -> tuple[Any, ...]:
    """Return the types of formulas that have a value in a state."""
    logic = storm().logic
    return (
        logic.ProbabilityOperatorFormula,
        logic.RewardOperatorFormula,
        logic.TimeOperatorFormula,
        logic.LongRunAverageOperatorFormula,
    )


def answer(model: Any, formula: Any) -> dict[str, Any]:
    """Return the value of a formula in the initial state, and the goals of a run that shows it."""
    start = model.initial_states[0]
    found = storm().model_checking(model, formula, extract_scheduler=model.is_nondeterministic_model)
    said: dict[str, Any] = {}
    if formula.has_bound:
        said["true"] = bool(found[start])
        found = storm().model_checking(
            model, unbounded(formula, model), extract_scheduler=model.is_nondeterministic_model
        )
    value = found[start]
    said["value"] = value.value
    if value.has_lower and value.has_upper:
        said["bounds"] = [value.lower, value.upper]
    if model.is_nondeterministic_model:
        said["choices"] = choices(model, found)
    if isinstance(formula, storm().logic.ProbabilityOperatorFormula):
        said["shown"] = shown(model, formula.subformula)
    return said


def unbounded(formula: Any, model: Any) -> Any:
    """Return the formula that asks for the value that a bounded formula compares."""
    asked = formula.clone()
    asked.remove_bound()
    if model.is_nondeterministic_model and not asked.has_optimality_type:
        least = formula.comparison_type in (
            storm().logic.ComparisonType.GEQ,
            storm().logic.ComparisonType.GREATER,
        )
        ways = storm().logic.OptimizationDirection
        asked.set_optimality_type(ways.MINIMIZE if least else ways.MAXIMIZE)
    return asked


def choices(model: Any, found: Any) -> list[int] | None:
    """Return an optimal strategy's choice in each state; None unless it is memoryless and deterministic."""
    if not found.has_scheduler():
        return None
    scheduler = found.get_scheduler()
    if not (scheduler.memoryless and scheduler.deterministic):
        return None
    taken = (scheduler.get_choice(state) for state in range(model.nr_states))
    return [each.get_deterministic_choice() if each.defined else 0 for each in taken]


def shown(model: Any, path: Any) -> dict[str, Any] | None:
    """Return the goal states of a run that shows a path formula or its opposite; None if no finite run does."""
    logic = storm().logic
    try:
        if isinstance(path, logic.UntilFormula):
            left, right = states(model, path.left_subformula), states(model, path.right_subformula)
            return {"goals": where(right), "within": where(left)}
        if isinstance(path, logic.EventuallyFormula):
            return {"goals": where(states(model, path.subformula))}
        if isinstance(path, logic.GloballyFormula):
            return {"goals": where([not each for each in states(model, path.subformula)]), "against": True}
    except RuntimeError:  # a nested path formula, as in G F
        return None
    return None


def states(model: Any, formula: Any) -> list[bool]:
    """Return for each state whether a state formula holds there; raises RuntimeError for another formula."""
    found = storm().model_checking(model, formula)
    return [bool(found[state]) for state in range(model.nr_states)]


def where(true: list[bool]) -> list[int]:
    """Return the indices of the true entries."""
    return [state for state, is_one in enumerate(true) if is_one]


if __name__ == "__main__":
    main(Path(sys.argv[1]))
