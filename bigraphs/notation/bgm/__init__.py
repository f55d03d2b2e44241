"""BigMC's language, that of the paper's first runtime: `.bgm` text → syntax → a system with properties."""
