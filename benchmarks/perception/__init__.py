"""How fast and how well clouds become polygons."""
