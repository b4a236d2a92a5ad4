"""Actions for dancers and choreographies in the editor's window."""
