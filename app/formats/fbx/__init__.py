"""Binary FBX: encoder, decoder, elements and a text dump."""
