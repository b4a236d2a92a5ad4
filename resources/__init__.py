"""Characters, instrument models, example pieces and the scripts that make them."""
