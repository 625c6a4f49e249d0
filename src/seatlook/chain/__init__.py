"""The whole chain: scene, cover, solution, assessment, pictures."""
