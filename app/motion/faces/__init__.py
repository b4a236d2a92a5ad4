"""Curves that move the players' faces and eyes."""
