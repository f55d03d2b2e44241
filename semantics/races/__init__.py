"""Stale observations: what a control rests on, and what other agents have changed in it since."""
