"""What can be said of configurations and of runs, as formulas."""
