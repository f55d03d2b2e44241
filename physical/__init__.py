"""The physical model: geometry, altitude and channels of entities on the WGS 84 earth, and their motion.

It reads and writes GeoJSON, waypoint files and plans. It knows nothing of bigraphs, agents or missions. AIS
recordings are read by `physical.ais_receiver` and its neighbours, which need the extra `ais`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
