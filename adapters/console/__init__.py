"""The operator's console: it reads a recording, which may still be written, and shows it in browsers.

Its only source about a run is the recording, so that a console can neither slow a run nor end it.
"""
