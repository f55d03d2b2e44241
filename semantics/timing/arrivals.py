"""Arrivals: the flights whose end is promised, by an `arriving` kind or by an upper time bound."""

from semantics.behaviours.reaction_rules import moved
from semantics.state.configuration import Configuration, Transition
from semantics.state.requests import FLY
from semantics.state.setting import Setting


def is_unfair(c: Configuration, transition: Transition) -> bool:
    """Return whether a transition is the end of a flight without a promise to arrive."""
    if transition.served is None or not never_ends(c.setting, transition.served.request):
        return False
    return not _arrives_in_time(c, transition.served.request)


def _arrives_in_time(c: Configuration, request: object) -> bool:
    """Return whether a request is a flight with an upper time bound."""
    if c.setting.timing is None or not isinstance(request, FLY):
        return False
    from semantics.timing.flight_times import interval_of_flight  # noqa: PLC0415 - geometry takes its time to load

    return interval_of_flight(c, request).hi is not None


def never_ends(setting: Setting, request: object) -> bool:
    """Return whether a request is a flight without a promise to arrive."""
    if not isinstance(request, FLY):
        return False
    return not all(node in setting.arriving for node, _ in moved(request.reaction, request.match))
