"""One performance to files: characters, instruments and the report."""
