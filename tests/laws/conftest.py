from hypothesis import settings

# The first call of a law compiles it, which no deadline foresees; the same examples in every run.
settings.register_profile("laws", deadline=None, max_examples=60, derandomize=True)
settings.load_profile("laws")
