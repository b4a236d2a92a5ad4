"""The 3D viewport; the only room that knows vispy."""
