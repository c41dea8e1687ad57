"""What could produce an effect of a pedestal: perturbed parameters, one at a time and two together."""
