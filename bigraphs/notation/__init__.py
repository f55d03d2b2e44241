"""Texts of bigraphs, read and written; each notation is one module."""
