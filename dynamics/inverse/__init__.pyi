from .events import Event as Event
from .events import OneOf as OneOf
from .events import Ranged as Ranged
from .identifying import identify as identify
from .pairs import PairScan as PairScan
from .pairs import by_two_events as by_two_events
from .report import Candidate as Candidate
from .report import Identification as Identification
