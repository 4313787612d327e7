"""Error over wall time, a panel for each scene."""
import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.ticker import NullFormatter

MARKS = {"diacaustic": "o-", "pov-ray": "s--", "mitsuba": "^:"}


def draw(rows, path):
    scenes = list(dict.fromkeys(row[0] for row in rows))
    figure, panels = pyplot.subplots(1, len(scenes), figsize=(4.2 * len(scenes), 3.6), sharey=True, squeeze=False)
    for scene, panel in zip(scenes, panels[0]):
        for renderer in dict.fromkeys(row[1] for row in rows):
            points = [(row[3].wall, row[4]) for row in rows if row[:2] == (scene, renderer)]
            if points:
                panel.loglog(*zip(*points), MARKS.get(renderer, "x-"), label=renderer)
        panel.set(title=scene, xlabel="wall time, s")
        panel.axhline(0.01, color="0.7", linewidth=0.8)
        panel.set_xticks([1, 2, 5, 10, 20, 50], ["1", "2", "5", "10", "20", "50"])
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.grid(True, which="both", alpha=0.2)
    panels[0][0].set_ylabel("relative squared error of the caustic")
    panels[0][0].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=120)
