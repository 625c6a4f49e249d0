"""Results of other programs: from shells with strains to indices and a cover that can be drawn."""
