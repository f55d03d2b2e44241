"""Explore missions with times by zones: sets of clock values, kept for each configuration."""
