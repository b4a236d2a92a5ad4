"""Reading and writing of BVH (Biovision hierarchy) motion files."""
