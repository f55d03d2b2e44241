"""Elaboration of a `.big` file to a system."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product
from typing import Final

from bigraphs.algebra import lean
from bigraphs.bigraph import Bigraph, relabelled
from bigraphs.notation.big import values
from bigraphs.notation.big.declarations import Call, ClassTerm, Model, ParameterDeclaration, SystemTerm
from bigraphs.notation.big.expression_evaluation import Evaluation
from bigraphs.notation.big.file_mistakes import Findings
from bigraphs.notation.big.name_check import survey
from bigraphs.notation.big.names import Names, index
from bigraphs.notation.big.parser import parse_model
from bigraphs.notation.big.rules import RuleElaborator
from bigraphs.notation.big.scope import CallFrame, FileScope, control_of
from bigraphs.notation.big.sorts import check_sorted, sorting_of
from bigraphs.notation.lalr import Span
from bigraphs.signature import Signature
from bigraphs.system import Action, Predicate, PriorityClass, Rule, System, SystemKind, Value

MAX_INSTANCES: Final = 10_000
"""The largest number of rules or predicates of a system, with an instance for each parameter value."""
_ONE: Final = Span(0, 1)


def read_system(text: str, *, constants: Mapping[str, Value] | None = None) -> System:
    """Return the system of a `.big` file; `constants` override the constants that it declares.

    Raises:
        NotationError: With the first syntax error, or else with all other mistakes.
    """
    model = parse_model(text)
    findings = Findings(text)
    found = _Systems(model, findings, constants or {}).system()
    findings.raise_any()
    if found is None:
        raise AssertionError("no system, and no mistake")
    return found


class _Systems:
    """The elaboration of one file."""

    def __init__(self, model: Model, findings: Findings, constants: Mapping[str, Value]) -> None:
        self.model = model
        self.findings = findings
        self.names = index(model, findings)
        survey(model, self.names, findings, constants)
        self.scope = FileScope(self.names, findings, self.given(constants))
        self.evaluation = Evaluation(self.scope)
        kind = SystemKind(model.system.kind) if model.system is not None else None
        self.rules = RuleElaborator(self.evaluation, kind)
        self.ranges: dict[str, tuple[Value, ...]] = {}

    def given(self, constants: Mapping[str, Value]) -> dict[str, Value]:
        """Return constants as values of their declared types."""
        found = dict(constants)
        for name, value in constants.items():
            declared = self.names.constants.get(name)
            typed = values.typed(declared.type, value, declared.span, self.findings) if declared else value
            found[name] = value if typed is None else typed
        return found

    def system(self) -> System | None:
        """Return the system, or None after a recorded mistake; unused declarations are checked too."""
        check_declared(self.names, self.scope, self.evaluation, self.rules)
        sorting = sorting_of(self.model, self.names, self.findings)
        term = self.model.system
        if term is None:
            hint = "end it with 'begin brs init ...; rules = [{...}]; end'"
            self.findings.add("system", "the file has no system", _end(self.findings.text), hint)
            return None
        for parameter in term.parameters:
            self.parameter(parameter)
        initial = self.initial(term.init)
        classes = [self.priority_class(each) for each in term.classes]
        self.check_classes(term, classes)
        predicates = [found for call in term.predicates for found in self.predicates(call)]
        self.check_distinct([predicate.label for predicate in predicates], term.predicates)
        if len(self.findings) or initial is None:
            return None
        actions = _actions(classes)
        system = System(
            SystemKind(term.kind),
            Signature(),
            initial,
            tuple(classes),
            tuple(predicates),
            actions,
            (),
            sorting,
        )
        whole = with_signature(system, self.signature(system))
        spans = {rule.name: rule.span for rule in self.names.all_reacts()}
        check_sorted(whole, term.init.span, spans, self.findings)
        return replace(whole, warnings=self.findings.warnings)

    def signature(self, system: System) -> Signature:
        """Return the signature: the declared controls, and the instances of parametrised ones that the system uses."""
        plain = [control_of(each, ()) for each in self.names.controls.values() if not each.parameters]
        used = {node.control for bigraph in bigraphs_of(system) for node in bigraph.nodes}
        given = [control for name, control in self.evaluation.controls.items() if name in used]
        return Signature(tuple({control.name: control for control in (*plain, *given)}.values()))

    def parameter(self, parameter: ParameterDeclaration) -> None:
        """Evaluate the values of system parameters."""
        found = [self.scope.value(value, CallFrame()) for value in parameter.values]
        typed = [
            None if value is None else values.typed(parameter.type, value, written.span, self.findings)
            for value, written in zip(found, parameter.values, strict=True)
        ]
        known = [value for value in typed if value is not None]
        if len(known) < len(typed):
            return
        chosen = self.ranged(known, parameter.span) if parameter.ranged else sorted(set(known))
        for name in parameter.names:
            if name in self.names.constants or name in self.names.bigs or name in self.names.reacts:
                self.findings.add("name", f"'{name}' is declared twice", parameter.span)
            elif len(chosen) == 1:
                self.scope.constants[name] = chosen[0]
            self.ranges[name] = tuple(chosen)

    def ranged(self, bounds: list[Value], span: Span) -> list[Value]:
        """Return the values of `[first : step : last]`, descending, with `first` in any case (see `instances`)."""
        first, step, last = (value if isinstance(value, int | float) else 0 for value in bounds)
        if step <= 0:
            self.findings.add("number", f"a step is more than 0, this is {step}", span)
            return [first]
        if (last - first) / step >= MAX_INSTANCES:
            self.findings.add("too-large", f"a range of more than {MAX_INSTANCES} values", span)
            return [first]
        found: list[Value] = [first]
        value = first + step
        while value <= last:
            found.append(value)
            value += step
        return found[::-1]

    def initial(self, call: Call) -> Bigraph | None:
        given = self.scope.arguments(call.arguments, CallFrame())
        found = None if given is None else self.evaluation.named(call.name, given, call.span, CallFrame())
        if found is not None and (found.sites or found.inner_links):
            message = f"a first state is ground, '{call.name}' has {found.inner}"
            self.findings.add("initial", message, call.span, "fill its sites with 1, close its inner names")
        return None if found is None else lean(found)

    def instances(self, call: Call) -> Iterator[tuple[tuple[Value, ...], CallFrame]]:
        """Yield the arguments of a call for each combination of its parameters' values, with the frame of these values.

        The order is BigraphER's, as it determines which instantaneous rule acts first. Values of a range come in source
        order, values of a set `{...}` in descending order.
        """
        names = sorted(
            {name for value in call.arguments for name in values.variables(value)} & set(self.ranges)
        )
        count = 1
        for name in names:
            count *= len(self.ranges[name])
        if count > MAX_INSTANCES:
            self.findings.add("too-large", f"more than {MAX_INSTANCES} instances of '{call.name}'", call.span)
            return
        for chosen in reversed(list(product(*(self.ranges[name] for name in names)))):
            frame = CallFrame(values=dict(zip(names, chosen, strict=True)))
            given = self.scope.arguments(call.arguments, frame)
            if given is not None:
                yield given, frame

    def priority_class(self, term: ClassTerm) -> PriorityClass:
        rules: list[Rule] = []
        for call in term.rules:
            found = [
                self.rules.named(call.name, given, call.span, frame) for given, frame in self.instances(call)
            ]
            rules.extend(rule for rule in found if rule is not None)
        if len(rules) > MAX_INSTANCES:
            self.findings.add("too-large", f"more than {MAX_INSTANCES} rules", term.span)
        self.check_distinct([rule.label for rule in rules], term.rules)
        return PriorityClass(tuple(rules), term.instantaneous, self.rules.position(term.span))

    def check_distinct(self, labels: list[str], calls: tuple[Call, ...]) -> None:
        again = sorted(label for label, times in Counter(labels).items() if times > 1)
        if again:
            at = next((call.span for call in calls[::-1] if again[0].startswith(call.name)), _ONE)
            self.findings.add("name", f"'{again[0]}' is listed twice", at, "it would count twice")

    def check_classes(self, term: SystemTerm, classes: list[PriorityClass]) -> None:
        if classes and all(each.instantaneous for each in classes):
            hint = "put the rules between states into braces, {...}"
            self.findings.add("system", "all classes are instantaneous", term.classes[0].span, hint)
        for each, found in zip(term.classes, classes, strict=True):
            for rule in found.rules:
                self.check_kind(term, each, rule)

    def check_kind(self, term: SystemTerm, each: ClassTerm, rule: Rule) -> None:
        """Check that a rule fits the kind of its system."""
        endless = rule.weight == float("inf")
        if term.kind == "sbrs" and endless != each.instantaneous and rule.weight is not None:
            message = f"the rate of '{rule.label}' is {rule.weight}, its class is "
            wanted = "instantaneous" if each.instantaneous else "not instantaneous"
            hint = "rules in '(...)' have the rate inf, those in '{...}' a finite one"
            self.findings.add("weight", message + wanted, each.span, hint)
        in_action = rule.name in self.names.actions
        if (term.kind == "nbrs") != in_action:
            message = f"'{rule.name}' is in {'an' if in_action else 'no'} action, in a {term.kind}"
            self.findings.add(
                "system", message, each.span, "rules of an nbrs, and only those, are in actions"
            )

    def predicates(self, call: Call) -> Iterator[Predicate]:
        for given, frame in self.instances(call):
            found = self.evaluation.named(call.name, given, call.span, frame)
            pattern = None if found is None else self.rules.as_pattern(found, call.span, CallFrame())
            reward = None if call.reward is None else self.rules.reward(call.reward)
            if pattern is not None:
                yield Predicate(call.name, pattern, reward, given, self.rules.position(call.span))


def check_declared(names: Names, scope: FileScope, evaluation: Evaluation, rules: RuleElaborator) -> None:
    """Evaluate every declaration without parameters, so that mistakes in unused ones are found too."""
    for name in names.constants:
        scope.constant(name)
    for big in names.all_bigs():
        given = scope.arguments(big.arguments, CallFrame())
        if not big.parameters and given is not None:
            evaluation.named(big.name, given, big.span, CallFrame())
    for react in names.all_reacts():
        given = scope.arguments(react.arguments, CallFrame())
        if not react.parameters and given is not None:
            rules.named(react.name, given, react.span, CallFrame())


def bigraphs_of(system: System) -> Iterator[Bigraph]:
    """Yield every bigraph of a system."""
    yield system.initial
    for rule in system.rules():
        yield rule.redex
        yield rule.reactum
        yield from (condition.pattern for condition in rule.conditions)
    yield from (predicate.pattern for predicate in system.predicates)


def with_signature(system: System, signature: Signature) -> System:
    """Return a system with all its bigraphs over one signature."""

    def widened(bigraph: Bigraph) -> Bigraph:
        return relabelled(bigraph, {}, signature)

    def within(rule: Rule) -> Rule:
        conditions = tuple(replace(each, pattern=widened(each.pattern)) for each in rule.conditions)
        return replace(rule, redex=widened(rule.redex), reactum=widened(rule.reactum), conditions=conditions)

    return replace(
        system,
        signature=signature,
        initial=widened(system.initial),
        classes=tuple(replace(each, rules=tuple(map(within, each.rules))) for each in system.classes),
        predicates=tuple(replace(each, pattern=widened(each.pattern)) for each in system.predicates),
    )


def _actions(classes: list[PriorityClass]) -> tuple[Action, ...]:
    found = {
        rule.action: Action(rule.action, rule.reward)
        for each in classes
        for rule in each.rules
        if rule.action is not None
    }
    return tuple(found.values())


def _end(text: str) -> Span:
    end = len(text.rstrip())
    return Span(max(0, end - 1), end)
