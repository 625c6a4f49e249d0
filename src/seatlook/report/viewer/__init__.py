"""The viewer in the page: the seat as triangles and tables, and the script that draws it."""
