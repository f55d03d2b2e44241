"""Matching as a satisfiability problem: one model per occurrence, counted by a solver that knows nothing of ours.

For places without sharing. There is a variable for each pair of nodes and for each pair of links.
"""

from itertools import combinations

from pysat.card import CardEnc, EncType
from pysat.formula import IDPool
from pysat.solvers import Minisat22

from bigraphs.bigraph import children, links, points, sites_in


def sat_matches(redex, target):
    """Return the (nodes, links) of every occurrence of a solid redex, where its regions are disjoint."""
    problem = Encoding(redex, target)
    problem.nodes()
    problem.places()
    problem.links()
    problem.disjoint()
    return set(problem.models())


class Encoding:
    def __init__(self, redex, target):
        self.redex, self.target = redex, target
        self.pool, self.clauses = IDPool(), []
        self.sources, self.images = links(redex), links(target)

    def node(self, number, image):
        return self.pool.id(("node", number, image))

    def link(self, link, image):
        return self.pool.id(("link", link, image))

    def exactly_one(self, literals):
        self.clauses.append(list(literals))
        self.at_most_one(literals)

    def at_most_one(self, literals):
        encoded = CardEnc.atmost(list(literals), 1, vpool=self.pool, encoding=EncType.pairwise)
        self.clauses.extend(encoded.clauses)

    def nodes(self):
        count = len(self.target.nodes)
        for number, node in enumerate(self.redex.nodes):
            self.exactly_one([self.node(number, image) for image in range(count)])
            for image, other in enumerate(self.target.nodes):
                if node.control != other.control or len(node.ports) != len(other.ports):
                    self.clauses.append([-self.node(number, image)])
        for image in range(count):
            self.at_most_one([self.node(number, image) for number in range(len(self.redex.nodes))])

    def places(self):
        inside, there, sited = children(self.redex), children(self.target), sites_in(self.redex)
        for number, node in enumerate(self.redex.nodes):
            (parent,) = node.parents
            for image, other in enumerate(self.target.nodes):
                (above,) = other.parents
                if parent >= 0:
                    held = [self.node(parent, above)] if above >= 0 else []
                    self.clauses.append([-self.node(number, image), *held])
                elif above >= 0:  # what a region's node is in must not be matched
                    for some in range(len(self.redex.nodes)):
                        self.clauses.append([-self.node(number, image), -self.node(some, above)])
                for child in there[image]:
                    if number not in sited:
                        held = [self.node(some, child) for some in inside[number]]
                        self.clauses.append([-self.node(number, image), *held])

    def links(self):
        for link in self.sources:
            self.exactly_one([self.link(link, image) for image in self.images])
        for number, node in enumerate(self.redex.nodes):
            for image, other in enumerate(self.target.nodes):
                if len(node.ports) == len(other.ports):
                    self.ports(number, node, image, other)
        on, there = points(self.redex), points(self.target)
        for edge in range(self.redex.edges):
            for image in self.images:
                if isinstance(image, str) or len(on[edge]) != len(there[image]):
                    self.clauses.append([-self.link(edge, image)])
                for other in self.sources:
                    if other != edge:
                        self.clauses.append([-self.link(edge, image), -self.link(other, image)])

    def ports(self, number, node, image, other):
        """Demand that the links of two nodes agree, port by port or as multisets."""
        if self.target.signature[node.control].ordered:
            for mine, its in zip(node.ports, other.ports, strict=True):
                self.clauses.append([-self.node(number, image), self.link(mine, its)])
            return
        mine = sorted(set(node.ports), key=str)
        for its in self.images:
            wanted = other.ports.count(its)
            for size in range(len(mine) + 1):
                for chosen in combinations(mine, size):
                    if sum(node.ports.count(link) for link in chosen) != wanted:
                        # exactly these go to that link: not allowed
                        rest = [link for link in mine if link not in chosen]
                        forbidden = [-self.link(link, its) for link in chosen]
                        forbidden += [self.link(link, its) for link in rest]
                        self.clauses.append([-self.node(number, image), *forbidden])

    def disjoint(self):
        """Demand that nothing matched is below an unmatched child of what is matched."""
        size = len(self.redex.nodes)
        for image, other in enumerate(self.target.nodes):
            (above,) = other.parents
            if above < 0:
                continue
            below = self.pool.id(("below", image))
            inside = [self.node(number, image) for number in range(size)]
            for number in range(size):
                self.clauses.append([-self.node(number, above), *inside, below])
            self.clauses.append([-self.pool.id(("below", above)), below])
            self.clauses += [[-below, -each] for each in inside]

    def models(self):
        with Minisat22(bootstrap_with=self.clauses) as solver:
            while solver.solve():
                true = {literal for literal in solver.get_model() if literal > 0}
                nodes = tuple(
                    next(i for i in range(len(self.target.nodes)) if self.node(n, i) in true)
                    for n in range(len(self.redex.nodes))
                )
                where = tuple(
                    next(i for i in self.images if self.link(link, i) in true) for link in self.sources
                )
                yield nodes, where
                solver.add_clause(
                    [-self.node(n, i) for n, i in enumerate(nodes)]
                    + [-self.link(link, i) for link, i in zip(self.sources, where, strict=True)]
                )
