"""Logical-space programming."""

__version__ = "0.1.0"
