from .events import Event as Event
from .events import OneOf as OneOf
from .events import Ranged as Ranged
from .identifying import identify as identify
from .report import Candidate as Candidate
from .report import Identification as Identification
