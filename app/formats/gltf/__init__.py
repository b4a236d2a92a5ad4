"""glTF 2.0 and VRM files -> plain values."""
