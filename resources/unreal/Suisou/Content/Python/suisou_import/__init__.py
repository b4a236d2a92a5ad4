"""Imports performances that Suisou exported into this project, and brings them up to date.

Nothing here has been run in Unreal by those who wrote it: it is checked against the documented API of Unreal Engine
5.6. Names from a piece are only ever data: they are shown, and never become code or a path.
"""
