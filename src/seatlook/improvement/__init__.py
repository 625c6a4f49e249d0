"""A pattern changed a little: solved from the last balance, ranked by gain, corrected in mm."""
