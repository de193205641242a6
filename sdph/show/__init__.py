"""What shows a run: pictures, movies, pages."""
