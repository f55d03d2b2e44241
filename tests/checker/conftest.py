import sys
from pathlib import Path

HERE = Path(__file__).parent
for folder in (HERE, HERE / "engines", HERE / "engines" / "cluster", HERE / "properties"):
    sys.path.insert(0, str(folder))  # for checked_missions, local_crew, naive_time, stale_by_definition
