"""People made from a finished body: phenotypes, shapes, what is worn, and characters of them."""
