"""What surfaces reflect: BRDF, tables, relief by formula and measured maps."""
