"""The compiled form of the reductions: ample sets with their cycle proviso, and the tables of symmetry."""
