"""Tools of every run, of whatever matter: they know no case, no effect and no method."""
