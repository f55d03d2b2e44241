"""Reports: the results of a check as text, as lanes, and in the formats of other programs."""
