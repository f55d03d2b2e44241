"""BigMC's language, used by the paper's first runtime: `.bgm` text → syntax → a system with properties."""
