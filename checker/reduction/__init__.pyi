from .ample import Ample as Ample
from .reducer import Reduced as Reduced
from .refusals import Reduction as Reduction
from .refusals import RefusedError as RefusedError
