"""Features of GeoJSON, as the files of worlds have them."""

import json


def feature(name, kind, coordinates, **properties):
    """Return a point, or a polygon where the coordinates are nested."""
    kind_of_geometry = "Point" if isinstance(coordinates[0], int | float) else "Polygon"
    geometry = {"type": kind_of_geometry, "coordinates": coordinates}
    return {"type": "Feature", "geometry": geometry, "properties": {"name": name, "kind": kind, **properties}}


def collection(*features):
    return json.dumps({"type": "FeatureCollection", "features": features})
