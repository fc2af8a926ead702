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


def test_a_line_says_it_in_words_too_and_counts_from_where_this_run_began():
    note = "t = 0.06 of 0.1 s, step 12, 4 Newton iterations"
    expected = f"N3: 60% ({note}) after 10 s, about 40 s left"
    assert line("N3", 10.0, 0.06, 0.1, note, start=0.05) == expected
    assert line("N3", 10.0, 0.05, 0.1, note, start=0.05) == f"N3: running for 10 s ({note})"


def test_a_log_shows_the_note_that_was_reported_last():
    log = io.StringIO()
    with reporting("N3", log, every=0.02) as report:
        report(0.5, 1.0, "step 7")
        time.sleep(0.2)
    assert log.getvalue().startswith("N3: 50% (step 7) after 0 s")


def test_a_terminal_shows_the_note(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    screen = Terminal()
    with reporting("N3", screen) as report:
        report(0.5, 1.0, "step 7 [x]", start=0.25)
    assert "step 7 [x]" in screen.getvalue()


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
