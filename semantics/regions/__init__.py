"""Regions: all points where an entity may be while a configuration lasts, at rest and on its way.

A region depends on the mission's text and on P alone, and on the flights in η: nothing is remembered, and L is never
read. Properties ask for regions; no rule reads them.
"""
