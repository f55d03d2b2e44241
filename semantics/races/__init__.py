"""Stale observations: the provenance of controls, and other agents' changes to it since."""
