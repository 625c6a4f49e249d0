"""Lines of a drawing joined to outlines of panels, with notches and cuts."""
