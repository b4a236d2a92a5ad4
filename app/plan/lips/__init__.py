"""Plans the embouchure (lips) and the tonguing of every note."""
