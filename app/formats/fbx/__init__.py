"""Reads and writes binary FBX: bytes, elements, scenes of bones, skinned meshes and one clip."""
