"""The rows of an exploration, each once, and the loops that make, find and store them."""
