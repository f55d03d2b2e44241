"""Questions to all rows of a search: findings, formulas, and the graph of its transitions."""
