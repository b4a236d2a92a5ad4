"""Attacks on everything that reads: seeds, mutators, the readers, a child process that runs and measures them."""
