"""Whether the text of a mission can produce an agent that comes from another station."""
