"""Everything that a report shows replays: each trace and witness, step by step, in turn and at its dates."""

import json

from checker import replay, to_json


def shown(report):
    """Return the traces and witnesses of a report, each with the name of its property."""
    for verdict in report.verdicts:
        yield from ((verdict.property.name, each.trace) for each in verdict.violations)
        if verdict.witness is not None:
            yield verdict.property.name, verdict.witness


def assert_replays(report):
    """Replay whatever a report shows, from plain data."""
    for name, trace in shown(report):
        data = json.loads(json.dumps(to_json(trace, "", "")))
        assert replay(trace.initial, data) == trace, name
