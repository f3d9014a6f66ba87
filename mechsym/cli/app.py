"""`mechsym app`: the workbench in the browser."""

import click


@click.command(short_help="The workbench in the browser: sliders, verdict, runs.")
@click.argument("case_name", metavar="[CASE]", default="zotov-89")
@click.option("--port", type=click.IntRange(0, 65535), default=8080, show_default=True, help="Port on this machine.")
@click.option("--check", "checked", is_flag=True, help="Start it, read its page without a browser, and end.")
def app(case_name: str, port: int, checked: bool) -> None:
    """Move the values of CASE with sliders and see at once whether its hinge can be built; run commands on it.

    It listens on this machine alone (127.0.0.1). The address in the browser holds the values, so it can be kept.
    Needs the extra `app`.

    \b
    Example: mechsym app zotov-89 --port 8080
    """
    from mechsym.app import check, serve

    if checked:
        click.echo(check(case_name, 0))
    else:
        click.echo(f"http://127.0.0.1:{port}/  (Ctrl-C ends it)", err=True)
        serve(case_name, port)
