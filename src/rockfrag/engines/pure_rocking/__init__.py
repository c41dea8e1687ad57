"""One or two bodies that rock and never slide: ensembles in lanes, single histories, and their kernels."""
