"""Parts of a run, from its case to what it leaves behind."""
