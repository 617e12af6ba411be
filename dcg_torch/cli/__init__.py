"""The command line: Hydra's schemas and errors, the terminal."""
