"""The physical model: geometry, altitude and channels of entities on the WGS 84 earth, and their motion.

The package reads and writes GeoJSON, waypoint files and plans. It does not depend on bigraphs, agents or missions.
`physical.ais_receiver` and its neighbours read AIS recordings, which need the extra `ais`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
