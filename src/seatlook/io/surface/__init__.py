"""Surface files: foams and design surfaces in, OBJ out."""
