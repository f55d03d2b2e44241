"""The three steps of a stale-observation race in a run: when it was sensed, who changed the answer, who acted on it."""

from checker.properties.races import is_stale, used_slots
from checker.traces import Trace
from semantics.behaviours.queries import resolve
from semantics.races.monitor import CONTROLS, asked_again
from semantics.races.provenance import Dependency, Key
from semantics.state.requests import CTR, FLY, OBS


def stale_steps(trace: Trace) -> tuple[str, ...]:
    """Return in words the three steps of a race that a monitored run ends in; nothing where they are not found."""
    if len(trace) == 0 or not isinstance(trace.steps[-1].label.about, CTR | FLY):
        return ()
    c, request = trace.configurations[-2], trace.steps[-1].label.about
    pending = next((each for each in c.eta.in_line(request.agent) if each.request == request), None)
    stale = is_stale(c, pending) if pending is not None and c.setting.monitored else ()
    if pending is None or not stale:
        return ()
    found = _sensed_and_changed(trace, stale[0], used_slots(c, pending))
    if found is None:
        return ()
    sensed, changed = found
    by = trace.steps[changed].label.agent
    words = (("sensed", sensed), (f"changed by {by}", changed), ("acted on", len(trace) - 1))
    return tuple(f"{what} in step {at + 1}: {trace.steps[at].label}" for what, at in words)


def _sensed_and_changed(trace: Trace, stale: Dependency, used: frozenset[Key]) -> tuple[int, int] | None:
    """Return the latest step that sensed it and after which another's step has changed it, and that one."""
    whole, holder = trace.configurations, trace.steps[-1].label.agent
    keys = used | {stale.asked} if stale.asked is not None else used
    for sensed in reversed(range(len(trace))):
        about = trace.steps[sensed].label.about
        if (
            trace.steps[sensed].label.rule != "sense"
            or not isinstance(about, OBS)
            or about.query != stale.query
        ):
            continue
        steps = resolve(about.query, whole[sensed].structure.physical, whole[sensed].alpha)
        for at in range(sensed + 1, len(trace)):
            label = trace.steps[at].label
            if label.rule in CONTROLS and label.agent != holder:
                again = asked_again(whole[at], whole[at + 1], steps, keys)
                if again.changed & keys:
                    return sensed, at
                steps = again.steps
    return None
