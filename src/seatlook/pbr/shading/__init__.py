"""From a solved cover to radiance: the drawn surface, indirect light, and the studio."""
