"""What every run stands on, whatever it is of: it knows no case, no effect and no method."""
