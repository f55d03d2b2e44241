"""The studio: one screen to write a mission, to step through it, and to watch it."""
