"""Actions for evaluations in the editor's window."""
