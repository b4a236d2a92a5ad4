"""Bytes of BVH, FBX and glTF, both ways; knows no scene of ours."""
