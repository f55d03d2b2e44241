"""Time: what a mission's `timing` section comes to, and the clocks that it compares; knows nothing of search."""
