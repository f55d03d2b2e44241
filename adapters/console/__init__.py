"""The operator's console: a reader of a recording, which may still be written, and what it shows in browsers.

Nothing here knows of a run but what its recording says, so that a console can neither slow a run nor end it.
"""
