"""Philosophers at a round table, as a model: each takes two forks, eats, and lays them down."""

from collections.abc import Iterator

from bigactors import Label, Limits, ModelVerdict, explore

State = tuple[int, ...]
"""For each philosopher the number of forks in hand: 0, 1 or 2."""


class Table:
    """A table with as many forks as seats; all take the left fork first, or the last one takes the right fork first.

    Attributes:
        initial: Nobody has a fork.
    """

    def __init__(self, seats: int, *, last_is_left_handed: bool) -> None:
        self.initial: State = (0,) * seats
        self.forks = [(seat, (seat + 1) % seats) for seat in range(seats)]
        if last_is_left_handed:
            self.forks[-1] = self.forks[-1][::-1]

    def successors(self, state: State) -> Iterator[tuple[Label, State]]:
        """Yield the steps of each philosopher."""
        held = {fork for seat, count in enumerate(state) for fork in self.forks[seat][:count]}
        for seat, count in enumerate(state):
            if count == 2:
                yield Label(f"eat{seat}", f"p{seat}"), self._with(state, seat, 0)
            elif self.forks[seat][count] not in held:
                yield Label(f"take{seat}", f"p{seat}"), self._with(state, seat, count + 1)

    def _with(self, state: State, seat: int, count: int) -> State:
        return (*state[:seat], count, *state[seat + 1 :])


def are_apart(state: State) -> bool:
    """Return whether no two neighbours eat at the same time."""
    return all(left + right < 4 for left, right in zip(state, (*state[1:], state[0]), strict=True))


def shown(question: str, verdict: ModelVerdict[State]) -> str:
    """Return a verdict as text, with its run."""
    steps = [step.label or "stays" for step in verdict.run or ()]
    loop = "" if verdict.loop is None else f", and again from step {verdict.loop + 1}"
    note = f" ({verdict.note})" if verdict.note else ""
    return f"{question}: {verdict.outcome.value}{note}; {' '.join(steps)}{loop}".rstrip("; ")


if __name__ == "__main__":
    for last_is_left_handed in (False, True):
        found = explore(Table(3, last_is_left_handed=last_is_left_handed), limits=Limits(seconds=60))
        print(found)
        print(shown("no deadlock", found.no_deadlock()))
        print(shown("neighbours never eat together", found.always(are_apart)))
        print(shown("the first eats at last", found.ltl("<> first", first=lambda state: state[0] == 2)))
        print(shown("the first may eat again", found.ctl("AG EF first", first=lambda state: state[0] == 2)))
