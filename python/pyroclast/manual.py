"""The manual page, and the completions of bash and zsh: `pyroclast manual`, `pyroclast completion bash|zsh`.

All are written from the command lines themselves: the program tells its own as JSON (`pyroclast commands`), the
commands of the package are read from their parsers. The compiled part of the package is not needed.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field

from . import figures, watch
from .report.command_line import parser as report_parser
from .study.command_line import parser as study_parser

_OF_PACKAGE = {"figures": figures.parser, "report": report_parser, "watch": watch.parser, "study": study_parser}


@dataclass(frozen=True)
class Option:
    """An option, or an argument where `names` is empty."""

    names: tuple[str, ...]
    meaning: str
    value: str = ""  #: name of the value that follows; empty where none does, name of an argument
    choices: tuple[str, ...] = ()


@dataclass(frozen=True)
class Command:
    """A command, and the commands below it."""

    name: str
    meaning: str
    options: tuple[Option, ...]
    commands: tuple[Command, ...] = field(default=())


def _option(action: argparse.Action) -> Option:
    value = "" if action.nargs == 0 else str(action.metavar or action.dest.upper())
    return Option(tuple(sorted(action.option_strings, key=len)), action.help or "", value,
                  tuple(map(str, action.choices or ())))


def _read(name: str, meaning: str, parser: argparse.ArgumentParser) -> Command:
    """Returns a command of the package, from its parser."""
    options, commands = [], []
    for action in parser._actions:  # argparse has no public list of them
        if isinstance(action, argparse._SubParsersAction):
            meanings = {choice.dest: choice.help or "" for choice in action._choices_actions}
            commands += [_read(word, meanings[word], below) for word, below in action.choices.items()]
        elif action.help != argparse.SUPPRESS and not isinstance(action, argparse._HelpAction):
            options.append(_option(action))
    return Command(name, meaning, tuple(options), tuple(commands))


def _with_names(path: str) -> list[str]:
    """Returns paths as --set takes them, of a path of the reference of decks: "[]" is a first table, NAME an interface
    of most decks.
    """
    path = path.replace("[]", "[0]")
    return [path.replace("NAME", name) for name in ("mortar_mortar", "aggregate_mortar", "aggregate_aggregate")] \
        if "NAME" in path else [path]


class CommandLine:
    """All that may stand behind `pyroclast`.

    program: the program, which tells its own commands, exit codes and deck keys
    """

    def __init__(self, program: str) -> None:
        asked = subprocess.run([program, "commands"], capture_output=True, text=True, check=True)
        told = json.loads(asked.stdout)
        self.version: str = told["version"]
        self.meaning: str = told["meaning"]
        self.exit_codes: dict[str, str] = told["exit_codes"]
        self.deck_keys = sorted({word for path in told["deck_keys"] for word in _with_names(path)})
        self.lists: list[str] = told["lists"]
        self.cases: list[str] = told["cases"]
        self.commands = [self._command(command) for command in told["commands"]]

    def _command(self, told: dict) -> Command:
        if told["name"] in _OF_PACKAGE:
            return _read(told["name"], told["meaning"], _OF_PACKAGE[told["name"]]())
        choices = {"WHAT": self.lists, "--from": self.cases}
        options = (Option(tuple(option["names"]), option["meaning"], option["value"],
                          tuple(choices.get(option["names"][-1] if option["names"] else option["value"], ())))
                   for option in told["options"])
        return Command(told["name"], told["meaning"], tuple(options))


def _roff(text: str) -> str:
    """Returns a text in which roff finds no commands."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{text}" if text.startswith((".", "'")) else text


def _sentence(text: str) -> str:
    return text if text.endswith((".", ")")) or not text else f"{text}."


def _page_of(command: Command, above: str = "") -> str:
    name = f"{above} {command.name}".strip()
    text = f".SS {_roff(name)}\n{_roff(_sentence(command.meaning))}\n"
    for option in command.options:
        head = ", ".join(option.names) if option.names else option.value
        value = f" \\fI{_roff(option.value)}\\fR" if option.names and option.value else ""
        meaning = option.meaning + (f": {', '.join(option.choices)}" if option.choices and option.names else "")
        text += f".TP\n\\fB{_roff(head)}\\fR{value}\n{_roff(_sentence(meaning))}\n"
    return text + "".join(_page_of(below, name) for below in command.commands)


def manual(line: CommandLine) -> str:
    """Returns the manual page, for man."""
    text = f'.TH PYROCLAST 1 "" "pyroclast {line.version}"\n.SH NAME\npyroclast \\- {_roff(line.meaning)}\n'
    text += ".SH SYNOPSIS\n\\fBpyroclast\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH COMMANDS\n"
    text += "".join(map(_page_of, line.commands))
    text += ".SH EXIT STATUS\n" + "".join(f".TP\n{code}\n{_roff(meaning)}\n"
                                           for code, meaning in line.exit_codes.items())
    return text + (".SH ENVIRONMENT\n.TP\nPYROCLAST_LAW_PATH\nFolders with contact laws of one\\(aqs own, separated by "
                   "colons.\n.TP\nPYROCLAST_PYTHON\nThe Python that draws figures, makes pages and runs studies, if not that of the "
                   "installation.\n")


def _words(command: Command) -> str:
    return " ".join(name for option in command.options for name in option.names)


def bash(line: CommandLine) -> str:
    """Returns the completion of bash."""
    cases = []
    for command in line.commands:
        second = [below.name for below in command.commands] or [
            choice for option in command.options if not option.names for choice in option.choices]
        lines = [f"    {command.name})"]
        if second:
            lines.append(f'      if ((COMP_CWORD == 2)); then words="{" ".join(second)}"; fi')
        if command.commands:
            lines.append("      case ${COMP_WORDS[2]} in")
            lines += [f'        {below.name}) options="{_words(below)}" ;;' for below in command.commands]
            lines.append("      esac ;;")
        else:
            lines.append(f'      options="{_words(command)}" ;;')
        cases += lines
    values = {name: option.choices for command in line.commands for part in (command, *command.commands)
              for option in part.options for name in option.names if option.choices}
    chosen = "\n".join(f'    {name}) words="{" ".join(choices)}" ;;' for name, choices in values.items())
    return f"""# Completion of bash for pyroclast
_pyroclast() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} options= words=
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{" ".join(command.name for command in line.commands)} --help --version" -- "$word"))
    return
  fi
  if [[ $before == --set ]]; then
    compopt -o nospace 2>/dev/null
    COMPREPLY=($(compgen -S = -W "{" ".join(line.deck_keys)}" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{chr(10).join(cases)}
  esac
  case $before in
{chosen}
  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options --help" -- "$word"))
  elif [[ $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}}
complete -o filenames -F _pyroclast pyroclast
"""


def _quoted(text: str) -> str:
    """Returns a text between single quotes of zsh, in which _arguments finds no marks of its own."""
    for mark in "\\[]:":
        text = text.replace(mark, f"\\{mark}")
    return text.replace("'", "'\\''")


def _arguments(command: Command) -> str:
    """Returns what _arguments of zsh is told of a command."""
    told = []
    for option in command.options:
        values = f"({' '.join(option.choices)})" if option.choices else "_files"
        if "--set" in option.names:
            values = "_pyroclast_keys"
        if not option.names:
            told.append(f"'*:{_quoted(option.value)}:{values}'")
            continue
        after = f":{_quoted(option.value)}:{values}" if option.value else ""
        told += [f"'*{name}[{_quoted(option.meaning)}]{after}'" for name in option.names]
    return " ".join(["_arguments", *told, "'--help[options and their meanings]'"])


def _described(commands: Sequence[Command]) -> str:
    return " ".join(f"'{command.name}:{_quoted(command.meaning)}'" for command in commands)


def zsh(line: CommandLine) -> str:
    """Returns the completion of zsh."""
    cases = []
    for command in line.commands:
        if not command.commands:
            cases.append(f"    {command.name}) {_arguments(command)} ;;")
            continue
        inner = "\n".join(f"        {below.name}) {_arguments(below)} ;;" for below in command.commands)
        cases.append(f"    {command.name})\n      if ((CURRENT == 2)); then\n        local -a below=("
                     f"{_described(command.commands)})\n        _describe command below\n        return\n      fi\n"
                     f"      shift words; ((CURRENT--))\n      case $words[1] in\n{inner}\n      esac ;;")
    return f"""#compdef pyroclast
# Completion of zsh for pyroclast
_pyroclast_keys() {{
  compadd -S = -- {" ".join(f"'{key}'" for key in line.deck_keys)}
}}
_pyroclast() {{
  if ((CURRENT == 2)); then
    local -a commands=({_described(line.commands)})
    _describe command commands
    return
  fi
  shift words; ((CURRENT--))
  case $words[1] in
{chr(10).join(cases)}
  esac
}}
_pyroclast "$@"
"""


def main(words: Sequence[str]) -> int:
    """Prints one of them: PROGRAM manual|bash|zsh. Returns the exit code."""
    program, what = words
    print({"manual": manual, "bash": bash, "zsh": zsh}[what](CommandLine(program)), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
