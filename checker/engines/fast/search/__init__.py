"""The search: rows are expanded in batches and chunks, by the learned rules, in any number of threads."""
