from .canvas import Canvas as Canvas
from .canvas import Paint as Paint
from .canvas import Point as Point
from .canvas import Words as Words
from .picture import Picture as Picture
from .picture import PictureError as PictureError
from .widths import shortened as shortened
from .widths import text_width as text_width
