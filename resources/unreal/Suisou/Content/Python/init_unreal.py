"""Startup script that Unreal runs when the editor starts: it adds the menu."""

from suisou_import import menu

menu.register()
