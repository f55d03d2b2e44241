"""Admission of agents from other stations: whether the text of a mission can have produced them."""
