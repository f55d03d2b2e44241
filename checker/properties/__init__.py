"""Properties: the questions about configurations and runs, the same for every engine."""
