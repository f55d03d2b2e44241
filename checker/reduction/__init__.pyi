from .ample import Ample as Ample
from .ample import Proviso as Proviso
from .reducer import Reduced as Reduced
from .refusals import Reduction as Reduction
from .refusals import RefusedError as RefusedError
