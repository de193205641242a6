"""What a run is made of, from its case to what it leaves behind."""
