"""Properties: what is asked of configurations and runs, whichever engine visits them."""
