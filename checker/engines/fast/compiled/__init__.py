"""The compilation of loops, and the arrays that they read, for every part of the fast engine."""
