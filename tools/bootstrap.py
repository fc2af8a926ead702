"""Make .venv from the hashed lock, with nothing but the standard library; `make` calls it.

python3 tools/bootstrap.py                          what figures, tests and derivations need
python3 tools/bootstrap.py requirements/lint.txt    and these tools on top
"""

# Until main() has found a Python 3.11 this file must run under Python 3.6, or nobody reads why it stops.
import hashlib
import os
import re
import shutil
import socket
import subprocess
import sys
from pathlib import Path
from urllib.parse import urlsplit

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "requirements" / "lock.txt"
VENV = ROOT / ".venv"
PYTHON = VENV / "bin" / "python"
OK = VENV / ".ok"  # written last: without it .venv is half made
VERSION = f"{sys.version_info[0]}.{sys.version_info[1]}"


def say(text):
    print("bootstrap: " + text, file=sys.stderr, flush=True)


def fail(text):
    say(text)
    sys.exit(1)


def start_again_newer():
    for name in ("python3.14", "python3.13", "python3.12", "python3.11"):
        # A name on the PATH need not run: pyenv puts one there for every version it has, chosen or not.
        if shutil.which(name) and subprocess.run([name, "-c", ""], stderr=subprocess.DEVNULL).returncode == 0:
            os.execvp(name, [name] + sys.argv)
    fail(f"Python 3.11 or newer is needed, {sys.executable} is {VERSION}: install one, or name one: make PYTHON=...")


def hold_lock():
    """Wait for another set-up here. Children inherit the lock: pip may outlive a bootstrap that was killed."""
    import fcntl

    lock = open(__file__, "r+b")  # opened for writing because NFS wants it so; never written
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        say("another set-up is at work here; waiting for it")
        fcntl.flock(lock, fcntl.LOCK_EX)
    except OSError:
        pass  # a file system without locks
    return lock


def run(lock, *command):
    pipe, env, words = subprocess.PIPE, dict(os.environ, PIP_USER="0"), [str(word) for word in command]
    done = subprocess.run(words, stdout=pipe, stderr=subprocess.STDOUT, text=True, env=env, pass_fds=[lock.fileno()])
    if done.returncode:
        (VENV / "setup.log").write_text(done.stdout)
        fail(diagnosis(done.stdout) + " (all of it: .venv/setup.log)")


def diagnosis(output):
    """To pip, no network and no wheel are both `no matching distribution`: one socket to the index tells which."""
    pip = [PYTHON, "-m", "pip", "config", "list"]
    mirror = PYTHON.exists() and re.search(
        r"[.]index-url='(.*)'", subprocess.run(pip, capture_output=True, text=True).stdout
    )
    index = urlsplit(mirror.group(1) if mirror else os.environ.get("UV_DEFAULT_INDEX", "https://pypi.org"))
    try:
        if index.hostname and not os.environ.get("HTTPS_PROXY", os.environ.get("https_proxy")):
            socket.create_connection((index.hostname, index.port or 443), timeout=5).close()
    except OSError as error:
        return f"no network: cannot reach the package index {index.hostname} ({error})"
    wheel = re.search(r"No matching distribution found for (\S+)|Because (\S+) has no (?:usable )?wheels", output)
    if wheel:
        package = wheel.group(1) or wheel.group(2)
        return f"no ready-made package of {package} for Python {VERSION} here: try another, make PYTHON=python3.12 ..."
    lines = output.split("\n")
    return next((line.strip() for line in reversed(lines) if re.search("error", line, re.I)), "the set-up failed")


def install(lock, requirements):
    uv, pip = shutil.which("uv"), VENV / "bin" / "pip"  # an environment that uv made has no pip
    if not (uv or pip.exists()):
        fail("uv made .venv and is no longer on the PATH: put it back, or make distclean")
    # Byte code is made at the first import: compiling every file took 20 s of 40 s.
    tool = [PYTHON, "-m", "pip", "install", "--no-compile"]
    if not pip.exists():
        tool = [uv, "pip", "install", "--python", PYTHON]
    # Wheels only: a source build takes minutes to fail where no compiler is.
    run(lock, *tool, "--quiet", "--require-hashes", "--only-binary", ":all:", "-r", requirements)


def build(lock):
    uv = shutil.which("uv")
    base = getattr(sys, "_base_executable", sys.executable)  # not .venv's own python, which is about to go
    say(f"setting up .venv with Python {VERSION} and {'uv' if uv else 'pip'}; this takes about a minute, once")
    if VENV.exists():
        shutil.rmtree(VENV)
    if not uv and subprocess.run([base, "-c", "import venv, ensurepip"], stderr=subprocess.DEVNULL).returncode:
        fail(f"this Python lacks its module venv: sudo apt install python{VERSION}-venv (Debian), or install uv")
    VENV.mkdir()
    run(lock, *([uv, "venv", "--quiet", "--allow-existing", "--python", base] if uv else [base, "-m", "venv"]), VENV)
    install(lock, LOCK)
    # The project itself. An editable install would fetch flit_core, outside the lock, to write the same two files;
    # the path is relative, so that no space, accent or move of the checkout breaks it.
    site = next((VENV / "lib").glob("python3.*")) / "site-packages"
    (site / "granular_stability.pth").write_text(os.path.relpath(ROOT, site) + "\n")
    command = VENV / "bin" / "stability"
    command.write_text('#!/bin/sh\nexec "$(dirname "$0")/python" -m stability "$@"\n')
    command.chmod(0o755)


def main():
    if sys.version_info < (3, 11):
        start_again_newer()
    if os.name != "posix":
        fail("on Windows use WSL, or an environment of your own: pip install -r requirements/lock.txt")
    lock = hold_lock()
    digest = hashlib.sha256(LOCK.read_bytes() + Path(__file__).read_bytes()).hexdigest()
    if not (OK.exists() and PYTHON.exists() and OK.read_text() == digest):
        build(lock)
    OK.write_text(digest)
    for requirements in sys.argv[1:]:
        install(lock, requirements)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        fail("interrupted; the next make starts again")
