import sys
from pathlib import Path

HERE = Path(__file__).parent
# For checked_missions, everything_found, local_crew, naive_time, stale_by_definition.
for folder in (HERE, HERE / "engines", HERE / "engines" / "cluster", HERE / "properties", HERE / "reduction"):
    sys.path.insert(0, str(folder))
