"""Recording: the cells that a rule reads and writes, and the columns into which their values are split."""
