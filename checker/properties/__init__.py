"""Properties: the decision of questions about configurations and runs, the same for every engine."""
