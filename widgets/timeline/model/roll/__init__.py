"""Notes and entries as the piano roll shows them."""
