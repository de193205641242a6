"""Views of a run: pictures, movies, pages."""
