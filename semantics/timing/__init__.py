"""Time: the values of a mission's `timing` section, and the clocks that it compares; independent of search."""
