"""Data that an animator may edit: expressions, bodies, skeleton profiles, wind controllers."""
