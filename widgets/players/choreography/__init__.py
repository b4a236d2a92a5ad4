"""The section of the dancers in the players' panel."""
