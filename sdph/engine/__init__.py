"""The engine: what knows no case, no effect and no method."""
