"""What `bigactors big` decides, computes and writes about systems of bigraphs."""
