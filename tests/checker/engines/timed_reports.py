"""Reports of missions with times, compared between engines."""


def assert_alike(report, other):
    """Look whether two engines report the same, but for what they have searched."""
    assert report.verdicts == other.verdicts
    assert list(map(without_effort, report.notes)) == list(map(without_effort, other.notes))
    assert (report.configurations, report.transitions, report.depth, report.rules) == (
        other.configurations,
        other.transitions,
        other.depth,
        other.rules,
    )
    assert report.coverage == other.coverage
    assert report.schedule == other.schedule


def without_effort(note):
    return note.partition("in ticks")[2] or note
