"""How a machine is put together: groups of links in order, each with the steps that solve it."""
