"""Drawing of dances, shared by several panels."""
