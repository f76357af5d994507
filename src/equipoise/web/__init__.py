"""The live page: what a page asks, what it is sent, the local server and the notebook widget."""
