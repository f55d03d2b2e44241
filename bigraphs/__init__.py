"""bigraphs."""
