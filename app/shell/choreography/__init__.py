"""What the window does with dancers and choreographies."""
