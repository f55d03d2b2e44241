"""Relevance: the questions that an agent may ever ask of an observation, and the slots its controls may use; static.

The race monitor marks a change only if it may matter to the holder, so it multiplies configurations as little as
possible.
"""

from collections.abc import Iterable, Iterator
from functools import lru_cache

from semantics.analysis.control_instances import instances
from semantics.analysis.traversal import BoundPattern, bindings, expressions_of, reachable
from semantics.behaviours.expressions import (
    OPERATORS,
    Apply,
    Expression,
    Host,
    Literal,
    QueryOf,
    free,
    members_asked,
    reads_host,
    subexpressions,
)
from semantics.behaviours.patterns import variables
from semantics.behaviours.program import Program
from semantics.behaviours.reaction_rules import NodeTerm, Pattern, Reaction
from semantics.behaviours.statements import (
    ChooseFrom,
    ControlBy,
    For,
    Migrate,
    Observe,
    Send,
    Spawn,
    Statement,
)
from semantics.fixpoints import fixpoint
from semantics.races.provenance import ANY, SLOT, Key
from semantics.state.agents import Code
from semantics.state.configuration import Configuration
from semantics.state.setting import Setting
from semantics.state.signature import Name

Names = frozenset[Name]
Questions = frozenset[Key]
"""Keys; a key about `ANY` stands for those about every name."""

SLOTS: Questions = frozenset((f"{SLOT}{kind}", ANY) for kind in ("parent", "links", "children"))


def relevant(keys: Iterable[Key], questions: Questions) -> frozenset[Key]:
    """Return the keys that are among some questions."""
    return frozenset(key for key in keys if key in questions or (key[0], ANY) in questions)


def meet(some: Questions, others: Questions) -> bool:
    """Whether two sets of questions intersect."""
    return any(
        key in others
        or (key[0], ANY) in others
        or (key[-1] == ANY and key[0] in {each[0] for each in others})
        for key in some
    )


def questions_of(c: Configuration, agent: Name) -> Questions:
    """Return the questions that an agent may ask; if it may pass on its observations, those of any agent."""
    program = c.setting.program
    reach = reachable(program, c.alpha.code(agent))
    return anybodys(c) if tells(program, reach) else questions_in(c.setting, reach, hosts_of(c, agent))


def anybodys(c: Configuration) -> Questions:
    """Return the questions that any agent may ever ask."""
    every = frozenset(range(len(c.setting.program.statements)))
    return questions_in(c.setting, every, frozenset[Name]().union(*(hosts_of(c, a) for a in c.alpha.names())))


HEARD: Name = ""
"""Stands, among variables, for received observations and messages."""

HOSTED: Name = "HOST"
"""Stands, among variables, for the host of an agent."""


def communicated_variables(program: Program, code: Code) -> Names:
    """Return the variables whose values may flow into messages or spawned agents of the code that is left to run."""
    return _told(program, reachable(program, code))


@lru_cache(maxsize=1 << 12)
def _told(program: Program, reach: frozenset[int]) -> Names:
    statements = [program.statements[number] for number in sorted(reach)]
    return fixpoint(
        lambda told: told.union(*(_passed_on(program, each, told) for each in statements)), frozenset[Name]()
    )


def uses_host(program: Program, code: Code) -> bool:
    """Whether the code that is left to run may use the agent's host; every control uses it, for any arguments."""
    return _host_used(program, reachable(program, code))


@lru_cache(maxsize=1 << 12)
def _host_used(program: Program, reach: frozenset[int]) -> bool:
    statements = [program.statements[number] for number in reach]
    return any(
        isinstance(each, ControlBy) or any(map(reads_host, expressions_of(each))) for each in statements
    )


def _read(expression: Expression | QueryOf) -> Names:
    """Return the variables that an expression or a query reads, with `HOSTED` if it reads the host."""
    return free(expression) | {HOSTED} if reads_host(expression) else free(expression)


def _passed_on(program: Program, statement: Statement, told: Names) -> Names:
    """Return the variables that a statement passes on, or from which it computes values that are passed on."""
    match statement:
        case Send(message, _):
            return _read(message)
        case Spawn(_, host, _, arguments):
            return _read(host).union(*map(_read, arguments))
        case Migrate(host):
            return _read(host) if HOSTED in told else frozenset()
        case Observe(query):
            return _read(query) if HEARD in told else frozenset()
        case _:
            found = (
                each for each in bindings(program, statement) if not told.isdisjoint(variables(each.pattern))
            )
            return frozenset[Name]().union(*map(_source, found))


def _source(binding: BoundPattern) -> Names:
    return frozenset({HEARD}) if binding.expression is None else _read(binding.expression)


def tells(program: Program, reach: Iterable[int]) -> bool:
    """Whether some statements may pass observations on to other agents."""
    return _may(program, reach, Send, Spawn)


def heirs(program: Program, code: Code) -> Names:
    """Return the heirs of an agent's provenance: possible receivers if its remaining code may send or spawn."""
    return possible_receivers(program) if tells(program, reachable(program, code)) else frozenset()


@lru_cache(maxsize=1 << 8)
def possible_receivers(program: Program) -> Names:
    """Return the agents that may ever receive a message or be spawned; `ANY` if a run decides the receiver."""
    return frozenset[Name]().union(*map(_whom, program.statements))


def _whom(statement: Statement) -> Names:
    match statement:
        case Send(_, Literal(str(name))) | Spawn(name):
            return frozenset({name})
        case Send(_, Apply("[]", (Literal(frozenset(members)), _))):
            return frozenset(str(each[1]) for each in members if isinstance(each, tuple))
        case Send():
            return frozenset({ANY})
        case _:
            return frozenset()


def hosts_of(c: Configuration, agent: Name) -> Names:
    """Return the possible hosts of an agent."""
    program = c.setting.program
    if _may(program, range(len(program.statements)), Migrate, Spawn):
        return frozenset(c.setting.kinds)
    return frozenset({c.alpha.host(agent)})


def slots_of(redex: Pattern) -> Questions:
    """Return the slots that a redex may use, over all matches."""
    used = [("parent", node) for node, _ in redex.parents] + [("links", node) for _, node in redex.links]
    return frozenset(
        (f"{SLOT}{kind}", _name(node)) for kind, node in (*used, *(("children", n) for n in redex.closed))
    )


def _name(term: NodeTerm) -> Name:
    return term if isinstance(term, str) else ANY


def _may(program: Program, reach: Iterable[int], *statements: type) -> bool:
    return any(isinstance(program.statements[number], statements) for number in reach)


@lru_cache(maxsize=1 << 12)
def questions_in(setting: Setting, reach: frozenset[int], hosts: Names) -> Questions:
    """Return the questions that some statements may ask, and the slots that their controls may use, at some hosts."""
    found: set[Key] = set()
    for number in sorted(reach):
        statement = setting.program.statements[number]
        for expression in expressions_of(statement):
            found.update(_asked(expression))
        if isinstance(statement, For | ChooseFrom) and free(statement.members):
            found.update(members_asked(ANY))
        if isinstance(statement, ControlBy):
            found |= _slots(setting, statement, hosts)
    return frozenset(found)


def _asked(expression: Expression) -> Iterator[Key]:
    for part in subexpressions(expression):
        if isinstance(part, Apply) and free(part):
            shown = (each.value if isinstance(each, Literal) else ANY for each in part.arguments)
            yield from OPERATORS[part.operator].asks(*shown)


def _slots(setting: Setting, control: ControlBy, hosts: Names) -> Questions:
    """Return the slots that a control may use, for any values of its arguments."""
    found = requested(setting, control, hosts)
    if found is None:
        return SLOTS
    return frozenset[Key]().union(*map(slots_of, {reaction.redex for reaction in found}))


def requested(setting: Setting, control: ControlBy, hosts: Names) -> tuple[Reaction, ...] | None:
    """Return the reactions that a control may request, for any names as arguments; None if there are too many."""
    ranges = (hosts, *(_range(setting, each, hosts) for each in control.arguments))
    return instances(setting.program, control.name, ranges)


def _range(setting: Setting, argument: Expression, hosts: Names) -> Names:
    match argument:
        case Literal(str(name)):
            return frozenset({name})
        case Host():
            return hosts
        case _:
            return frozenset(setting.kinds)
