import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))  # for checked_missions
sys.path.insert(0, str(Path(__file__).parent / "cluster"))  # for local_crew
