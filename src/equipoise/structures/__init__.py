"""What is shaken: the support of a machine on its mounts, free, forced and coupled."""
