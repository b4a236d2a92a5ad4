"""Fitting a grip: hands on an instrument by least squares, kept in files."""
