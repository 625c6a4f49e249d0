"""The outline of a panel, and the mesh that follows it."""
