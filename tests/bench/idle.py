#!/usr/bin/python3
"""Says what the window takes of the processor while nobody touches it, a line a thread.

usage: idle.py LIMPID [SECONDS]

Opens it under Xvfb with the predictive coupling and the software renderer. Trust it on a quiet
machine only. Needs Xvfb, xdotool and numpy.
"""
import os
import pathlib
import sys
import time


def processor_times(pid):
    """Seconds by name of thread."""
    ticks = os.sysconf("SC_CLK_TCK")
    times = {}
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        text = (task / "stat").read_text()
        name = text[text.index("(") + 1:text.rindex(")")]
        fields = text[text.rindex(")") + 2:].split()
        times[name] = times.get(name, 0) + (int(fields[11]) + int(fields[12])) / ticks
    return times


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    os.environ["LIMPID"] = str(pathlib.Path(sys.argv[1]).resolve())
    seconds = float(sys.argv[2]) if len(sys.argv) == 3 else 15
    sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "system"))
    import window  # reads LIMPID

    class Idle(window.WindowTest):
        """The window of the system tests, left alone."""
        LAW = "predictive"

        def runTest(self):
            self.move(5, 400)
            time.sleep(5)
            frames, before, begin = self.state()["frames"], processor_times(self.app.pid), time.monotonic()
            time.sleep(seconds)
            after, took = processor_times(self.app.pid), time.monotonic() - begin
            frames = self.state()["frames"] - frames
            total = sum(after.values()) - sum(before.values())
            for name in sorted(after):
                print(f"{name:12} {100 * (after[name] - before.get(name, 0)) / took:5.1f} %")
            print(f"{'all':12} {100 * total / took:5.1f} % of a core, {frames / took:.1f} frames/s")

    idle = Idle()
    result = idle.run()
    for _, what in result.errors + result.failures:
        sys.exit(what)


if __name__ == "__main__":
    main()
