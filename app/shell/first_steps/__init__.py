"""First steps: a tour of five stops on the bundled quartet, each of which waits until the user has done its task."""
