"""Plans the players' facial expressions and glances."""
