"""What a control depends on, told by running one bigActor's text again with another answer: no monitor is asked.

A `Script` is a tree of its own, which writes itself as a mission; `Run` executes it naively. `rests_on` asks of each
answer that was used before a control: with it the other way, and all else that was seen and said the same, does the
bigActor surely come to the same control with the same arguments? What only the other run sees may be anything, and
nothing more is said in it. What one turn of a loop tested is not held against its later turns.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from random import Random

THINGS = tuple(f"t{number}" for number in range(24))
PLACES = ("p1", "p2")
WORLD = (
    """
signature { kind Place contains Thing, UAV kind UAV driven kind Thing }
world {
  p0: Place = box (0.0, 0.0) (0.1, 0.1)
  p1: Place = box (0.0, 0.2) (0.1, 0.3)
  p2: Place = box (0.0, 0.4) (0.1, 0.5)
  full: Place = box (0.2, 0.0) (0.3, 0.1)
  bare: Place = box (0.2, 0.2) (0.3, 0.3)
  u0: UAV = point (0.05, 0.05)
"""
    + "".join(f"  {name}: Thing = point (0.25, {0.01 + 0.003 * n})\n" for n, name in enumerate(THINGS))
    + "}\n"
)
"""All things are in one place, another one is empty, and u0 is in neither."""

MEMBERS = "members"
MOST_STEPS, MOST_RUNS = 120, 400


@dataclass(frozen=True)
class Test:
    """Whether an observation shows a thing, or not; of a variable whether it is true."""

    variable: str
    thing: str = ""
    negated: bool = False

    def __str__(self) -> str:
        asked = f"{self.thing} in {self.variable}" if self.thing else self.variable
        return f"not ({asked})" if self.negated else asked


@dataclass(frozen=True)
class Node:
    """One statement: its kind, its number, and what the kind needs."""

    kind: str
    number: int
    word: str = ""
    test: Test | None = None
    blocks: tuple[tuple["Node", ...], ...] = ()

    def __str__(self) -> str:
        first, second = [*(" ".join(map(str, block)) or "skip" for block in self.blocks), "", ""][:2]
        return FORMS[self.kind].format(
            n=self.number, word=self.word, test=self.test, first=first, second=second
        )


LOOKS = "observe(CHILDREN({word})) react {{"
FORMS = {
    "control": "control(MOVE_HOST_TO {word})",
    "look": LOOKS + " case o{n}: Observation => {first} }}",
    "guard": LOOKS + " case o{n}: Observation if {test} => {first} case _: Observation => {second} }}",
    "await": LOOKS + " case o{n}: Observation if {test} => {first} }}",
    "ask": "if {test} {{ observe(CHILDREN({word})) }} react {{ case _: Observation => {first} }}",
    "if": "if {test} {{ {first} }} else {{ {second} }}",
    "match": "match 0 {{ case n{n} if {test} => {first} case _ => {second} }}",
    "for": "for x{n} in {word} of Thing {{ {first} }}",
    "loop": "loop {{ {first} }}",
    "while": "while {test} {{ {first} }}",
    "set": "{word} = {test}",
    "aim": "aim = {word}",
    "call": "{word}()",
    "hear": 'react {{ case "go" => skip }}',
    "never": 'react {{ case "never" => skip }}',
}
"""How each kind of statement is written."""


@dataclass(frozen=True)
class Script:
    """A program: its behaviours by name, and its body."""

    behaviours: dict[str, tuple[Node, ...]]
    body: tuple[Node, ...]

    def text(self) -> str:
        behaviours = (
            f"def {name}() = {{ {' '.join(map(str, b))} }}\n" for name, b in self.behaviours.items()
        )
        body = f"let w0 = true let aim = p1 {' '.join(map(str, self.body))} control(MOVE_HOST_TO aim)"
        heard = 'environment { someone says "go" to a at most 9 times }\n'
        return f"{''.join(behaviours)}BigActor a hosted_at u0 with_behavior {{ {body} }}\n{heard}"


class Writer:
    """Writes a script; each test of the text asks for a thing of its own."""

    def __init__(self, random: Random, assigns: bool) -> None:
        self.random, self.assigns, self.number = random, assigns, 0
        self.behaviours: dict[str, tuple[Node, ...]] = {}
        self.things = iter(THINGS)

    def script(self) -> Script:
        if self.random.random() < 0.4:
            assigns, self.assigns = self.assigns, False  # a behaviour has no variables of who calls it
            self.behaviours = {"helper": self.block((), 2)}
            self.assigns = assigns
        return Script(self.behaviours, self.block((), 3, least=1))

    def next(self) -> int:
        self.number += 1
        return self.number

    def test(self, seen: tuple[str, ...]) -> Test:
        return Test(self.random.choice(seen), next(self.things), self.random.random() < 0.5)

    def block(self, seen: tuple[str, ...], depth: int, least: int = 0) -> tuple[Node, ...]:
        return tuple(self.node(seen, depth) for _ in range(self.random.randint(least, 2)))

    def node(self, seen: tuple[str, ...], depth: int) -> Node:
        kinds = ["control"] * 4 + (["hear", "never"] if seen else [])
        if depth:
            kinds += [
                "look",
                "look",
                "look",
                "guard",
                "await",
                "loop",
                *(["call"] if self.behaviours else []),
            ]
            kinds += ["if", "if", "match", "for", "ask"] if seen else []
            kinds += ["while"] if self.assigns else []
        kinds += ["set", "aim"] if seen and self.assigns else []
        kind, number = self.random.choice(kinds), self.next()
        place = self.random.choice(["full", "bare"])
        if kind in ("look", "guard", "await"):
            inside = (*seen, f"o{number}")
            test = None if kind == "look" else self.test(inside[-1:])
            first = self.block(inside, depth - 1, least=kind == "look")
            return Node(kind, number, place, test, (first, self.block(seen, depth - 1)))
        if kind == "set":
            return Node(kind, number, "w0", self.test(seen))
        if kind == "while":
            return Node(kind, number, "", Test("w0"), ((self.settled(), *self.block(seen, depth - 1)),))
        words = {
            "control": self.random.choice([*PLACES, *(["aim"] if self.assigns else [])]),
            "aim": "p2",
            "call": "helper",
            "ask": place,
        }
        words["for"] = self.random.choice(seen or ("",))
        test = self.test(seen) if kind in ("if", "match", "ask") else None
        if kind == "loop":
            first: tuple[Node, ...] = (
                Node("look", self.next(), place, None, ((),)),
                *self.block(seen, depth - 1),
            )
            return Node(kind, number, "", None, (first,))
        blocks = (self.block(seen, depth - 1), self.block(seen, depth - 1)) if depth else ((), ())
        return Node(kind, number, words.get(kind, ""), test, blocks)

    def settled(self) -> Node:
        """Return a look that sets what a `while` tests."""
        number = self.next()
        sets = Node("set", self.next(), "w0", self.test((f"o{number}",)))
        return Node("look", number, self.random.choice(["full", "bare"]), None, ((sets,),))


# --- running it -----------------------------------------------------------------------------------------------

Path = tuple[tuple[str, int], ...]
"""Where a step is taken: through which statements, branches and turns of loops."""

Use = tuple[Path, str, str]
"""An answer that was used: of which observation, of which place, about which thing (or `MEMBERS`)."""


class Blocked(Exception):
    """The bigActor waits for ever, or loops without end."""


@dataclass
class Run:
    """One run of a script.

    Attributes:
        flipped: The one answer that is another.
        known: What an earlier run has seen and heard: all else may be anything, and is not said. None in the first run.
        forgets: Whether tests inside of the statement with the flipped answer may turn out in any way.
        choices: How what may be anything turns out, one after the other.
        controls: Where it asked for which control.
        uses: The answers that it used, where, in order; each with how many controls came before.
    """

    script: Script
    flipped: Use | None = None
    known: frozenset[Path] | None = None
    forgets: bool = False
    choices: list[int] = field(default_factory=list)
    drawn: int = 0
    steps: int = 0
    inside: Path | None = None
    controls: list[tuple[Path, str]] = field(default_factory=list)
    uses: list[tuple[Use, Path, int]] = field(default_factory=list)
    met: set[Path] = field(default_factory=set)
    store: dict[str, object] = field(default_factory=lambda: {"w0": True, "aim": "p1"})

    def go(self) -> "Run":
        try:
            self.block(self.script.body, ())
            self.controls.append(((("end", 0),), str(self.store["aim"])))
        except Blocked:
            pass
        return self

    def draw(self) -> int:
        if self.drawn == len(self.choices):
            self.choices.append(0)
        self.drawn += 1
        return self.choices[self.drawn - 1]

    def answer(self, use: Use, at: Path) -> int:
        """Return what an observation answers: whether it shows a thing, or how many things it shows."""
        self.uses.append((use, at, len(self.controls)))
        seen, place, thing = use
        known = self.known is None or seen in self.known
        shown = {"full": len(THINGS) if thing == MEMBERS else 1, "bare": 0}[place]
        if use == self.flipped and self.inside is None:
            self.inside = at
        if use == self.flipped and thing != MEMBERS:
            return 1 - shown
        free = self.forgets and self.inside is not None and at[: len(self.inside)] == self.inside
        if known and use != self.flipped and not free:
            return shown
        return (0, 2, 1)[self.draw() % 3] if thing == MEMBERS else self.draw() % 2

    def holds(self, test: Test, at: Path) -> bool:
        value = self.store[test.variable]
        if test.thing:
            assert isinstance(value, tuple)
            value = bool(self.answer((*value, test.thing), at))
        return bool(value) is not test.negated

    def block(self, nodes: tuple[Node, ...], at: Path) -> None:
        for node in nodes:
            self.steps += 1
            if self.steps > MOST_STEPS:
                raise Blocked
            self.take(node, (*at, (node.kind, node.number)))

    def take(self, node: Node, at: Path) -> None:  # noqa: PLR0912  # one case for each kind
        seen = f"o{node.number}"
        match node.kind:
            case "control":
                self.controls.append((at, str(self.store["aim"]) if node.word == "aim" else node.word))
            case "look":
                self.see(node, at)
                self.block(node.blocks[0], at)
            case "guard" | "await" | "if" | "match":
                if node.kind not in ("if", "match"):
                    self.see(node, at)
                assert node.test is not None
                way = 0 if self.holds(node.test, at) else 1
                if way and node.kind == "await":
                    raise Blocked
                self.block(node.blocks[way], (*at, ("way", way)))
            case "ask":
                assert node.test is not None
                if not self.holds(node.test, at):
                    raise Blocked
                self.met.add(at)
                self.block(node.blocks[0], at)
            case "for":
                seen = self.store[node.word]
                assert isinstance(seen, tuple)
                for turn in range(self.answer((*seen, MEMBERS), at)):
                    self.block(node.blocks[0], (*at, ("turn", turn)))
            case "loop" | "while":
                turn = 0
                while node.kind == "loop" or self.store["w0"]:
                    self.block(node.blocks[0], (*at, ("turn", turn)))
                    turn += 1
            case "set":
                assert node.test is not None
                self.store["w0"] = self.holds(node.test, at)
            case "aim":
                self.store["aim"] = node.word
            case "call":
                self.block(self.script.behaviours[node.word], at)
            case "hear":
                self.met.add(at)
                if self.known is not None and at not in self.known:
                    raise Blocked
            case _:
                raise Blocked

    def see(self, node: Node, at: Path) -> None:
        self.met.add(at)
        self.store[f"o{node.number}"] = (at, node.word)


def rests_on(first: Run, rank: int, *, forgets: bool = False) -> frozenset[tuple[str, str]]:
    """Return the answers, by place and thing, that decided that a run came to its control of this rank.

    With `forgets`, those that decide it where the text alone counts: a way may block if any of its tests lets it.
    """
    goal = first.controls[rank]
    used = {use: at for use, at, before in first.uses if before <= rank and not _earlier_turn(at, goal[0])}
    deciding = (use for use in used if not all(goal in run.controls for run in others(first, use, forgets)))
    return frozenset((place, thing) for _, place, thing in deciding)


def others(first: Run, flipped: Use, forgets: bool) -> Iterator[Run]:
    """Yield the runs that follow if one answer is another, each way in which what is not known may turn out."""
    choices: list[int] | None = []
    for _ in range(MOST_RUNS):
        if choices is None:
            return
        run = Run(first.script, flipped, frozenset(first.met), forgets, choices).go()
        yield run
        choices = _following(run.choices[: run.drawn])


def _following(choices: list[int]) -> list[int] | None:
    while choices and choices[-1] == 2:
        choices = choices[:-1]
    return [*choices[:-1], choices[-1] + 1] if choices else None


def _earlier_turn(test: Path, control: Path) -> bool:
    for one, other in zip(test, control, strict=False):
        if one != other:
            return one[0] == other[0] == "turn" and one[1] < other[1]
    return False
