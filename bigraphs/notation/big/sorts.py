"""Elaboration of sorts: it resolves their names to controls and checks that every rule preserves them."""

from __future__ import annotations

from bigraphs.notation.big.declarations import LinkDeclaration, Model, PlaceDeclaration, SortDeclaration
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.names import Names
from bigraphs.notation.lalr import Span
from bigraphs.sorting import UNSORTED, LinkSort, Sorting, unkept, violations
from bigraphs.system import Rule, System


def sorting_of(model: Model, names: Names, findings: Findings) -> Sorting:
    """Return the sorts that a file declares."""
    reader = _Sorts(names, findings)
    for declaration in model.declarations:
        if isinstance(declaration, SortDeclaration):
            reader.sort(declaration)
    for declaration in model.declarations:
        if isinstance(declaration, PlaceDeclaration):
            reader.place(declaration)
        elif isinstance(declaration, LinkDeclaration):
            reader.link(declaration)
    links = (LinkSort(name, tuple(ports)) for name, ports in sorted(reader.links.items()))
    return Sorting(tuple(sorted(reader.places.items())), tuple(links))


class _Sorts:
    """The sorts read so far."""

    def __init__(self, names: Names, findings: Findings) -> None:
        self.names = names
        self.findings = findings
        self.sorts: dict[str, tuple[str, ...]] = {}
        self.places: dict[str, tuple[str, ...]] = {}
        self.links: dict[str, list[tuple[str, int | None]]] = {}

    def known(self, control: str, span: Span) -> bool:
        if control not in self.names.controls:
            self.findings.unknown("control", control, span, [*self.names.controls, *self.sorts])
        return control in self.names.controls

    def sort(self, sort: SortDeclaration) -> None:
        if sort.name in self.names.controls or sort.name in self.sorts:
            self.findings.add("name", f"'{sort.name}' is declared twice", sort.span)
        self.sorts[sort.name] = self.resolved(sort.controls, sort.span)

    def resolved(self, names: tuple[str, ...], span: Span) -> tuple[str, ...]:
        """Return the controls behind names of controls and sorts, sorted."""
        found = {control for name in names for control in self.sorts.get(name, (name,))}
        return tuple(sorted(control for control in found if self.known(control, span)))

    def place(self, place: PlaceDeclaration) -> None:
        if place.control in self.places:
            hint = "put its whole content into one"
            self.findings.add("name", f"the content of '{place.control}' is declared twice", place.span, hint)
        if self.known(place.control, place.span):
            self.places[place.control] = self.resolved(place.content, place.span)

    def link(self, link: LinkDeclaration) -> None:
        if link.name in self.links:
            self.findings.add("name", f"the link sort '{link.name}' is declared twice", link.span)
        for control, port in link.ports:
            for each in self.resolved((control,), link.span):
                self.port(link, each, port)
        self.links[link.name] = sorted(
            self.links.get(link.name, []), key=lambda port: (port[0], -1 if port[1] is None else port[1])
        )

    def port(self, link: LinkDeclaration, control: str, port: int | None) -> None:
        declared = self.names.controls[control]
        arity = declared.arity or 0
        if port is not None and port >= arity:
            self.findings.add("arity", f"'{control}' has no port {port}", link.span, "count ports from 0")
        elif port is not None and not declared.ordered and arity > 1:
            hint = f"write 'ordered ctrl {control}', or name all of its ports: {control}"
            self.findings.add("sort", f"the ports of '{control}' are interchangeable", link.span, hint)
        elif taken := self._taken(control, port):
            self.findings.add("sort", f"a port of '{control}' is of sort {taken} already", link.span)
        else:
            self.links.setdefault(link.name, []).append((control, port))

    def _taken(self, control: str, port: int | None) -> str | None:
        for name, ports in self.links.items():
            if any(one == control and (None in (other, port) or other == port) for one, other in ports):
                return name
        return None


def check_sorted(system: System, initial: Span, spans: dict[str, Span], findings: Findings) -> None:
    """Record sort violations of the initial state, and the rules that may violate sorts."""
    if system.sorting == UNSORTED:
        return
    for found in violations(system.initial, system.sorting):
        findings.add("sort", f"in the first state, {found}", initial)
    for rule in system.rules():
        for found in unkept(rule.reaction(), system.signature, system.sorting):
            findings.add("sort", _told(rule, found), spans[rule.name])


def _told(rule: Rule, found: str) -> str:
    return f"'{rule.label}' may break sorts: {found}"
