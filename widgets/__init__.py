"""The panels of the editor; each is a room of its own and only `common` is shared. The shell connects them."""
