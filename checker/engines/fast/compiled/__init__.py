"""Compiled loops and the arrays that they read: what every part of the fast engine uses."""
