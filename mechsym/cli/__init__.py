"""The command line: argument parsing and one call per command. Each command's module is imported only when it runs."""

import contextlib
import gc
import os
import sys
from collections.abc import Callable, Iterator
from typing import Any, NoReturn

import click

# before numpy is there: threads of BLAS would wait for small matrices with a processor each
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from mechsym import __version__, interrupts  # noqa: E402
from mechsym.errors import BadInput, suggest  # noqa: E402
from mechsym.quantities import load  # noqa: E402
from mechsym.transaction import forget  # noqa: E402

# commands by what they are for, in the order of `mechsym --help`
GROUPS = {
    "Start": ("new", "check", "cases", "sections", "mechanisms"),
    "Analyse": ("cycle", "forces", "balance", "flywheel", "simulate", "identify", "eval"),
    "Design": ("hinge", "codesign", "size", "optimise", "guide"),
    "Many": ("sweep", "study", "compare"),
    "Give": ("report", "app", "page", "fmu", "export"),
    "Verify": ("audit", "reproduce", "prove", "derive", "native", "cite"),
}
# a command stands in the file of its name, but for these
_ELSEWHERE = {"page": "export:page", "fmu": "export:fmu", "eval": "evaluate:evaluate"} | {
    name: f"catalogue:{name}" for name in ("cases", "cite", "mechanisms", "native", "sections")
}
COMMANDS = {
    name: f"mechsym.cli.{_ELSEWHERE.get(name, f'{name}:{name}')}" for group in GROUPS.values() for name in group
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

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The commands with one line each, by what they are for."""
        width = max(map(len, COMMANDS))
        for title, names in GROUPS.items():
            commands = [(name.ljust(width), self.get_command(ctx, name)) for name in names]
            with formatter.section(title):
                formatter.write_dl([(name, one.get_short_help_str(100)) for name, one in commands if one])

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of that name. Returns command: None when there is no such command."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = load(COMMANDS[cmd_name])
        for argument in command.params:
            if isinstance(argument, click.Argument) and argument.name in ("case", "case_name", "cases"):
                argument._custom_shell_complete = _cases_and_files
        if all(option.name != "strict" for option in command.params):
            command.params += _everywhere()
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that is asked for; one that is not there is refused with the nearest."""
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            ctx.fail(f"command {args[0]!r} is not known; {suggest(args[0], sorted(COMMANDS))}")
        name, command, rest = super().resolve_command(ctx, args)
        if command is not None:
            _refuse_twice(ctx, command, rest)
        ctx.meta["mechsym.words"] = tuple(rest)
        return name, command, rest

    def make_context(self, *args: Any, **options: Any) -> click.Context:
        """Parse; help may be printed here."""
        with _pipe():
            return super().make_context(*args, **options)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; one that ends well with doubts or a missed target ends with 3 under --strict."""
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


def _refuse_twice(ctx: click.Context, command: click.Command, args: list[str]) -> None:
    """Refuse an option that is given again: the first one would be lost without a word."""
    own = click.Context(command, parent=ctx, **command.context_settings)
    try:
        _, _, given = command.make_parser(own).parse_args(args=list(args))
    except click.UsageError:
        return  # the command says it with its own usage
    once = [o for o in given if isinstance(o, click.Option) and not (o.multiple or o.is_flag or o.count)]
    for option in once:
        if once.count(option) > 1:
            ctx.fail(f"{option.opts[-1]} is given {once.count(option)} times; it takes one value")


def _cases_and_files(ctx: click.Context, param: click.Parameter, typed: str) -> list[Any]:
    """What a shell offers for CASE: built-in cases, and files."""
    from click.shell_completion import CompletionItem

    from mechsym import cases

    items = [CompletionItem(name) for name in cases.names() if name.startswith(typed)]
    return items or [CompletionItem(typed, type="file")]


def _everywhere() -> list[click.Parameter]:
    """Options of every command; what they say stands in `ctx.meta`."""

    def option(name: str, then: Callable[[click.Context, Any], object], **more: Any) -> click.Option:
        def noted(ctx: click.Context, _: click.Parameter, wanted: Any) -> None:
            ctx.meta[f"mechsym.{name.replace('-', '_')}"] = wanted
            then(ctx, wanted)

        return click.Option([f"--{name}"], expose_value=False, callback=noted, **more)

    def guard(ctx: click.Context, wanted: bool) -> None:
        if not ctx.resilient_parsing:
            ctx.with_resource(load("mechsym.files.trust:guarded")(ctx.meta.get("mechsym.words", ()), wanted))

    show = 'Show text and CSV in these, e.g. "mm, bar, kN, deg"; JSON stays SI.'
    return [
        option("strict", lambda ctx, wanted: None, is_flag=True,
               help="Exit status 3 when there are doubts, or a target is missed."),
        option("units", lambda ctx, wanted: load("mechsym.quantities.display:choose")(wanted), metavar="LIST",
               is_eager=True, help=show),
        option("with-units", lambda ctx, wanted: None, is_flag=True, hidden=True),
        option("trust", guard, is_flag=True,
               help="Run the Python file that a case names, wherever it lies; kept for its folder."),
    ]  # fmt: skip


@click.group(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(__version__, prog_name="mechsym")
def mechsym() -> None:
    """From a mechanism on paper to verified machine code.

    \b
    Example: mechsym hinge zotov-89 --out demo

    Your own engine: mechsym new engine --kind inline --bore "86 mm" --stroke "86 mm"; then mechsym check FILE.
    Completion of commands, options and cases: eval "$(_MECHSYM_COMPLETE=bash_source mechsym)" in ~/.bashrc
    (zsh_source, fish_source).
    """


def main() -> None:
    """Run the command line; bad input ends with one line and exit status 2, a failure of the system with 74."""
    # what imports and figures leave is little: look for it rarely
    gc.set_threshold(20_000)
    try:
        with interrupts.within_a_second(forget):
            sys.exit(mechsym.main(sys.argv[1:] or ["--help"], "mechsym", standalone_mode=False))
    except BadInput as error:
        print(f"mechsym: {' '.join(str(error).split())}", file=sys.stderr)
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "mechsym"
        print(f"mechsym: {error.format_message()} (see '{command} --help')", file=sys.stderr)
    except click.exceptions.Exit as error:
        sys.exit(error.exit_code)
    except (click.Abort, KeyboardInterrupt):
        print(interrupts.WORDS, file=sys.stderr)
        sys.exit(interrupts.STATUS)
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
