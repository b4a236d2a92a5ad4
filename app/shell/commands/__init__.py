"""What the actions of the editor do: each module declares rows of the one table (`app.shell.actions`)."""
