from .models import dumps as dumps
from .models import examples as examples
from .models import json_schema as json_schema
from .models import load as load
from .models import loads as loads
from .models import save as save
from .records import read_accelerations as read_accelerations
from .records import read_record as read_record
from .studies import load_study as load_study
from .study_units import machine_of as machine_of
from .study_units import resume as resume
from .template import Template as Template
from .tools import dumps_tool as dumps_tool
from .tools import load_tool as load_tool
from .tools import loads_tool as loads_tool
from .tools import save_tool as save_tool

SCHEMA_VERSION: int
