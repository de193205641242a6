"""Version of the package, which a checkpoint holds too."""

__version__ = "0.1.0"
