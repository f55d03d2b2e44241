"""Static analysis: the facts about all runs that the text of a mission shows."""
