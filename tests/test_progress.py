"""Long work is never silent, and short work leaves no trace."""

import io
import time

from stability.progress import line, reporting


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_log_gets_lines_even_from_work_that_reports_nothing():
    log = io.StringIO()
    with reporting("L1", log, every=0.02):
        time.sleep(0.2)
    assert log.getvalue().startswith("L1: running for 0 s\n")
    assert log.getvalue().count("\n") >= 2


def test_a_line_says_how_far_how_long_and_how_much_longer():
    assert line("P1", 30.0, 1, 4) == "P1: 25% after 30 s, about 90 s left"


def test_a_log_shows_what_was_reported_last():
    log = io.StringIO()
    with reporting("P1", log, every=0.02) as report:
        report(1, 4)
        report(2, 4)
        time.sleep(0.2)
    assert log.getvalue().startswith("P1: 50% after 0 s")


def test_short_work_leaves_no_line():
    log = io.StringIO()
    with reporting("P1", log, every=60) as report:
        report(1, 1)
    assert log.getvalue() == ""


def test_a_heartbeat_stops_with_the_work_even_if_that_fails():
    log = io.StringIO()
    try:
        with reporting("P1", log, every=0.02):
            raise KeyboardInterrupt
    except KeyboardInterrupt:
        before = log.getvalue()
    time.sleep(0.1)
    assert log.getvalue() == before


def test_a_terminal_gets_a_bar(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    screen = Terminal()
    with reporting("P1 [x]", screen) as report:
        report(1, 2)
    assert "P1 [x]" in screen.getvalue() and "left:" in screen.getvalue()
