"""Configurations ⟨α | S | η⟩ as values: cells, the views over them, and how they are printed, compared and written."""
