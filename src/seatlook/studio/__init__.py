"""A local web application: the files of a scene with hands."""
