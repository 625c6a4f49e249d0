"""A guess at which edges of a pattern are sewn together, by evidence, with its probability.

A pattern file says nothing about sewing. Lengths, notches, curves, grain, names and symmetry say
how likely two edges are sewn; the corners that meet round each point of the sewn cover say which
pairs go together. The likeliest cover is searched; see docs/method/seam-guess.md.
"""

from seatlook.assembly.seam_guess.proposal import SURE, Doubtful, Proposal, propose_seams

__all__ = ["SURE", "Doubtful", "Proposal", "propose_seams"]
