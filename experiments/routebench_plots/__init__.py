"""Figures and tables of a routebench experiment, from its database alone."""
