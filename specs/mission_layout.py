"""The lines of a mission in canonical layout: their content, depth, and place in the source."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from specs import syntax as s
from specs.construct_text import constant, listed, placed, separated, shape, write
from specs.layout_timing import TIMING_PIECES

WIDTH: Final = 100
_STEP: Final = "  "


@dataclass(frozen=True, slots=True)
class WrappedLine:
    """A line whose `pieces` may be wrapped; `anchor` is the offset of its beginning in the source."""

    depth: int
    pieces: tuple[str, ...]
    anchor: int
    apart: bool = False  # whether an empty line precedes it, also without one in the source

    def text(self) -> str:
        """Return the line, wrapped at the width, with continuation lines indented."""
        indent, rows = _STEP * self.depth, [""]
        for piece in self.pieces:
            room = WIDTH - len(indent) - (2 * len(_STEP) if len(rows) > 1 else 0)
            if not rows[-1]:
                rows[-1] = piece
            elif len(rows[-1]) + 1 + len(piece) <= room:
                rows[-1] += f" {piece}"
            else:
                rows.append(piece)
        return f"\n{indent}{_STEP}{_STEP}".join([indent + rows[0], *rows[1:]])


@dataclass(slots=True)
class MissionLayout:
    """The layout of a mission. `source` is its text with comments blanked out, `comments` their offsets."""

    source: str = ""
    comments: tuple[int, ...] = ()
    lines: list[WrappedLine] = field(default_factory=list)
    depth: int = 0

    def line(self, anchor: int, *pieces: str, apart: bool = False) -> None:
        """Add a line."""
        self.lines.append(WrappedLine(self.depth, pieces, anchor, apart))

    def block(self, span: s.Span, head: Sequence[str], items: Sequence[s.Node]) -> None:
        """Add `head { items }`, with the items on lines of their own."""
        if not items and not self.commented(span):
            self.line(span.start, *head, "{}")
            return
        self.line(span.start, *head, "{")
        self.depth += 1
        for item in items:  # no call of `below`: deep nesting costs frames
            self.add(item)
        self.depth -= 1
        self.line(max(span.end - 1, 0), "}")

    def below(self, items: Sequence[s.Node]) -> None:
        """Add the lines of the items, one step deeper."""
        self.depth += 1
        for item in items:
            self.add(item)
        self.depth -= 1

    def commented(self, span: s.Span) -> bool:
        """Return whether there is a comment within a span."""
        return bisect_left(self.comments, span.start) < bisect_left(self.comments, span.end)

    def closing(self, after: int) -> int:
        """Return the offset of the brace that closes a block whose last statement ends at `after`."""
        return max(self.source.find("}", after), 0)

    def add(self, node: s.Node) -> None:
        """Add the lines of a node."""
        blocks = _BLOCKS.get(type(node))
        if blocks:
            blocks(self, node)
        else:
            self.line(node.span.start, *pieces(node))


def lay_out(mission: s.Mission, source: str = "", comments: tuple[int, ...] = ()) -> tuple[WrappedLine, ...]:
    """Return the lines of a mission; empty lines separate declarations of several lines."""
    layout = MissionLayout(source, comments)
    if mission.name:
        layout.line(mission.span.start, f"mission {write(mission.name)}")
    long_before = bool(mission.name)
    for number, declaration in enumerate(mission.declarations):
        first = len(layout.lines)
        layout.add(declaration)
        long = len(layout.lines) - first > 1
        if (number or mission.name) and (long or long_before):
            head = layout.lines[first]
            layout.lines[first] = WrappedLine(head.depth, head.pieces, head.anchor, apart=True)
        long_before = long
    return tuple(layout.lines)


# --- constructs with blocks


def _if(layout: MissionLayout, node: s.If) -> None:
    layout.line(node.span.start, f"if {write(node.condition)} {{")
    _branches(layout, node)
    layout.line(max(node.span.end - 1, 0), "}")


def _branches(layout: MissionLayout, node: s.If) -> None:
    layout.below(node.then)
    end = layout.closing(node.then[-1].span.end if node.then else node.condition.span.end)
    match node.otherwise:
        case ():
            return
        case (s.If() as other,):
            layout.line(end, f"}} else if {write(other.condition)} {{")
            _branches(layout, other)
        case _:
            layout.line(end, "} else {")
            layout.below(node.otherwise)


def _case(layout: MissionLayout, node: s.Case) -> None:
    guard = f" if {write(node.guard)}" if node.guard else ""
    _arrow(layout, node.span, f"case {write(node.pattern)}{guard} =>", node.body)


def _after(layout: MissionLayout, node: s.After) -> None:
    _arrow(layout, node.span, f"after {write(node.duration)} =>", node.body)


def _react(layout: MissionLayout, node: s.React) -> None:
    layout.block(node.span, ["react"], (*node.cases, *([node.after] if node.after else [])))


def _alternative(layout: MissionLayout, node: s.Alternative) -> None:
    _arrow(layout, node.span, "case =>", node.body)


def _arrow(layout: MissionLayout, span: s.Span, head: str, body: tuple[s.Statement, ...]) -> None:
    if len(body) == 1 and type(body[0]) not in _BLOCKS and not layout.commented(span):
        text = f"{head} {' '.join(pieces(body[0]))}"
        if len(text) + len(_STEP) * layout.depth <= WIDTH:
            layout.line(span.start, text)
            return
    layout.line(span.start, head)
    layout.below(body)


def _block(head: Callable[[s.Node], str], items: str) -> Callable[[MissionLayout, s.Node], None]:
    return lambda layout, node: layout.block(node.span, [head(node)], getattr(node, items))


def _signature(layout: MissionLayout, node: s.Signature) -> None:
    if node.standard and not node.kinds and not layout.commented(node.span):
        layout.line(node.span.start, _head(node))
    else:
        layout.block(node.span, [_head(node)], node.kinds)


def _head(node: s.Node) -> str:
    match node:
        case s.BigActor(name, host, _):
            named = f" {write(name)}" if name else ""
            return f"BigActor{named} hosted_at {write(host)} with_behavior"
        case s.Family(name, index, variable, among, host, _):
            each = f"{write(name)}[{write(index)}] for {write(variable)} in {write(among)}"
            return f"BigActor {each} hosted_at {write(host)} with_behavior"
        case s.Definition(name, parameters, _):
            return f"def {write(name)}({listed(parameters)}) ="
        case s.While(condition, _):
            return f"while {write(condition)}"
        case s.For(variable, collection, _):
            return f"for {write(variable)} in {write(collection)}"
        case s.ChooseFrom(variable, collection, _):
            return f"choose {write(variable)} in {write(collection)}"
        case s.Match(subject, _):
            return f"match {write(subject)}"
        case s.Signature(_, standard):
            return "signature standard" if standard else "signature"
    return type(node).__name__.lower()


_BLOCKS: Final[dict[type[s.Node], Callable[..., None]]] = {
    s.If: _if,
    s.Case: _case,
    s.React: _react,
    s.After: _after,
    s.Alternative: _alternative,
    **{
        sort: _block(_head, "body")
        for sort in (s.BigActor, s.Family, s.Definition, s.While, s.For, s.ChooseFrom, s.Loop)
    },
    s.Match: _block(_head, "cases"),
    s.Choose: _block(_head, "alternatives"),
    s.Signature: _signature,
    s.World: _block(_head, "entries"),
    s.Believes: _block(_head, "beliefs"),
    s.Environment: _block(_head, "clauses"),
    s.Check: _block(_head, "properties"),
    s.Timing: _block(_head, "bounds"),
    s.Live: _block(_head, "precautions"),
}

# --- constructs on one line


def pieces(node: s.Node) -> list[str]:
    """Return the text of a declaration, entry, clause or statement without a block, in pieces."""
    make = _PIECES.get(type(node))
    return make(node) if make else [write(node)]


def _kind(node: s.Kind) -> list[str]:
    flags = [word for word, said in (("driven", node.driven), ("passive", node.passive)) if said]
    lists = [
        piece
        for word, kinds in (("contains", node.contains), ("carries", node.carries))
        if kinds
        for piece in separated(word, kinds)
    ]
    return [f"kind {write(node.name)}", *flags, *lists]


def _entity(node: s.Entity) -> list[str]:
    found = [f"{write(node.name)}: {write(node.kind)}"]
    if node.placement:
        first, *rest = placed(node.placement)
        found = [f"{found[0]} = {first}", *rest]
    if node.carrier:
        found.append(f"carried by {write(node.carrier)}")
    if node.channels:
        found += separated("linked", node.channels)
    return [*found, "absent"] if node.absent else found


def _from_source(node: s.FromSource) -> list[str]:
    found = [f"from {write(node.file)}"]
    if node.prefix:
        found.append(f"as {write(node.prefix)}")
    if node.time:
        found.append(f"at {write(node.time)}")
    if node.within:
        found += ["within", *shape(node.within)]
    if node.keep:
        found += _kept(node.keep)
    return found if node.limit is None else [*found, f"limit {node.limit}"]


def _kept(keep: Sequence[s.Keep]) -> list[str]:
    texts = [_kept_kind(item) for item in keep]
    return ["keep", *(f"{text}," for text in texts[:-1]), texts[-1]]


def _kept_kind(item: s.Keep) -> str:
    kind = "" if item.recorded == item.kind else f" as {write(item.kind)}"
    radius = "" if item.radius is None else f" radius {write(item.radius)}"
    return f"{write(item.recorded)}{kind}{radius}"


def _rule(node: s.Rule) -> list[str]:
    parameters = ", ".join(f"{write(item.name)}: {write(item.kind)}" for item in node.parameters)
    head = f"rule {write(node.name)}({parameters})" if parameters else f"rule {write(node.name)}"
    return [f"{head} {{", *node.body.text.split(" "), "}"]


def _says(node: s.Says) -> list[str]:
    to = f" to {write(node.recipient)}" if node.recipient else ""
    times = "once" if node.times == 1 else f"{node.times} times"
    return [f"says {constant(node.message)}{to} at most {times}"]


def _appears(node: s.Appears) -> list[str]:
    links = separated("linked", node.channels) if node.channels else []
    return [f"{write(node.entity)} appears", *separated("at", node.placements), *links]


def _returning(node: s.Drops | s.Leaves) -> str:
    return " and returns" if node.returns else ""


def _time_limit(node: s.TimeLimit) -> str:
    kind = f"{node.request} " if node.request else ""
    who = write(node.agent) if node.agent else "anyone"
    return f"{kind}{who} within {write(node.limit)}: {node.fallback}"


def _spawn(node: s.Spawn) -> list[str]:
    behaviour, host = write_call(node.behaviour), write(node.host)
    if node.name:
        return [f"spawn {write(node.name)} hosted_at {host} with_behavior {behaviour}"]
    return [f"spawn({behaviour}, hosted_at {host})"]


def write_call(node: s.Call) -> str:
    """Return the text of a call of a behaviour."""
    return f"{write(node.behaviour)}({listed(node.arguments)})"


def _temporal(node: s.TemporalProperty) -> list[str]:
    head = [node.logic, write(node.label), *_under(node.fairness)]
    return [*head[:-1], f"{head[-1]}:", write(node.formula)]


def _named(word: str, node: s.FairDeadlockFreedom | s.Progress) -> list[str]:
    return [f"{word} {write(node.label)}" if node.label else word, *_under(node.fairness)]


def _under(fairness: Sequence[s.Fairness]) -> list[str]:
    words = ("under", *("and" for _ in fairness[1:]))
    return [f"{word} {write(each)}" for word, each in zip(words, fairness, strict=True)] if fairness else []


_PIECES: Final[dict[type[s.Node], Callable[..., list[str]]]] = {
    s.Kind: _kind,
    s.Entity: _entity,
    s.ChannelDeclaration: lambda node: [f"channel {write(node.name)}"],
    s.FromSource: _from_source,
    s.BelievedIn: lambda node: [f"{write(node.entity)} in {write(node.place) if node.place else 'region'}"],
    s.BelievedUnknown: lambda node: [f"{write(node.entity)} unknown"],
    s.BelievedLinked: lambda node: (
        [write(node.entity), *separated("linked", node.channels)]
        if node.channels
        else [f"{write(node.entity)} unlinked"]
    ),
    s.Rule: _rule,
    s.Scheduler: lambda node: [f"scheduler {node.name}"],
    s.ControlMode: lambda node: [f"control {node.name}"],
    s.DriftsAmong: lambda node: [f"{write(node.entity)} drifts", *separated("among", node.placements)],
    s.DriftsWithin: lambda node: [f"{write(node.entity)} drifts within {write(node.place)}"],
    s.Drops: lambda node: [f"{write(node.channel)} drops{_returning(node)}"],
    s.Leaves: lambda node: [f"{write(node.entity)} leaves {write(node.channel)}{_returning(node)}"],
    s.Appears: _appears,
    s.Vanishes: lambda node: [f"{write(node.entity)} vanishes"],
    s.Says: _says,
    s.Arrives: lambda node: [f"{write(node.entity)} arrives"],
    s.Strays: lambda node: [f"{write(node.vehicle)} strays at most {write(node.distance)}"],
    s.Misses: lambda node: separated("observe may miss", node.entities),
    **TIMING_PIECES,
    s.OnBroken: lambda node: [f"on broken {node.what}: {node.fallback}"],
    s.TimeLimit: lambda node: [_time_limit(node)],
    s.StandardProperty: lambda node: [node.name],
    s.Invariant: lambda node: [f"invariant {write(node.label)}:", write(node.formula)],
    s.Reachable: lambda node: [f"reachable {write(node.label)}:", write(node.formula)],
    s.TemporalProperty: _temporal,
    s.Deadline: lambda node: [f"within {write(node.limit)} {write(node.label)}:", write(node.formula)],
    s.FirstTime: lambda node: [f"time {write(node.label)}:", write(node.formula)],
    s.FairDeadlockFreedom: lambda node: _named("deadlock_freedom", node),
    s.Progress: lambda node: _named("progress", node),
    s.Observe: lambda node: [f"observe({write(node.query)})"],
    s.Control: lambda node: [f"control({write(node.action)})"],
    s.Send: lambda node: [f"send {write(node.message)} to {write(node.recipient)}"],
    s.Migrate: lambda node: [f"migrate({write(node.host)})"],
    s.Spawn: _spawn,
    s.Display: lambda node: [f"display({write(node.value)})"],
    s.Let: lambda node: [f"let {write(node.variable)} = {write(node.value)}"],
    s.Assign: lambda node: [f"{write(node.variable)} = {write(node.value)}"],
    s.Call: lambda node: [write_call(node)],
    s.Skip: lambda _: ["skip"],
}
