"""Effects within a liquid."""
