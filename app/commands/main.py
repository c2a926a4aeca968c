"""The command line: one module a noun, loaded when it is used, errors as one sentence and an exit code."""

from __future__ import annotations

import errno
import signal
import sys
import threading
import traceback

import click

from app.commands.lazy import LazyGroup
from app.model.values import ModelError
from imitation.errors import Cancelled, InputError, NoSolution

DONE, USAGE, BAD_INPUT, NO_SOLUTION, BUG, STOPPED = 0, 2, 3, 4, 5, 130
REFUSALS = (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENAMETOOLONG, errno.ENOSPC, errno.EDQUOT, errno.EIO)
"""What the system refuses for reasons that lie outside the program."""

VERBS = {
    "demo": "app.commands.demo:demo",
    "gui": "app.commands.gui:gui",
    "install-desktop": "app.commands.desktop:install_desktop",
    "new": "app.commands.project:new",
    "set": "app.commands.project:set_",
    "info": "app.commands.project:info",
    "check": "app.commands.check:check",
    "cameras": "app.commands.solve:cameras",
    "depth": "app.commands.depth:depth",
    "plate": "app.commands.depth:plate",
    "track": "app.commands.solve:track",
    "contacts": "app.commands.solve:contacts",
    "animate": "app.commands.solve:animate",
    "render": "app.commands.output:render",
    "compare": "app.commands.output:compare",
    "export": "app.commands.output:export",
    "perform": "app.commands.perform:perform",
}


@click.group(
    cls=LazyGroup, verbs=VERBS, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100}
)
@click.version_option(package_name="motionwright", prog_name="motionwright")
@click.option("--json", "as_json", is_flag=True, help="Answer in JSON, for machines.")
@click.option("--quiet", is_flag=True, help="Say nothing but errors.")
@click.option("--debug", is_flag=True, help="Show where an error came from.")
@click.pass_context
def cli(ctx: click.Context, as_json: bool, quiet: bool, debug: bool) -> None:
    """Take motion from where it was filmed or captured and make new animation of it."""
    from app.commands.console import Console

    ctx.obj = Console(as_json=as_json, quiet=quiet)


def run(arguments: list[str]) -> int:
    """Run the command line and give its exit code."""
    debug = "--debug" in arguments
    try:
        cli.main(args=arguments, prog_name="motionwright", standalone_mode=False)
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except click.ClickException as error:
        error.show()
        return USAGE
    except (Cancelled, KeyboardInterrupt, click.Abort):
        return _say("Stopped. What was finished is kept; the same command goes on from there.", STOPPED, debug)
    except (InputError, ModelError) as error:
        return _say(str(error), BAD_INPUT, debug)
    except NoSolution as error:
        return _say(str(error), NO_SOLUTION, debug)
    except BrokenPipeError:
        sys.stderr.close()
        return DONE
    except OSError as error:
        if error.errno not in REFUSALS or error.filename is None:
            return _bug(error, debug)
        return _say(f"{error.filename} cannot be used: {error.strerror}.", BAD_INPUT, debug)
    except Exception as error:  # noqa: BLE001 - a person gets a sentence, not a traceback
        return _bug(error, debug)
    return DONE


def main() -> None:
    """Enter from the command line."""
    check_engine()
    if "gui" not in sys.argv:
        end_as_interrupted()
    raise SystemExit(run(sys.argv[1:]))


def end_as_interrupted() -> None:
    """Let a request to end (SIGTERM: a shutdown, a job manager) stop the work as Ctrl+C does.

    A thread waits for it instead of a handler: a library that is loaded later (pycolmap) sets its own, which prints the
    machine's stack. For a program without a window, before its other threads begin.
    """
    if not hasattr(signal, "pthread_sigmask"):
        return  # Windows has no such request
    main_thread = threading.main_thread().ident
    assert main_thread is not None
    interrupt = signal.SIGINT
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        # Begun in the background of a script, where Ctrl+C is meant for others.
        interrupt = signal.SIGUSR1
        signal.signal(interrupt, signal.default_int_handler)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTERM})

    def wait() -> None:
        signal.sigwait({signal.SIGTERM})
        signal.pthread_kill(main_thread, interrupt)

    threading.Thread(target=wait, name="end", daemon=True).start()


def gui_main() -> None:
    """Enter from a desktop, without a console."""
    check_engine()
    raise SystemExit(run(["gui", "--empty", *sys.argv[1:]]))


def check_engine() -> None:
    """Say so when a distribution of the same name hides our engine."""
    import imitation

    if not hasattr(imitation, "CameraPath"):
        where = getattr(imitation, "__file__", "an unknown place")
        _say(
            f"Another package called imitation ({where}) hides Motionwright's engine: "
            "install Motionwright in an environment of its own.",
            BAD_INPUT,
            debug=False,
        )
        raise SystemExit(BAD_INPUT)


def _bug(error: Exception, debug: bool) -> int:
    said = f"{type(error).__name__}: {error}"
    return _say(f"Motionwright has a bug ({said}); run again with --debug and report what it prints.", BUG, debug)


def _say(sentence: str, code: int, debug: bool) -> int:
    if debug and sys.exc_info()[0] is not None:
        traceback.print_exc()
    click.echo(sentence, err=True)
    return code


if __name__ == "__main__":
    main()
