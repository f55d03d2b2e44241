"""Stale-observation races as semantics.md defines them, told from one run: a judge that is not the monitor.

A run is kept whole: the world before and after each step, who took it, and what each line of the text had asked, tested
and sent. Nothing is forgotten and nothing is merged. Missions are of lines that stand for themselves, so that what a
control depends on is read off the lines; tests are of the form `name in o` or `size(o) < 3`.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from hypothesis import strategies as st

from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import CTR, FLY

HOSTS = {"a": "uav0", "b": "uav1", "c": "uav0", "d": "gcs0"}
DRIVERS = tuple(f"control(MOVE_HOST_TO {place})" for place in ("gate0", "gate0", "north0", "south0"))
PILOTS = tuple(
    f"control({each})" for each in ("MOVE uav0 TO gate0", "MOVE uav0 TO south0", "HAND uav0 TO gcs1")
)
MOVES = dict.fromkeys("abc", DRIVERS) | {"d": PILOTS}
QUERIES = (
    "CHILDREN(gate0)",
    "CHILDREN(PARENT(HOST))",
    "CHILDREN(PARENT(uav1))",
    "PARENT(uav1)",
    "LINKED_TO(uav0)",
    "LINKED_TO(uav1)",
)
NAMES = ("uav0", "uav0", "uav1", "uav1", "vessel0", "gate0", "", "")
"""Whom a line asks for; empty where it asks how many there are."""

TELLING = ("tested", "told", "reported", "reported", "kept", "impatient")
WAYS = (*TELLING, "bare", "woken", "heard", "trusted", "trusted", "relayed", "relayed")
"""How an agent comes to a control, or lets another know; the first tells most."""

MOVING = frozenset({"command", "commit", "actuate"})


@dataclass(frozen=True)
class Line:
    """One line of an agent's text: what it does, and with what."""

    way: str
    control: str
    query: str = ""
    name: str = ""
    to: str = ""
    second: str = ""

    def text(self, number: int) -> str:
        test = f"{self.name} in o" if self.name else "size(o) < 3"
        match self.way:
            case "bare":
                return self.control
            case "tested":
                return self.looking(
                    f"case o: Observation if {test} => {self.control} case o: Observation => skip"
                )
            case "impatient":
                return self.looking(f"case o: Observation if {test} => skip after 5 s => {self.control}")
            case "told":
                send = f'send(("go", {number}), {self.to})'
                return self.looking(f"case o: Observation if {test} => {send} case o: Observation => skip")
            case "reported":
                send = f'send(("seen", {number}, {test}), {self.to})'
                return self.looking(f"case o: Observation => {self.control} {send}")
            case "kept":
                send = f'send(("seen", {number}, k), {self.to})'
                return self.looking(
                    f"case o: Observation => let k = {test} {self.control} if k {{ {self.second} }} {send}"
                )
            case "woken":
                return f"react {{ case m: Message => {self.control} }}"
            case "relayed":
                send = f'send(("seen", {number}, x), {self.to})'
                return f"react {{ case (w, n, x) => {send} case m: Message => skip }}"
            case "heard":
                return f"react {{ case (w, n) => {self.control} case m: Message => skip }}"
            case _:
                return f"react {{ case (w, n, x) if not x => {self.control} case m: Message => skip }}"

    def looking(self, cases: str) -> str:
        return f"observe({self.query}) react {{ {cases} }}"


@st.composite
def companies(draw) -> dict[str, list[Line]]:
    """Yield two or three agents of one to three lines each."""
    agents = draw(st.sampled_from(["ab", "abc", "abd"]))
    company = {}
    for agent in agents:
        lines = [
            draw(lines_of(agent, WAYS if rank or agent != "a" else TELLING, agents.replace(agent, "")))
            for rank in range(draw(st.integers(1, 3)))
        ]
        company[agent] = lines
    return company


@st.composite
def lines_of(draw, agent: str, ways: tuple[str, ...], others: str, names: tuple[str, ...] = NAMES) -> Line:
    """Yield a line of an agent, which comes to a control in one of some ways, or tells one of some others."""
    first, second = (draw(st.sampled_from(MOVES[agent])) for _ in range(2))
    query, name = draw(st.sampled_from(QUERIES)), draw(st.sampled_from(names))
    return Line(
        draw(st.sampled_from(ways)), first, query, name, draw(st.sampled_from(others or agent)), second
    )


@st.composite
def chains(draw) -> dict[str, list[Line]]:
    """Yield agents of which the first tells what it saw, the last trusts it, and each moves when it likes.

    What is told is often about one of them, so that who hands it on has changed it meanwhile.
    """
    agents = "".join(draw(st.permutations("abcd")))[: draw(st.integers(2, 3))]
    names = tuple(HOSTS[agent] for agent in agents)
    company = {}
    for rank, agent in enumerate(agents):
        others = agents[rank + 1 : rank + 2]
        ways = ("relayed",) if rank and others else ("reported", "kept") if others else ("trusted",)
        line, moves = lines_of(agent, ways, others, names), lines_of(agent, ("bare",), others)
        before, after = (draw(st.lists(moves, max_size=1)) for _ in range(2))
        company[agent] = [*before, draw(line), *after]
    return company


def text_of(company: dict[str, list[Line]], first: int) -> str:
    """Return the text of a mission that begins on some line; each `Line` is on one of its own."""
    rows: list[str] = []
    for agent, lines in company.items():
        rows.append(f"BigActor {agent} hosted_at {HOSTS[agent]} with_behavior {{")
        rows += [line.text(first + len(rows) + rank) for rank, line in enumerate(lines)]
        rows.append("}")
    return "\n".join(rows) + "\n"


# --- the judge ------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class World:
    """A(P), slot by slot."""

    parents: dict[str, str]
    links: dict[str, frozenset[str]]

    @staticmethod
    def of(c: Configuration) -> "World":
        physical = c.structure.physical
        names = physical.entities()
        return World(
            {name: physical.abstract_parent(name) for name in names},
            {name: frozenset(physical.links(name)) for name in names},
        )

    def slot(self, slot: tuple[str, str]) -> object:
        return (self.parents if slot[0] == "parent" else self.links).get(slot[1])


@dataclass(frozen=True)
class Test:
    """`name in o`, or `size(o)`, of an observation.

    Attributes:
        at: When it was sensed.
        operator: The outermost operator of its query.
        around: Whose parent it was applied to, if it was.
        node: What it was applied to otherwise.
        name: The name asked for; empty where the number is.
        holders: Who held it from when on.
        by_value: Of each time that it was handed on, whether as what a value was computed from.
    """

    at: int
    operator: str
    around: str | None
    node: str
    name: str
    holders: tuple[tuple[int, str], ...]
    by_value: tuple[bool, ...] = ()

    def handed(self, time: int, to: str, by_value: bool) -> "Test":
        return replace(self, holders=(*self.holders, (time, to)), by_value=(*self.by_value, by_value))

    def concerns(self, change: "Change") -> bool:
        """Tell whether a change is another's doing to who holds the test in the end, and nobody has answered for it.

        An agent answers for its own doing by what it does or has others do, but by no value that it hands on.
        """
        return change.author not in {who for who, by_value in self.hands_after(change) if not by_value}

    def is_own(self, change: "Change") -> bool:
        """Tell whether a change was made by one who held the test then or later."""
        return change.author in {who for who, _ in self.hands_after(change)}

    def is_holders(self, change: "Change") -> bool:
        """Tell whether a change was made by who held the test then."""
        return change.author == self.hands_after(change)[0][0]

    def hands_after(self, change: "Change") -> list[tuple[str, bool]]:
        """Return who held the test from a change on, each with whether it handed on a value of it."""
        rank = max(rank for rank, (since, _) in enumerate(self.holders) if since <= change.time)
        return list(zip([who for _, who in self.holders], (*self.by_value, False), strict=True))[rank:]

    def answer(self, world: World, node: str) -> int:
        asked = [self.name] if self.name else sorted(world.parents)
        return sum(self.shows(name, world, node) for name in asked)

    def shows(self, name: str, world: World, node: str) -> bool:
        match self.operator:
            case "CHILDREN":
                return name == node or world.parents.get(name) == node
            case "PARENT":
                return world.parents.get(node) == name
            case _:
                return name == node or bool(world.links[node] & world.links.get(name, frozenset()))


@dataclass(frozen=True)
class Change:
    """A control that was served."""

    time: int
    author: str
    before: World
    after: World


@dataclass
class Judge:
    """Watches a run, and tells of each control that is served whether it is a stale-observation race."""

    company: dict[str, list[Line]]
    first: int
    time: int = 0
    changes: list[Change] = field(default_factory=list)
    asked: dict[str, list[tuple[int, frozenset[Test]]]] = field(default_factory=dict)
    """What waits to be sensed, and under which tests it was asked for."""
    ready: dict[str, list[Test]] = field(default_factory=dict)
    """What was sensed and not received yet; nobody has asked anything of it."""
    seen: dict[str, Test] = field(default_factory=dict)
    """What was received last, and what its line asks of it."""
    passed: dict[str, frozenset[Test]] = field(default_factory=dict)
    """What had to be so for an agent to come to the line where it is."""
    inside: dict[str, tuple[int, frozenset[Test]]] = field(default_factory=dict)
    """The line that an agent is on, with what the case that it is in depends on."""
    controls: dict[str, list[frozenset[Test]]] = field(default_factory=dict)
    messages: dict[str, frozenset[Test]] = field(default_factory=dict)
    received: dict[str, frozenset[Test]] = field(default_factory=dict)
    moved: set[tuple[str, int]] = field(default_factory=set)
    """Who has asked for the first control of which line."""

    def line(self, number: int) -> Line:
        rows: dict[int, Line] = {}
        at = self.first
        for lines in self.company.values():
            rows |= {at + 1 + rank: each for rank, each in enumerate(lines)}
            at += len(lines) + 2
        return rows[number]

    def races(self, t: Transition) -> set[tuple[int, int]]:
        """Return what a served control rests on that others have changed: when it was sensed, and when changed."""
        assert t.served is not None
        request = t.served.request
        assert isinstance(request, CTR | FLY)
        tests = self.controls[request.agent][0]
        used = slots_of(str(request.reaction), HOSTS[request.agent])
        return {(test.at, change.time) for test in tests for change in self.changed(test, used)}

    def changed(self, test: Test, used: frozenset[tuple[str, str]]) -> Iterator[Change]:
        """Yield the changes that each make a test stale."""
        node = test.node
        for change in self.changes:
            if change.time <= test.at:
                continue
            led = node
            if test.around is not None and differs(change, ("parent", test.around)):
                led = change.after.parents[test.around]
            flips = test.answer(change.before, node) != test.answer(change.after, led)
            touches = any(differs(change, slot) for slot in used)
            if (flips and test.concerns(change)) or (touches and not test.is_own(change)):
                yield change
            if not test.is_holders(change):
                node = led

    def take(self, before: Configuration, t: Transition) -> None:
        """Watch one step of the run."""
        self.time += 1
        agent = t.label.agent
        assert agent is not None
        rule = t.label.rule
        if rule in MOVING:
            self.changes.append(Change(self.time, agent, World.of(before), World.of(t.target)))
            if rule != "command":
                self.controls[agent].pop(0)
            return
        if rule == "sense":
            number, _ = self.asked[agent].pop(0)
            self.ready.setdefault(agent, []).append(self.test(before, agent, self.line(number)))
            return
        if rule == "snd":
            return
        number = before.setting.program.line(before.alpha.code(agent)[0])
        if self.inside.get(agent, (0, frozenset()))[0] != number:
            self.inside[agent] = (number, self.passed.get(agent, frozenset()))
        here = self.inside[agent][1]
        line = self.line(number)
        if rule == "req_obs":
            self.asked.setdefault(agent, []).append((number, here))
        elif rule == "rcv_obs":
            self.seen[agent] = replace(self.ready[agent].pop(0), name=line.name)
            tests = {self.seen[agent]} if line.way in ("tested", "told") else set()
            self.inside[agent] = (number, here | tests)
        elif rule == "timeout":
            refused = {replace(each, name=line.name) for each in self.ready.get(agent, [])[:1]}
            self.inside[agent] = (number, here | refused)
        elif rule == "rcv_msg":
            self.receive(agent, number, line, str(t.label))
        elif rule == "req_ctr":
            self.controls.setdefault(agent, []).append(here | self.kept(agent, number, line))
        elif rule == "req_snd":
            self.send(agent, number, line, here)

    def kept(self, agent: str, number: int, line: Line) -> frozenset[Test]:
        """Return what the second control of a line is decided by, which comes after the first."""
        if line.way != "kept":
            return frozenset()
        if (agent, number) in self.moved:
            return frozenset({self.seen[agent]})
        self.moved.add((agent, number))
        return frozenset()

    def test(self, c: Configuration, agent: str, line: Line) -> Test:
        operator, _, inner = line.query.partition("(")
        name = inner.strip("()").replace("PARENT(", "").replace("HOST", HOSTS[agent])
        around = name if "PARENT" in inner else None
        node = World.of(c).parents[name] if around is not None else name
        return Test(self.time, operator, around, node, line.name, ((0, agent),))

    def send(self, agent: str, number: int, line: Line, here: frozenset[Test]) -> None:
        tests = {each.handed(self.time, line.to, by_value=False) for each in here}
        if line.way in ("reported", "kept"):
            tests.add(self.seen[agent].handed(self.time, line.to, by_value=True))
        if line.way == "relayed":
            values = (each for each in self.received[agent] if each.by_value[-1])
            tests |= {each.handed(self.time, line.to, by_value=True) for each in values}
        self.messages[str(number)] = frozenset(tests)

    def receive(self, agent: str, number: int, line: Line, label: str) -> None:
        tests = next(tests for key, tests in self.messages.items() if f", {key}" in label)
        self.received[agent] = tests
        if line.way == "woken":
            tests = frozenset(each for each in tests if not each.by_value[-1])
        self.passed[agent] = self.passed.get(agent, frozenset()) | tests
        self.inside[agent] = (number, self.inside[agent][1] | tests)


def differs(change: Change, slot: tuple[str, str]) -> bool:
    return change.before.slot(slot) != change.after.slot(slot)


def slots_of(reaction: str, host: str) -> frozenset[tuple[str, str]]:
    """Return the slots that a control uses: where what is moved is, and on which links it and its stations are."""
    words = reaction.split()
    if words[0] == "MOVE_HOST_TO":
        return frozenset({("parent", host)})
    links = frozenset({("links", words[1]), ("links", host)})
    return links | {("links", words[3]) if words[0] == "HAND" else ("parent", words[1])}
