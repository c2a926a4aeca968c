"""The command line: one module a noun, loaded when it is used, errors as one sentence and an exit code."""

from __future__ import annotations

import sys
import traceback

import click

from app.commands.lazy import LazyGroup
from app.model.values import ModelError
from imitation.errors import Cancelled, InputError, NoSolution

DONE, USAGE, BAD_INPUT, NO_SOLUTION, BUG, STOPPED = 0, 2, 3, 4, 5, 130

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
    except Exception as error:  # noqa: BLE001 - a person gets a sentence, not a traceback
        said = f"{type(error).__name__}: {error}"
        return _say(f"Motionwright has a bug ({said}); run again with --debug and report what it prints.", BUG, debug)
    return DONE


def main() -> None:
    """Enter from the command line."""
    check_engine()
    raise SystemExit(run(sys.argv[1:]))


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


def _say(sentence: str, code: int, debug: bool) -> int:
    if debug and sys.exc_info()[0] is not None:
        traceback.print_exc()
    click.echo(sentence, err=True)
    return code


if __name__ == "__main__":
    main()
