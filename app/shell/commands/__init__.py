"""Actions of the editor: each module declares rows of the one table (`app.shell.actions`)."""
