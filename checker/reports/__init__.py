"""Reports: what a check found, as text, lanes and the formats of other programs."""
