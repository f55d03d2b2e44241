"""Behaviours: values, expressions, queries, reactions and statements, and the internal computation of `fun`."""
