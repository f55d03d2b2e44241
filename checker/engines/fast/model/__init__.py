"""The learned rules: decision trees over columns, with transitions at their leaves."""
