"""People made from a bundled body: phenotypes, body shapes, clothes and hair, and the resulting characters."""
