"""Curves that move the instruments' controls (keys, valves, slides) and the players' fingers."""
