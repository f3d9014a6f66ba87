"""The rodless mechanism with its link held by constraints: letters, numbers and drawing are those of the other."""

from mechsym.mechanisms.rodless import RodlessParameters, drawing
from mechsym.mechanisms.traits import Traits

TRAITS = Traits(parameters=RodlessParameters, drawing=drawing)
