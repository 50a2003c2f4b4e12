"""The methods by name. Nothing but names: the score needs no library."""

METHODS = ("sindy", "gp", "narx", "latent", "operon", "refit")
# Told that a law is missing, and where, and for the bench alone: they answer only if they are named.
TOLD = ("ude",)
