"""Answers about durations: by whole ticks (digital clocks) and by zones."""
