"""moroianu2017."""
