"""A case: its sections, how it is read and checked, which effects it calls for."""
