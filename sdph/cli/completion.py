"""`sdph completion SHELL`: a script by which a shell completes commands, options, scenes and files."""

from __future__ import annotations

import argparse

from sdph import scenes

TARGETS = ("target", "scene", "run", "runs", "folder", "out")  # arguments that name scenes or places
PREAMBLE = {
    "bash": '_sdph_targets() {{ compgen -W "{names}" -- "$1"; compgen -f -- "$1"; }}',
    "zsh": "_sdph_targets() {{ _alternative 'scenes:scene:({names})' 'files:file:_files' }}",
}


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The script of a shell, bash or zsh."""
    import shtab

    for command in (parser, *_commands(parser)):
        for action in command._actions:
            if action.dest in TARGETS and action.choices is None:
                action.complete = dict.fromkeys(PREAMBLE, "_sdph_targets")
    own = {name: text.format(names=" ".join(scenes.names())) for name, text in PREAMBLE.items()}
    return shtab.complete(parser, shell=shell, preamble=own)


def _commands(parser: argparse.ArgumentParser) -> list[argparse.ArgumentParser]:
    return [
        command
        for action in parser._actions
        if isinstance(action, argparse._SubParsersAction)
        for command in action.choices.values()
    ]
