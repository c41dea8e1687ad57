from .answer import Assessment as Assessment, assess as assess
from .hazard.curve import HazardCurve as HazardCurve
from .hazard.curve import read_hazard as read_hazard
from .request import read_request as read_request
