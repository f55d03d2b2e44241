"""Configurations ⟨α | S | η⟩ as values: cells, views over them, printing, comparison and serialization."""
