"""Binary FBX, both ways: bytes, elements, scenes of bones, skinned meshes and one clip."""
