"""One page that shows an experiment, and the viewer of its routes."""
