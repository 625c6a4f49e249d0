"""Every kind of change that can be clicked, each as a line in a TOML file."""
