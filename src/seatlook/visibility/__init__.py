"""How visible the wrinkles of a solved cover are to people."""
