"""What the words on the page of an assessment mean."""

from rockfrag.assess.answer import Assessment

_ALWAYS = {
    "90 % interval": "The range that holds the true value in 9 of 10 cases, by the uncertainties that are "
    "counted.",
    "Upper limit": "Where no motion topples the object: what so few earthquakes cannot exclude.",
    "Motion": "The recorded shaking of the ground by an earthquake at one place, in one horizontal direction.",
    "Pulse-like": "With one or two long, strong swings, as near the fault; they topple objects more easily.",
    "To rock": "To tilt from one edge of the base to the other without toppling.",
    "Planar": "In one vertical plane; a real object may also turn and walk.",
    "Restitution": "The speed of rotation after an impact of the base over that before it; 1 loses nothing.",
    "Fragility": "How the chance of toppling grows with the level of shaking.",
    "Lognormal curve": "The usual form of a fragility: given by its median and its dispersion β.",
}
_MEASURES = {
    "PGA": "Peak ground acceleration, as a part of gravity (g).",
    "PGV": "Peak ground velocity [cm/s]; it governs whether large objects topple.",
    "SA": "Spectral acceleration: the largest acceleration of a swing of that period with 5 % damping [g].",
}
_FLOOR = {
    "Level": "Floors counted from the ground, which is 0; the number of storeys is the roof.",
    "First period": "The time of one slow swing of the building [s].",
    "Damping": "How fast the building comes to rest; 0.05 is usual.",
}
_HAZARD = {
    "Hazard curve": "How often each level of shaking is exceeded at the site.",
    "Return period": "The mean time between two exceedances of a level of shaking.",
}


def words_used(found: Assessment) -> list[tuple[str, str]]:
    """Words of a page and what they mean, those that it uses, in alphabetical order."""
    words = dict(_ALWAYS)
    kinds = {"PGV", "PGA", found.measure.openquake}
    words |= {kind: meaning for kind, meaning in _MEASURES.items() if kind in kinds}
    if found.request.place.building is not None:
        words |= _FLOOR
    if found.hazard is not None:
        words |= _HAZARD
    return sorted(words.items(), key=lambda item: item[0].lower())
