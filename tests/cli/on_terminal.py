"""on_terminal.py COMMAND ...: runs a command whose standard error is a terminal, and prints its output, one line for each redraw."""
import os
import pty
import subprocess
import sys

master, slave = pty.openpty()
child = subprocess.Popen(sys.argv[1:], stderr=slave, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
os.close(slave)
text = b""
while True:
    try:
        part = os.read(master, 4096)
    except OSError:  # the terminal closes when the command ends
        break
    if not part:
        break
    text += part
print(text.decode(errors="replace").replace("\r\n", "\n").replace("\r", "\n"))
sys.exit(child.wait())
