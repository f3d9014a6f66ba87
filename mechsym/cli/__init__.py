"""The command line: argument parsing and one call per command. Each command's module is imported only when it runs."""

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import Any, NoReturn

import click

from mechsym.errors import BadInput
from mechsym.quantities import load

# command: "module:function"
COMMANDS = {
    "audit": "mechsym.cli.audit:audit",
    "cases": "mechsym.cli.catalogue:cases",
    "codesign": "mechsym.cli.codesign:codesign",
    "compare": "mechsym.cli.compare:compare",
    "cycle": "mechsym.cli.cycle:cycle",
    "derive": "mechsym.cli.derive:derive",
    "eval": "mechsym.cli.evaluate:evaluate",
    "export": "mechsym.cli.export:export",
    "fmu": "mechsym.cli.fmu:fmu",
    "flywheel": "mechsym.cli.flywheel:flywheel",
    "forces": "mechsym.cli.forces:forces",
    "guide": "mechsym.cli.guide:guide",
    "hinge": "mechsym.cli.hinge:hinge",
    "mechanisms": "mechsym.cli.catalogue:mechanisms",
    "native": "mechsym.cli.native:native",
    "new": "mechsym.cli.new:new",
    "optimise": "mechsym.cli.optimise:optimise",
    "page": "mechsym.cli.page:page",
    "reproduce": "mechsym.cli.reproduce:reproduce",
    "simulate": "mechsym.cli.simulate:simulate",
    "size": "mechsym.cli.size:size",
    "sweep": "mechsym.cli.sweep:sweep",
}


class _BrokenPipe(Exception):
    """A broken pipe under a name that click does not know: it would end with 1."""


@contextlib.contextmanager
def _pipe() -> Iterator[None]:
    try:
        yield
    except BrokenPipeError as error:
        raise _BrokenPipe(str(error)) from error


class LazyGroup(click.Group):
    """A group that knows its commands by name and imports a command's module on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names of all commands."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name.

        Returns
        -------
        command : click.Command or None
            None when there is no such command
        """
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = load(COMMANDS[cmd_name])
        if all(option.name != "strict" for option in command.params):
            command.params.append(
                click.Option(
                    ["--strict"],
                    is_flag=True,
                    expose_value=False,
                    callback=_strict,
                    help="Exit status 3 when there are doubts.",
                )
            )
        return command

    def make_context(self, *args: Any, **options: Any) -> click.Context:
        """Parse; help may be printed here."""
        with _pipe():
            return super().make_context(*args, **options)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; one that ends well and has doubts ends with 3 under --strict."""
        value = None
        try:
            with _pipe():
                value = super().invoke(ctx)
        except click.exceptions.Exit as ended:
            if ended.exit_code:
                raise
        if ctx.meta.get("mechsym.strict") and ctx.meta.get("mechsym.doubted"):
            ctx.exit(3)
        return value


def _strict(ctx: click.Context, _: click.Parameter, wanted: bool) -> None:
    ctx.meta["mechsym.strict"] = wanted


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(package_name="mechsym", prog_name="mechsym")
def mechsym() -> None:
    """From a mechanism on paper to verified machine code.

    \b
    Example: mechsym hinge zotov-89 --out demo
    """


def main() -> None:
    """Run the command line; bad input ends with one line and exit status 2, a failure of the system with 74."""
    try:
        sys.exit(mechsym.main(sys.argv[1:] or ["--help"], "mechsym", standalone_mode=False))
    except BadInput as error:
        print(f"mechsym: {' '.join(str(error).split())}", file=sys.stderr)
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "mechsym"
        print(f"mechsym: {error.format_message()} (see '{command} --help')", file=sys.stderr)
    except click.exceptions.Exit as error:
        sys.exit(error.exit_code)
    except (click.Abort, KeyboardInterrupt):
        print("mechsym: interrupted; files already named above are complete", file=sys.stderr)
        sys.exit(130)
    except (OSError, MemoryError, _BrokenPipe) as error:
        _failed(error)
    sys.exit(2)


def _failed(error: Exception) -> NoReturn:
    """End with one line and exit status 74: disk full, pipe or device broken, memory used up."""
    why = " ".join(str(error).split()) or "memory is used up"
    with contextlib.suppress(OSError):
        print(f"mechsym: the system failed: {why}", file=sys.stderr)
    for stream in filter(None, (sys.__stdout__, sys.__stderr__)):
        try:
            stream.flush()
        except OSError:
            # what is left in its buffer cannot be written at the end either
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    sys.exit(74)
