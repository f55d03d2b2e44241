"""Families of bigraphical systems with the shapes of models that people write, each counted without any bigraphs.

Real files have many instances of a rule, many classes of priority, deep nesting, shared places, or links that are
made and broken. Each function returns the member of such a family of some size, in BigraphER's language, with the
states and the pairs of a state and a successor that it has.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

State = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Model:
    """A system, and how many states and transitions it has."""

    title: str
    text: str
    states: int
    transitions: int


def batteries(cells: int, levels: int) -> Model:
    """Many parametrised rules: alike cells give one another charge, a rule for each pair of levels, and use it."""
    inside = " | ".join([f"Cell.Level({levels - 1})"] * cells)
    text = f"""\
ctrl Cell = 0;
atomic fun ctrl Level(n) = 0;
fun react use(n) = Cell.Level(n) --> Cell.Level(n - 1);
fun react give(n, m) = Cell.Level(n) || Cell.Level(m) --> Cell.Level(n - 1) || Cell.Level(m + 1);
big full = {inside};
begin brs
  int n = [1:1:{levels - 1}];
  int m = [0:1:{levels - 2}];
  init full;
  rules = [ {{use(n), give(n, m)}} ];
end
"""

    def steps(state: State) -> Iterator[State]:
        for giver, charge in enumerate(state):
            less = (*state[:giver], charge - 1, *state[giver + 1 :])
            if charge:
                yield less
                for taker in range(cells):
                    if taker != giver and state[taker] < levels - 1:
                        yield (*less[:taker], less[taker] + 1, *less[taker + 1 :])

    return _model(f"batteries, {cells} cells, {levels} levels", text, (levels - 1,) * cells, steps, _sorted)


def agenda(tasks: int, stages: int) -> Model:
    """Many classes of priority: a class for each stage, the last ones first, each third at once.

    At a stage that takes time a task may also fail, and begin anew.
    """

    def at_once(stage: int) -> bool:
        return stage % 3 == 2

    rules = [f"react do{stage} = Task.Stage({stage}) --> Task.Stage({stage + 1});" for stage in range(stages)]
    rules += [f"react fail{stage} = Task.Stage({stage}) --> Task.Stage(0);" for stage in range(1, stages)]
    classes = [
        f"(do{stage})" if at_once(stage) else f"{{do{stage}, fail{stage}}}" if stage else "{do0}"
        for stage in reversed(range(stages))
    ]
    text = f"""\
ctrl Task = 0;
atomic fun ctrl Stage(n) = 0;
{chr(10).join(rules)}
big begun = {" | ".join(["Task.Stage(0)"] * tasks)};
begin brs
  init begun;
  rules = [ {", ".join(classes)} ];
end
"""

    def settled(state: State) -> State:
        while True:
            first = max((stage for stage in state if stage < stages), default=0)
            if not at_once(first):
                return state
            state = tuple(stage + (stage == first) for stage in state)

    def steps(state: State) -> Iterator[State]:
        first = max((stage for stage in state if stage < stages), default=stages)
        if first < stages:
            task = state.index(first)
            for after in {first + 1, 0 if first else first + 1}:
                yield settled((*state[:task], after, *state[task + 1 :]))

    return _model(f"agenda, {tasks} tasks, {stages} stages", text, (0,) * tasks, steps, _sorted)


def nest(tokens: int, depth: int) -> Model:
    """Deep nesting: tokens go into boxes inside of boxes, and out."""
    boxes = "Box.1"
    for _ in range(depth - 1):
        boxes = f"Box.{boxes}"
    text = f"""\
ctrl Box = 0;
atomic ctrl Token = 0;
react enter = Token | Box.id --> Box.(Token | id);
react leave = Box.(Token | id) --> Token | Box.id;
big outside = {" | ".join(["Token"] * tokens)} | {boxes};
begin brs
  init outside;
  rules = [ {{enter, leave}} ];
end
"""

    def steps(state: State) -> Iterator[State]:
        for token, at in enumerate(state):
            for to in (at - 1, at + 1):
                if 0 <= to <= depth:
                    yield (*state[:token], to, *state[token + 1 :])

    return _model(f"nest, {tokens} tokens, depth {depth}", text, (0,) * tokens, steps, _sorted)


def calls(phones: int) -> Model:
    """Links made and broken: distinct phones call one another, two at a time."""
    text = f"""\
atomic fun ctrl Idle(i) = 0;
atomic fun ctrl Busy(i) = 1;
fun react call(i, j) = Idle(i) || Idle(j) --> /e (Busy(i){{e}} || Busy(j){{e}});
fun react hang(i, j) = /e (Busy(i){{e}} || Busy(j){{e}}) --> Idle(i) || Idle(j);
big idle = {" | ".join(f"Idle({phone})" for phone in range(phones))};
begin brs
  int i = [0:1:{phones - 1}];
  int j = [0:1:{phones - 1}];
  init idle;
  rules = [ {{call(i, j), hang(i, j)}} ];
end
"""

    def steps(state: State) -> Iterator[State]:  # with whom each phone talks, with itself if it is idle
        for one in range(phones):
            for other in range(one + 1, phones):
                if (state[one] == one and state[other] == other) or state[one] == other:
                    after = list(state)
                    after[one], after[other] = state[other], state[one]
                    yield tuple(after)

    return _model(f"calls, {phones} phones", text, tuple(range(phones)), steps, lambda state: state)


def motes(count: int) -> Model:
    """Shared places: motes in a ring are in the ranges of their neighbours; news spreads, and motes fall asleep."""
    letters = [f"a{mote}" for mote in range(count)]
    ranges = [sorted({(mote - 1) % count, mote, (mote + 1) % count}) for mote in range(count)]
    nodes = " || ".join(f"{'Informed' if mote == 0 else 'Unaware'}{{a{mote}}}" for mote in range(count))
    placing = ", ".join("{" + ", ".join(map(str, places)) + "}" for places in ranges)
    text = f"""\
ctrl Range = 1;
atomic ctrl Informed = 1;
atomic ctrl Unaware = 1;
atomic ctrl Asleep = 1;
big within = ([{{0, 1}}, {{0, 2}}, {{0}}], 3);
big before = share (Informed{{a}} || Unaware{{b}} || id) by within in (Range{{a}} || id(2, {{a, b}}));
big after = share (Informed{{a}} || Informed{{b}} || id) by within in (Range{{a}} || id(2, {{a, b}}));
react broadcast = before --> after;
react sleep = Informed{{a}} --> Asleep{{a}};
big ring =
  {" ".join(f"/{letter}" for letter in letters)} (
    share ({nodes})
    by ([{placing}], {count})
    in ({" | ".join(f"Range{{{letter}}}" for letter in letters)} | id{{{", ".join(letters)}}})
  );
begin brs
  init ring;
  rules = [ {{broadcast, sleep}} ];
end
"""
    unaware, informed, asleep = range(3)

    def steps(state: State) -> Iterator[State]:
        for mote, knows in enumerate(state):
            if knows == informed:
                yield (*state[:mote], asleep, *state[mote + 1 :])
                for near in ranges[mote]:
                    if state[near] == unaware:
                        yield (*state[:near], informed, *state[near + 1 :])

    def least(state: State) -> State:
        turned = [state[mote:] + state[:mote] for mote in range(count)]
        return min(each for way in turned for each in (way, way[::-1]))

    return _model(f"motes, {count} in a ring", text, (informed, *(unaware,) * (count - 1)), steps, least)


def _sorted(state: State) -> State:
    return tuple(sorted(state))


def _model(
    title: str,
    text: str,
    first: State,
    steps: Callable[[State], Iterable[State]],
    one_of: Callable[[State], State],
) -> Model:
    """Count what can be reached, each state told by one of those that cannot be told apart from it."""
    start = one_of(first)
    known, waiting, pairs = {start}, [start], 0
    for state in waiting:  # grows while it is walked
        after = {one_of(each) for each in steps(state)}
        pairs += len(after)
        waiting += sorted(after - known)
        known |= after
    return Model(title, text, len(known), pairs)


SHAPES = (
    batteries(3, 20),
    batteries(4, 12),
    agenda(8, 120),
    nest(2, 30),
    calls(8),
    motes(8),
)
"""A few of each family, which take BigraphER a second and more, but for the agenda."""
