"""First steps: a tour of five stops on the bundled quartet, which waits at each until the user has done it."""
