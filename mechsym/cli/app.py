"""`mechsym app`: the workbench in the browser."""

import click

from mechsym.cli.common import emit, json_option


@click.command(short_help="The workbench in the browser: sliders, verdict, runs.")
@click.argument("case_name", metavar="[CASE]", default="zotov-89")
@click.option("--port", type=click.IntRange(0, 65535), default=8080, show_default=True, help="Port on this machine.")
@click.option("--check", "checked", is_flag=True, help="Start it, read its page without a browser, and end.")
@json_option
def app(case_name: str, port: int, checked: bool) -> None:
    """Move the values of CASE with sliders and see at once whether its hinge can be built; run commands on it.

    It listens on this machine alone (127.0.0.1), and answers the browser that opens the address it prints, which holds
    a token; pages from elsewhere are refused. The address in the browser then holds the values, so it can be kept.
    Needs the extra `app`.

    \b
    Example: mechsym app zotov-89 --port 8080
    """
    from mechsym.app import check, serve

    if checked:
        answer = check(case_name, 0)
        words = f"the workbench of {answer['case']} answers: {answer['sliders']} sliders, {', '.join(answer['tabs'])}"
        hinge = "" if answer["hinge"] is None else f"; hinge: {answer['hinge']}"
        emit(answer, lambda: words + hinge)
    else:
        serve(case_name, port, lambda address: click.echo(f"{address}  (Ctrl-C ends it)", err=True))
