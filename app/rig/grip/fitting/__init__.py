"""Fitting of grips: hands on an instrument by least squares, cached in files."""
