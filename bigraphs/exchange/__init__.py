"""Bigraphs in the files of other tools: the Bigraph Framework's XMI."""
