"""Explore missions with times by zones: sets of ages of the clocks that run, beside each configuration."""
