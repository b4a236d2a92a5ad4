"""Reading and writing bytes of BVH, FBX and glTF, independent of the program's scenes."""
