"""slider_crank."""
