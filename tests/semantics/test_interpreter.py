"""The kernel beside a naive interpreter, written from the page and not from the code, for a small language.

Its physical model is only where each entity is (the innermost place), its logical model two dictionaries, η a list per
agent. It knows the rules req_obs, sense, rcv_obs, req_ctr, actuate and env, under `program_order` and `control atomic`.
"""

import copy
from itertools import combinations

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from scale import examples
from small_missions import SHAPES, around, mission

from physical import point
from semantics.behaviours.expressions import Literal
from semantics.behaviours.patterns import Anything
from semantics.behaviours.statements import Case, ControlBy, Observe, React
from semantics.environment import Drifts
from semantics.state.configuration import Configuration
from semantics.state.initial import Beliefs
from semantics.state.physical_model import Placed
from semantics.state.requests import OBS, READY
from semantics.state.signature import REGION
from semantics.successors import successors

AROUND = {"base": REGION, "sea": REGION, "area": "sea"}
SPOTS = {"base": (37.11, -8.61), "sea": (36.95, -8.05), "area": (36.61, -8.61)}
NAMES = ("area", "base", "crate", "sea", "u0", "u1")
HOSTS = {"a": "u0", "b": "u1"}


class Naive:
    """A mutable mission of two agents on u0 and u1, with a crate that drifts."""

    def __init__(self, where, channels, parent, links, programs, missable):
        self.where = where
        self.channels = channels
        self.parent = parent
        self.links = links
        self.left = programs
        self.eta = {agent: [] for agent in HOSTS}
        self.missable = missable

    def contains(self, place, entity):
        """σ_P's contains, up the places around where the entity is; everything is in the region."""
        here = self.where.get(entity, AROUND.get(entity))
        while here not in (place, REGION):
            here = AROUND[here]
        return here == place

    def parent_in_fact(self, entity):
        return self.where[entity] if entity in self.where else AROUND[entity]

    def steps(self):
        """Return (label, what to do) for everything that is enabled."""
        found = []
        for agent in HOSTS:
            found += self.steps_of(agent)
        for place in ("base", "sea", "area"):
            if self.where["crate"] != place:
                found.append((f"⟨env : crate drifts to {place}⟩", ("drift", place)))
        return found

    def steps_of(self, agent):
        found, left, line = [], self.left[agent], self.eta[agent]
        if left and left[0] == ("observe",):
            found.append((f"⟨req_obs : {agent}, observe(CHILDREN(PARENT({HOSTS[agent]})))⟩", ("ask", agent)))
        if left and left[0] == ("react",) and any(each[0] == "READY" for each in line):
            ready = next(each for each in line if each[0] == "READY")
            found.append((f"⟨rcv_obs : {agent}, react({{{', '.join(ready[1])}}})⟩", ("receive", agent)))
        if left and left[0][0] == "control":
            found.append((f"⟨req_ctr : {agent}, control({left[0][1]} {left[0][2]})⟩", ("ask", agent)))
        waiting = [each for each in line if each[0] != "READY"]
        if waiting and waiting[0] == ("OBS",):
            for missed in self.misses(agent):
                missing = f", missing {', '.join(missed)}" if missed else ""
                label = f"⟨sense : OBS({agent}, CHILDREN(PARENT({HOSTS[agent]}))){missing}⟩"
                found.append((label, ("sense", agent, missed)))
        if waiting and waiting[0][0] == "CTR":
            _, command, target = waiting[0]
            label = f"⟨actuate : CTR({agent}, {command} {target})⟩"
            found += [(label, ("control", agent, way)) for way in self.ways(HOSTS[agent], command, target)]
        return found

    def misses(self, agent):
        """Return each set of entities that an answer can miss: any of those beside the host, but the host."""
        place = self.parent_in_fact(HOSTS[agent])
        beside = [name for name in sorted(self.missable) if self.parent_in_fact(name) == place]
        beside = [name for name in beside if name != HOSTS[agent]]
        return [some for size in range(len(beside) + 1) for some in combinations(beside, size)]

    def ways(self, host, command, target):
        """Return how a control can be done: the link it is about, or None for a move."""
        if host == target or self.parent[host] is None or self.parent[target] is None:
            return []
        if command == "MOVE_HOST_TO":
            believed = self.parent[host]
            return [None] if believed == REGION or self.contains(believed, host) else []
        shared = [c for c in sorted(self.links[target]) if c in self.channels[target]]
        if command == "CONNECT_HOST_TO":
            return shared
        return [c for c in shared if c in self.links[host] and c in self.channels[host]]

    def take(self, step):
        getattr(self, step[0])(*step[1:])

    def drift(self, place):
        self.where["crate"] = place

    def ask(self, agent):
        statement = self.left[agent].pop(0)
        self.eta[agent].append(("OBS",) if statement == ("observe",) else ("CTR", *statement[1:]))

    def receive(self, agent):
        self.left[agent].pop(0)
        self.eta[agent].remove(next(each for each in self.eta[agent] if each[0] == "READY"))

    def sense(self, agent, missed):
        place = self.parent_in_fact(HOSTS[agent])
        inside = {name for name in NAMES if self.parent_in_fact(name) == place} - set(missed)
        shown = tuple(sorted(inside | ({place} - {REGION})))
        pairs = tuple(sorted(f"parent({name}) = {place}" for name in inside))
        line = self.eta[agent]
        line[line.index(("OBS",))] = ("READY", shown, pairs)
        for name in NAMES:
            if name in inside:
                self.parent[name] = place
            elif self.parent[name] == place:
                self.parent[name] = REGION
        if place != REGION and self.parent[place] is None:
            self.parent[place] = REGION
        path = [place]
        while path[-1] != REGION and self.parent[path[-1]] not in (REGION, place):
            path.append(self.parent[path[-1]])
        if path[-1] != REGION and self.parent[path[-1]] == place:
            for name in set(path) - inside:
                self.parent[name] = REGION

    def control(self, agent, way):
        request = next(each for each in self.eta[agent] if each[0] == "CTR")
        self.eta[agent].remove(request)
        host, (_, command, target) = HOSTS[agent], request
        if command == "MOVE_HOST_TO":
            if self.parent[host] != target:
                self.parent[host] = self.where[host] = target
        elif command == "CONNECT_HOST_TO":
            self.links[host] = self.links[host] | {way}
            self.channels[host] = self.channels[host] | {way}
        else:
            self.links[host] = self.links[host] - {way}
            self.channels[host] = self.channels[host] - {way}

    def state(self):
        line = {agent: tuple(each) for agent, each in self.eta.items()}
        parts = (
            self.parent,
            self.links,
            {name: self.where[name] for name in self.where},
            self.channels,
            line,
        )
        return tuple(tuple(sorted(part.items())) for part in parts)


def kernel_state(c):
    """Return the same of a configuration of the kernel."""
    logical, physical = c.structure.logical, c.structure.physical
    line = {agent: tuple(shown(each.request) for each in c.eta.of(agent)) for agent in HOSTS}
    parts = (
        {name: logical.parent(name) for name in NAMES},
        {name: frozenset(logical.links(name)) for name in NAMES},
        {name: physical.abstract_parent(name) for name in ("crate", "u0", "u1")},
        {name: frozenset(physical.channels(name)) for name in NAMES},
        line,
    )
    return tuple(tuple(sorted(part.items())) for part in parts)


def shown(request):
    if isinstance(request, OBS):
        return ("OBS",)
    if isinstance(request, READY):
        seen = request.observation
        return ("READY", seen.shown, tuple(sorted(map(str, seen.relations))))
    return ("CTR", *str(request.reaction).split())


somewhere = st.sampled_from(["base", "sea", "area"])
controls = st.one_of(
    st.tuples(st.just("control"), st.just("MOVE_HOST_TO"), somewhere),
    st.tuples(
        st.just("control"),
        st.sampled_from(["CONNECT_HOST_TO", "DISCONNECT_HOST_FROM"]),
        st.sampled_from(["u0", "u1", "crate"]),
    ),
)
pieces = st.one_of(
    controls.map(lambda one: [one]), st.just([("observe",), ("react",)]), st.just([("observe",)])
)
programs = st.lists(pieces, max_size=4).map(lambda parts: [statement for part in parts for statement in part])
channel_sets = st.frozensets(st.sampled_from(["v", "w"]))


def statement_of(written):
    if written == ("observe",):
        return Observe(around())
    if written == ("react",):
        return React((Case(Anything("o", "observation"), None, ()),))
    return ControlBy(written[1], (Literal(written[2]),))


def forest(parents):
    """Tell whether what is believed is a forest of known nodes."""
    for name in parents:
        path, place = [name], parents[name]
        while place not in (None, REGION):
            if place in path or parents[place] is None:
                return False
            path.append(place)
            place = parents[place]
    return True


believed = st.fixed_dictionaries(
    {name: st.sampled_from([REGION, "base", "sea", "area", None]) for name in NAMES}
).filter(forest)


class Beside(RuleBasedStateMachine):
    """Both start in one mission, and take the same steps."""

    @initialize(
        where=st.fixed_dictionaries(dict.fromkeys(("crate", "u0", "u1"), somewhere)),
        channels=st.fixed_dictionaries(dict.fromkeys(("crate", "u0", "u1"), channel_sets)),
        belief=st.none() | believed,
        links=st.none() | st.fixed_dictionaries(dict.fromkeys(("u0", "u1"), channel_sets)),
        written=st.fixed_dictionaries(dict.fromkeys(HOSTS, programs)),
        missable=st.frozensets(st.sampled_from(["crate", "u0", "u1"])),
    )
    def start(self, where, channels, belief, links, written, missable):
        channels = {name: channels.get(name, frozenset()) for name in NAMES}
        parent = belief or AROUND | where
        believed_links = {
            name: frozenset() if parent[name] is None else (links or {}).get(name, channels[name])
            for name in NAMES
        }
        self.naive = Naive(
            dict(where), dict(channels), dict(parent), dict(believed_links), copy.deepcopy(written), missable
        )
        placements = tuple(Placed(point(*SPOTS[place])) for place in ("base", "sea", "area"))
        drift = Drifts("crate", placements, ("base", "sea", "area"), ((1, 2), (0, 2), (0, 1)), ())
        statements = [statement_of(each) for agent in HOSTS for each in written[agent]]
        first = len(written["a"])
        codes = {"a": tuple(range(first)), "b": tuple(range(first, len(statements)))}
        spots = dict(zip(("base", "sea", "area"), placements, strict=True))
        offset = {"u0": 0.001, "u1": 0.002}
        placed = {
            name: spots[place]
            if name == "crate"
            else Placed(point(SPOTS[place][0] + offset[name], SPOTS[place][1]))
            for name, place in where.items()
        }
        self.kernel = mission(
            NAMES,
            statements,
            {agent: (host, codes[agent]) for agent, host in HOSTS.items()},
            channels=channels,
            placed=placed | {name: SHAPES[name] for name in ("base", "sea", "area")},
            beliefs=Beliefs(parent, believed_links),
            environment=(drift,),
        )
        setting = self.kernel.setting.with_(missable=tuple(sorted(missable)))
        self.kernel = Configuration(setting, self.kernel.state)
        self.begun = True

    @precondition(lambda self: hasattr(self, "begun"))
    @rule(number=st.integers(0, 20))
    def step(self, number):
        steps = self.naive.steps()
        label, step = steps[number % len(steps)]
        self.naive.take(step)
        same = [t.target for t in successors(self.kernel) if str(t.label) == label]
        ends = [target for target in same if kernel_state(target) == self.naive.state()]
        assert ends, f"{label} ends otherwise"
        self.kernel = ends[0]

    @precondition(lambda self: hasattr(self, "begun"))
    @invariant()
    def both_are_in_the_same_state_and_allow_the_same(self):
        assert kernel_state(self.kernel) == self.naive.state()
        by_kernel = {(str(t.label), kernel_state(t.target)) for t in successors(self.kernel)}
        assert by_kernel == {(label, self.after(step)) for label, step in self.naive.steps()}

    def after(self, step):
        trial = copy.deepcopy(self.naive)
        trial.take(step)
        return trial.state()


TestTheKernelBesideANaiveInterpreter = Beside.TestCase
TestTheKernelBesideANaiveInterpreter.settings = examples(75, stateful_step_count=15)
