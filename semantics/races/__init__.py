"""Stale observations: what a control rests on, and what others have changed in it since."""
