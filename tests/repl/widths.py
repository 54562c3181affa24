"""widths.py CAG: compares the lists of :help and :doc in terminals of several widths with the same text wrapped by Python."""
import fcntl
import os
import pty
import struct
import subprocess
import sys
import termios
import textwrap

WIDEST, STORY, NARROW, NARROW_STORY = 92, 16, 48, 4


def shown(command, columns):
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    child = subprocess.Popen([sys.argv[1], "repl"], stdin=subprocess.PIPE, stdout=slave, stderr=subprocess.DEVNULL)
    os.close(slave)
    child.stdin.write(command.encode() + b"\n")
    child.stdin.close()
    text = b""
    while True:
        try:
            part = os.read(master, 65536)
        except OSError:  # the terminal closes when the session ends
            break
        if not part:
            break
        text += part
    child.wait()
    return text.decode().replace("\r\n", "\n").rstrip("\n").split("\n")


def wrapped(text, width, first, indent):
    return textwrap.wrap(text, width, initial_indent=first, subsequent_indent=" " * indent, break_long_words=False,
                         break_on_hyphens=False)


def entries(lines, is_first):
    """Joins each first line and its continuation lines."""
    found = []
    for line in lines:
        if is_first(line):
            found.append(line)
        else:
            found[-1] += " " + line.strip()
    return found


commands = entries(shown(":help", 200), lambda line: line[0] == ":" or line.startswith("Anything"))
families = entries(shown(":doc", 200), lambda line: line[0] != " ")
# Headings are not broken: `~` stands for a space in them.
families = ["~".join(text[:text.rindex(":")].split(" ")) + text[text.rindex(":"):] for text in families]
wrong = len(commands) < 10 or len(families) < 10
for columns in (0, 1, 5, 20, 30, 40, NARROW - 1, NARROW, NARROW + 1, 60, 70, 80, WIDEST - 1, WIDEST, WIDEST + 1, 300):
    width = min(columns or WIDEST, WIDEST)
    expected = []
    for text in commands:
        if text[0] != ":":
            expected += wrapped(text, width, "", 0)
        elif width < NARROW:
            expected.append(text[:STORY].rstrip())
            expected += wrapped(text[STORY:], width, " " * NARROW_STORY, NARROW_STORY)
        else:
            expected += wrapped(text[STORY:], width, text[:STORY], STORY)
    names = [line.replace("~", " ") for text in families for line in wrapped(text, width, "", 4)]
    for command, lines in ((":help", expected), (":doc", names)):
        got = [line.rstrip() for line in shown(command, columns)]
        if got != lines:
            wrong = True
            print(f"{command} in {columns} columns:", *[f"expected {a!r}, got {b!r}" for a, b in zip(lines, got) if a != b][:3], sep="\n  ")
sys.exit(wrong)
