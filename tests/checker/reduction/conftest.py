import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))  # for checked_missions and mission_texts
sys.path.insert(0, str(Path(__file__).parent))  # for everything_found
