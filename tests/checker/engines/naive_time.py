"""A naive interpreter of timed missions, from the text of time.md: parts of a tick, and every clock by its name.

It shares with the checker what `semantics.successors` says of a configuration, and how long a flight takes.
"""

from collections import Counter, deque
from math import ceil, floor, inf

import networkx as nx

from semantics.environment import Drops, Leaves
from semantics.properties.propositions import holds
from semantics.state.physical_model import InTransit
from semantics.state.requests import CTR, FLY, MGR, OBS, SND
from semantics.successors import by_clause, expand
from semantics.timing.flight_times import aim, interval_of_flight
from semantics.timing.timing import Every, Sayable, Window

PARTS = 3
"""Of a tick: time passes in such steps here."""


class TooLarge(Exception):
    pass


class Naive:
    """The states that a mission reaches, and what leads from one to another; `delay` takes a part of a tick."""

    def __init__(self, c0, most=4000):
        self.timing = c0.setting.timing
        self.environment = c0.setting.environment
        self.known = {}
        self.graph = nx.MultiDiGraph()
        self.start = (c0, self.clocks_at_first(c0))
        self.graph.add_node(self.start)
        waiting = deque([self.start])
        while waiting:
            state = waiting.popleft()
            for delay, after in self.successors(*state):
                if after not in self.graph:
                    waiting.append(after)
                    if len(self.graph) > most:
                        raise TooLarge
                self.graph.add_edge(state, after, delay=delay)

    # --- what the text says of a configuration

    def look(self, c):
        if c in self.known:
            return self.known[c]
        e = expand(c)
        doable = []  # transition, keys of the clocks, whether in turn
        for t in (*e.by_agents, *e.out_of_turn):
            a = t.label.agent
            if t.served is None:
                keys = [("after", a) if t.label.rule == "timeout" else ("agent", a, t.label.rule == "spawn")]
            else:
                keys = [("request", t.served.request, way) for way in self.ways(c, t.served.request)]
            doable.append((t, keys, t in e.by_agents))
        clauses = [list(by_clause(c, clause)) for clause in self.environment]
        for i, transitions in enumerate(clauses):
            for t in transitions:
                clause = self.environment[i]
                back = isinstance(clause, Drops | Leaves) and " returns" in str(t.label.about)
                doable.append((t, [("back" if back else "clause", i)], True))
        served = {t.served.request for t in e.enabled if t.served is not None}
        enabled = Counter(key for _, keys, _ in doable for key in keys if key[0] != "request")
        for key in enabled:
            enabled[key] = 1
        for a in c.alpha.names():
            for p in c.eta.in_line(a):
                if p.request in served:
                    enabled.update(("request", p.request, way) for way in self.ways(c, p.request))
        flights = {p.request for p in c.eta.all() if isinstance(p.request, FLY)}
        self.known[c] = doable, enabled, clauses, flights
        return self.known[c]

    def ways(self, c, request):
        if not isinstance(request, SND):
            return [""]
        here, there = c.alpha.host(request.agent), c.alpha.host(request.to)
        if here == there:
            return [""]
        links = set(c.structure.logical.links(here)) & set(c.structure.logical.links(there))
        connected = c.structure.physical.connected
        return sorted(each for each in links if connected(each, here) and connected(each, there))

    def interval(self, c, key):
        timing, infinite = self.timing, (0, inf)
        match key:
            case ("agent", _, True):
                return self.said(timing.command("spawn"))
            case ("agent", *_):
                return self.said(timing.react)
            case ("back", i):
                returns = timing.clauses[i].returns if timing.clauses else None
                return infinite if returns is None else (0, returns)
            case ("request", OBS(), _):
                return self.said(timing.sense)
            case ("request", SND(), way):
                return self.said(dict(timing.messages).get(way))
            case ("request", MGR(), _):
                return self.said(timing.command("migrate"))
            case ("request", CTR() as request, _):
                word = request.reaction.text.split()[0].split("(")[0]
                served = (t for t, *_ in self.look(c)[0] if t.served is not None)
                rules = {t.label.rule for t in served if t.served.request == request}
                taken_up = rules == {"command"} or word in ("MOVE", "MOVE_HOST_TO")
                return self.said(timing.command(word) or (timing.react if taken_up else None))
            case ("request", FLY() as fly, _):
                lo, hi = self.said(interval_of_flight(c, fly))
                if lo > self.CAP or self.CAP < hi < inf:  # clocks are not counted so far here
                    raise TooLarge
                return lo, hi
            case _:
                return infinite

    def said(self, interval):
        return (0, inf) if interval is None else (interval.lo, inf if interval.hi is None else interval.hi)

    # --- clocks

    CAP = 12

    def clocks_at_first(self, c):
        _, enabled, _, flights = self.look(c)
        clocks = {key: (0,) * count for key, count in enabled.items()}
        clocks |= {("flown", fly): (0,) for fly in flights}
        clocks["mission",] = (0,)
        for i, times in enumerate(self.timing.clauses):
            if isinstance(times.step, Every):
                clocks["every", i] = (self.CAP * PARTS,)
        for u, endurance in self.timing.endurances:
            clocks["aloft", u] = (0,)
            if self.restored(c, u, endurance):
                clocks["restored", u] = (self.CAP * PARTS,)
        return self.frozen(c, self.windows(c, clocks))

    def restored(self, c, u, endurance):
        physical, place = c.structure.physical, u
        while place in physical and not isinstance(physical.placement(place), InTransit):
            place = physical.abstract_parent(place)
            if place in endurance.places:
                return True
        return False

    def windows(self, c, clocks):
        _, _, clauses, _ = self.look(c)
        for i, times in enumerate(self.timing.clauses):
            if isinstance(times.step, Window) and clauses[i] and ("free", i) not in clocks:
                late = times.step.within is not None and clocks["mission",][0] > times.step.within * PARTS
                if late and ("due", i) not in clocks:
                    clocks["free", i] = (0,)
                elif ("due", i) not in clocks:
                    clocks["due", i] = (0,)
        return clocks

    def frozen(self, c, clocks):
        """Count clocks as far as it matters."""

        def most(key):
            if key[0] in ("free", "due", "clause"):
                return 0
            if key[0] in ("agent", "back") or (key[0] == "request" and not isinstance(key[1], FLY)):
                lo, hi = self.interval(c, key)
                return max(lo, 0 if hi == inf else hi)
            if key[0] == "mission":
                steps = [t.step for t in self.timing.clauses]
                bounds = [b for s in steps if isinstance(s, Window) for b in (s.after, s.within or 0)]
                bounds += [b for s in steps if isinstance(s, Sayable) for b in (s.after, s.until or 0)]
                return max(bounds, default=-1) + 1
            if key[0] == "every":
                return self.timing.clauses[key[1]].step.least
            if key[0] in ("aloft", "restored"):
                endurance = dict(self.timing.endurances)[key[1]]
                return (endurance.lasts if key[0] == "aloft" else endurance.after) + 1
            return self.CAP

        return frozenset(
            (key, tuple(min(a, most(key) * PARTS) for a in ages)) for key, ages in clocks.items()
        )

    def successors(self, c, frozen):
        doable, _, _, _ = self.look(c)
        clocks = dict(frozen)
        passing = True
        for t, keys, in_turn in doable:
            if not in_turn:
                continue
            may, must = self.due(c, keys, clocks)
            passing = passing and not must
            if may:
                for after in self.after(c, keys, t, clocks):
                    yield 0, (t.target, after)
        if passing:
            still = {"due", "free"}
            later = {
                key: ages if key[0] in still else tuple(a + 1 for a in ages) for key, ages in clocks.items()
            }
            yield 1, (c, self.frozen(c, later))

    def due(self, c, keys, clocks):
        """Return whether a step may be taken, and whether it must be before time passes."""
        now = clocks["mission",][0]
        match keys[0]:
            case ("after", a):
                statement = c.setting.program.statements[c.alpha.code(a)[0]]
                wait = statement.after.seconds * 1000 / self.timing.tick
                age, react = clocks[keys[0]][0], self.timing.react
                must = react.hi is not None and age >= (ceil(wait) + react.hi) * PARTS
                return age >= (floor(wait) + react.lo) * PARTS, must
            case ("clause", i):
                step = self.timing.clauses[i].step if self.timing.clauses else None
                match step:
                    case Every(least):
                        return clocks["every", i][0] >= least * PARTS, False
                    case Window(after, within):
                        if ("free", i) in clocks:
                            return True, False
                        return now >= after * PARTS, within is not None and now >= within * PARTS
                    case Sayable(after, until):
                        return after * PARTS <= now and (until is None or now <= until * PARTS), False
                return True, False
        if isinstance(keys[0][1], FLY):
            lo, hi = self.interval(c, keys[0])
            return clocks["flown", keys[0][1]][0] >= lo * PARTS, clocks[keys[0]][0] >= hi * PARTS
        bounds = [(self.interval(c, key), clocks[key][0]) for key in keys]
        may = any(age >= lo * PARTS for (lo, _), age in bounds)
        return may, any(age >= hi * PARTS for (_, hi), age in bounds)

    def after(self, c, keys, t, clocks):
        _, enabled, _, flights = self.look(t.target)
        kept = {key: list(ages) for key, ages in clocks.items()}
        for key in keys:
            kept[key] = kept[key][1:] if key[0] == "request" else []
        if t.served is None and t.label.agent is not None:
            for key in kept:
                if key[0] in ("agent", "after") and key[1] == t.label.agent:
                    kept[key] = []
        for key in enabled:
            fly = key[1] if key[0] == "request" and isinstance(key[1], FLY) else None
            if fly is not None and key in kept and aim(c, fly) != aim(t.target, fly):
                kept[key] = []
        after = self.going_on(clocks, kept, enabled, flights, keys)
        several = [after]
        for u, endurance in self.timing.endurances:
            if self.restored(t.target, u, endurance):
                for each in several:
                    each["restored", u] = clocks.get(("restored", u), (0,))
            elif ("restored", u) in clocks:
                stayed = clocks["restored", u][0]
                same = several if stayed <= endurance.after * PARTS else []
                fresh = [each | {("aloft", u): (0,)} for each in several]
                several = [*same, *(fresh if stayed >= endurance.after * PARTS else [])]
        return [self.frozen(t.target, self.windows(t.target, each)) for each in several]

    def going_on(self, clocks, kept, enabled, flights, keys):
        after = {key: tuple((kept.get(key, []) + [0] * count)[:count]) for key, count in enabled.items()}
        after |= {("flown", fly): clocks.get(("flown", fly), (0,)) for fly in flights}
        for key in clocks:
            if key[0] in ("mission", "every", "due", "free", "aloft"):
                after[key] = clocks[key]
        if keys[0][0] == "clause":
            i = keys[0][1]
            if ("every", i) in clocks:
                after["every", i] = (0,)
            if ("due", i) in clocks:
                after["free", i] = (0,)
        return after

    # --- what is asked

    def configurations(self):
        return {c for c, _ in self.graph}

    def exhausted(self):
        return {
            u
            for c, clocks in self.graph
            for u, endurance in self.timing.endurances
            if dict(clocks)["aloft", u][0] > endurance.lasts * PARTS
            and u in c.structure.physical
            and not self.restored(c, u, endurance)
        }

    def time_stops(self):
        reverse = self.graph.reverse()
        passing = {a for a, _, delay in self.graph.edges(data="delay") if delay}
        going = set(passing)
        for each in passing:
            if each in reverse:
                going |= nx.descendants(reverse, each)
        return len(going) < len(self.graph)

    def longest(self, inside, ends):
        """Return how many parts of a tick runs stay inside at most before an end, from each state."""
        part = self.graph.subgraph(state for state in self.graph if inside(state))
        whole = nx.condensation(nx.DiGraph(part))
        most = {}
        for at in reversed(list(nx.topological_sort(whole))):
            members = whole.nodes[at]["members"]
            best, turns = (0 if any(map(ends, members)) else -inf), False
            for a in members:
                for b, edges in part[a].items():
                    longer = max(edge["delay"] for edge in edges.values())
                    if b in members:
                        turns = turns or longer
                    else:
                        best = max(best, longer + most[b])
            for a in members:
                most[a] = inf if turns and best > -inf else best
        return most

    def first_time(self, formula):
        """Return the earliest and the latest moment at which something is first true, and whether it may never be."""

        def true(state):
            return holds(formula, state[0])

        simple = nx.DiGraph()
        simple.add_nodes_from(self.graph)
        for a, b, delay in self.graph.edges(data="delay"):
            if not true(a) and delay < simple.get_edge_data(a, b, {"delay": 2})["delay"]:
                simple.add_edge(a, b, delay=delay)
        lengths = nx.single_source_dijkstra_path_length(simple, self.start, weight="delay")
        earliest = min((length for state, length in lengths.items() if true(state)), default=inf)
        if true(self.start):
            return 0, 0, False
        latest = self.longest(lambda s: not true(s), lambda s: any(map(true, self.graph[s])))[self.start]
        waits = self.longest(lambda s: not true(s), lambda _: True)[self.start]
        return earliest / PARTS, latest / PARTS, waits == inf

    def late(self, formula, then, ticks):
        """Return whether something stays false for longer than so many ticks."""
        most = self.longest(lambda s: not holds(then, s[0]), lambda _: True)
        starts = [self.start] if formula is None else [s for s in most if holds(formula, s[0])]
        return any(most.get(s, 0) > ticks * PARTS for s in starts)
