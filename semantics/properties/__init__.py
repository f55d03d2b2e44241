"""Formulas about configurations and about runs."""
