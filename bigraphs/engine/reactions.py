"""Compiled rules: the pattern to find, and the changes at an occurrence, node by node."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from bigraphs.engine.automorphisms import Representatives
from bigraphs.engine.contexts import ConditionCheck
from bigraphs.engine.intern_tables import InternTables, has_edges
from bigraphs.engine.multiple_parents import region_places, site_contents
from bigraphs.engine.mutable_state import MutableState
from bigraphs.engine.occurrence_search import Matcher
from bigraphs.engine.patterns import CompiledPattern, check_size, check_solid, compile_pattern
from bigraphs.engine.rule_forms import Forms
from bigraphs.engine.search_state import PatternOccurrence
from bigraphs.engine.state_arrays import GroundState, bits
from bigraphs.engine.tracking import top_down, traced, track, track_edges
from bigraphs.errors import BigraphError
from bigraphs.system import Rule

_Places: TypeAlias = Callable[[tuple[int, ...]], tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class NodeChange:
    """The change of one node of the reactum.

    `old` is its node of the redex, or -1 for a new node. `places` are nodes of the reactum or regions; None if they
    stay. `links` are links of the reactum; None if they stay.
    """

    node: int
    old: int
    label: int
    places: tuple[int, ...] | None
    links: tuple[int, ...] | None


@dataclass(frozen=True, slots=True)
class SiteChange:
    """The change of a site's content: it moves to the first of the `uses`, the others receive copies."""

    site: int
    uses: tuple[tuple[int, ...], ...]
    stays: bool


class CompiledReaction:
    """A rule of one world: its matcher and its changes, both compiled on first use.

    Attributes:
        label: The name of the rule, with its parameters.
        controls: The number of redex nodes of each control.
        wide: Whether the places of an occurrence's regions must be checked.
        exact: The controls of the redex nodes without a site.
        closed: Whether the redex has edges.
    """

    def __init__(self, world: InternTables, rule: Rule, number: int, forms: Forms | None = None) -> None:
        self.world, self.number, self.label = world, number, rule.label
        self._given, self._forms = rule, forms or Forms()
        check_solid(rule.redex, f"the redex of rule '{rule.label}'")
        for pattern in (rule.redex, *(condition.pattern for condition in rule.conditions)):
            check_size(pattern)
            world.know(pattern)
        world.know(rule.reactum)
        controls = [world.controls[node.control] for node in rule.redex.nodes]
        sited = {place for parents in rule.redex.sites for place in parents}
        self.controls = Counter(controls)
        self.exact = frozenset(control for node, control in enumerate(controls) if node not in sited)
        self.closed = has_edges(rule.redex)

    @cached_property
    def rule(self) -> Rule:
        """The rule, in canonical form."""
        return self._forms.tidy(self._given)

    @cached_property
    def pattern(self) -> CompiledPattern:
        """The redex, compiled."""
        return compile_pattern(self.world, self.rule.redex)

    @cached_property
    def matcher(self) -> Matcher:
        """The matcher of the redex."""
        return Matcher(self.world, self.pattern)

    @cached_property
    def wide(self) -> bool:
        """Whether the places of an occurrence's regions must be checked."""
        return self.world.passive or self.matcher.wide

    @cached_property
    def conditions(self) -> tuple[ConditionCheck, ...]:
        """The conditions, compiled."""
        return tuple(ConditionCheck(self.world, condition) for condition in self.rule.conditions)

    @cached_property
    def representatives(self) -> Representatives:
        """The selection among symmetric occurrences; compiled at the rule's first occurrence."""
        return Representatives(self.pattern, self._forms.symmetries(self.rule, self.pattern))

    @cached_property
    def tracked(self) -> tuple[int, ...]:
        """For each node of the reactum its node of the redex, or -1."""
        return track(self.rule.redex, self.rule.reactum)

    @cached_property
    def edges(self) -> tuple[int, ...]:
        """For each edge of the reactum its edge of the redex, or -1."""
        return track_edges(self.rule.redex, self.rule.reactum, self.tracked)

    @cached_property
    def labels(self) -> list[int]:
        """The label of each node of the reactum."""
        return [self.world.label(node.control, node.name) for node in self.rule.reactum.nodes]

    @cached_property
    def removed(self) -> tuple[int, ...]:
        """The nodes of the redex that are not in the reactum."""
        kept = set(self.tracked)
        return tuple(node for node in range(self.pattern.size) if node not in kept)

    @cached_property
    def changes(self) -> tuple[NodeChange, ...]:
        """The change of each node of the reactum, parents first."""
        return tuple(self._node_change(number) for number in top_down(self.rule.reactum))

    @cached_property
    def created(self) -> tuple[NodeChange, ...]:
        """The changes of new nodes."""
        return tuple(change for change in self.changes if change.old < 0)

    @cached_property
    def kept(self) -> tuple[NodeChange, ...]:
        """The changes of surviving nodes with new places or new links."""
        old = (change for change in self.changes if change.old >= 0)
        return tuple(change for change in old if change.places is not None or change.links is not None)

    @cached_property
    def sites(self) -> tuple[SiteChange, ...]:
        """The changes of the sites whose content does not simply stay."""
        changes = map(self._site_change, range(len(self.rule.redex.sites)))
        return tuple(change for change in changes if not change.stays or len(change.uses) != 1)

    @cached_property
    def placed(self) -> bool:
        """Whether a change puts something directly into a region."""
        nodes = [change.places or () for change in self.changes]
        uses = [use for change in self.sites for use in change.uses]
        return any(place < 0 for places in (*nodes, *uses) for place in places)

    def _node_change(self, number: int) -> NodeChange:
        node, old = self.rule.reactum.nodes[number], self.tracked[number]
        label = self.labels[number]
        names = {name: link for link, name in enumerate(self.rule.reactum.outer_names)}
        links = [names[link] if isinstance(link, str) else self.pattern.names + link for link in node.ports]
        if old < 0:
            return NodeChange(number, old, label, node.parents, tuple(links))
        before = self.rule.redex.nodes[old]
        stays = traced(node.parents, self.tracked) == set(before.parents)
        same = self._links_stay(links, self.pattern.ports[old])
        return NodeChange(number, old, label, None if stays else node.parents, None if same else tuple(links))

    def _links_stay(self, links: list[int], before: tuple[int, ...]) -> bool:
        names = self.pattern.names
        traced = [
            link
            if link < names
            else names + self.edges[link - names]
            if self.edges[link - names] >= 0
            else -1
            for link in links
        ]
        return traced == list(before)

    def _site_change(self, site: int) -> SiteChange:
        reactum, instantiation = self.rule.reactum, self.rule.instantiation
        uses = [places for places, held in zip(reactum.sites, instantiation, strict=True) if held == site]
        before = set(self.rule.redex.sites[site])
        staying = [use for use in uses if traced(use, self.tracked) == before][:1]
        for use in staying:
            uses.remove(use)
        return SiteChange(site, (*staying, *uses), bool(staying))

    def apply(self, state: GroundState, occurrence: PatternOccurrence) -> tuple[MutableState, dict[int, int]]:
        """Return the state after the rule acts at an occurrence, and the slots of the reactum's nodes in it."""
        nodes = occurrence.nodes
        regions = self._region_places(state, occurrence) if self.placed else []
        contents = self._contents(state, occurrence) if self.sites else []
        draft = MutableState(state)
        slots = {number: nodes[old] for number, old in enumerate(self.tracked) if old >= 0}
        for change in self.created:
            slots[change.node] = draft.new_slot(change.label)
        if self.world.named:
            self._name(draft, state, slots)

        def places(written: tuple[int, ...]) -> tuple[int, ...]:
            found = [[slots[place]] if place >= 0 else regions[~place] for place in written]
            if not any(found):
                message = f"rule '{self.rule.label}' puts a node into a region without a place here"
                raise BigraphError("orphan", message, "give it a place in a node of the rule, too")
            return tuple(sorted({place for some in found for place in some}))

        self._relink(draft, occurrence, slots)
        for change in (*self.created, *self.kept):
            if change.places is not None:
                draft.move(slots[change.node], places(change.places))
        if contents:
            self._change_contents(draft, state, occurrence, contents, places)
        for old in self.removed:
            draft.remove(nodes[old])
        return draft, slots

    def _name(self, draft: MutableState, state: GroundState, slots: dict[int, int]) -> None:
        """Name the nodes of the reactum; a node that an anonymous redex node matched loses its name."""
        for number, label in enumerate(self.labels):
            name = self.world.name_of[label]
            if name is not None and self.tracked[number] < 0 and label in state.labels:
                message = f"rule '{self.rule.label}' creates '{name}', which is there already"
                raise BigraphError("name", message, "a name is one node")
            if draft.state.labels[slots[number]] != label:
                draft.relabel(slots[number], label)

    def _region_places(self, state: GroundState, occurrence: PatternOccurrence) -> list[list[int]]:
        if self.world.sharing:
            return region_places(self.pattern, state, occurrence.nodes, occurrence.mask)
        found: list[list[int]] = [[] for _ in range(self.pattern.regions)]
        for node, homes in enumerate(self.pattern.homes):
            for region in homes:
                found[region] = [state.parents[occurrence.nodes[node]][0]]
        return found

    def _contents(self, state: GroundState, occurrence: PatternOccurrence) -> list[int]:
        """Return the mask of the content of each site."""
        if self.world.sharing:
            return site_contents(self.pattern, state, occurrence.nodes, occurrence.mask)
        return [state.kids[occurrence.nodes[home]] & ~occurrence.mask for (home,) in self.pattern.sites]

    def _relink(self, draft: MutableState, occurrence: PatternOccurrence, slots: dict[int, int]) -> None:
        names = self.pattern.names
        edges = [occurrence.links[names + edge] if edge >= 0 else draft.new_edge() for edge in self.edges]
        for change in (*self.created, *self.kept):
            if change.links is not None:
                links = [
                    occurrence.links[link] if link < names else edges[link - names] for link in change.links
                ]
                ordered = self.world.ordered[self.world.control_of[change.label]]
                draft.relink(slots[change.node], tuple(links) if ordered else tuple(sorted(links)))

    def _change_contents(
        self,
        draft: MutableState,
        state: GroundState,
        occurrence: PatternOccurrence,
        contents: list[int],
        places: _Places,
    ) -> None:
        """Move, copy and drop the content of the sites."""
        changes = {change.site: change for change in self.sites}
        for slot in bits(_union(contents[site] for site in changes)):
            within = [site for site, held in enumerate(contents) if held >> slot & 1]
            around = {place for place in state.parents[slot] if place < 0 or not occurrence.mask >> place & 1}
            shared = bool(around) or len(within) > 1
            for site in within:
                if site not in changes or changes[site].stays:
                    around.update(occurrence.nodes[home] for home in self.pattern.sites[site])
                elif changes[site].uses:
                    around.update(places(changes[site].uses[0]))
            self._copy(
                draft,
                slot,
                [use for site in within if site in changes for use in changes[site].uses[1:]],
                places,
                shared=shared,
            )
            if not around:
                draft.remove_all(slot)
            elif around != set(state.parents[slot]):
                draft.move(slot, tuple(sorted(around)))

    def _copy(
        self, draft: MutableState, slot: int, uses: list[tuple[int, ...]], places: _Places, *, shared: bool
    ) -> None:
        if uses and shared:
            raise BigraphError("copy", f"rule '{self.rule.label}' would copy a node that other places share")
        for use in uses:
            draft.copy_all(slot, places(use))


def _union(masks: Iterable[int]) -> int:
    found = 0
    for mask in masks:
        found |= mask
    return found
