"""Effects on solids."""
