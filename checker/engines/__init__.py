"""Engines: ways to visit all that can be reached. `contract` says what they share, `choose` which one runs."""
