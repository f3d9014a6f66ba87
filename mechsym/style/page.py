"""Pages of every room: one sheet of styles for light, dark, narrow and printed pages, one way to fill a template."""

from collections.abc import Callable, Mapping
from importlib import resources
from typing import Any

from mechsym.style.numbers import significant


def page(
    template: str, filters: Mapping[str, Callable[..., Any]] | None = None, missing: str = "Strict", **shown: Any
) -> str:
    """A page as text; a template takes the common styles with `include "page.css"`.

    Parameters
    ----------
    template : str
        Name of a file in `mechsym/templates`
    missing : str
        What a name that is not given is: an error (`Strict`), or empty with all that is in it (`Chainable`)
    """
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(_source), undefined=getattr(jinja2, f"{missing}Undefined"), autoescape=True,
        trim_blocks=True,
    )  # fmt: skip
    environment.filters |= {"sig": significant, **(filters or {})}
    return environment.get_template(template).render(**shown)


def _source(name: str) -> str:
    return (resources.files("mechsym") / "templates" / name).read_text(encoding="utf-8")
