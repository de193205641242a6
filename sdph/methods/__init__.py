"""Methods: what moves particles of one kind, on top of the engine. They do not know each other."""
