"""BVH (Biovision hierarchy) files."""
