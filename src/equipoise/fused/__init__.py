"""Many designs at once: loops over designs and crank angles, written out from the steps."""
