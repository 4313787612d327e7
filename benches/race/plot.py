"""Error over wall time, a panel for each scene."""
import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.ticker import NullFormatter

MARKS = {"diacaustic": "C0o-", "pov-ray": "C1s--", "mitsuba ptracer": "C2^:", "mitsuba path": "C3v:"}


def series(row):
    """What a row belongs to: a renderer, or one of its integrators."""
    renderer, setting = row[1:3]
    return f"{renderer} {setting.split(',')[0]}" if renderer == "mitsuba" else renderer


def draw(rows, path):
    scenes = list(dict.fromkeys(row[0] for row in rows))
    figure, panels = pyplot.subplots(1, len(scenes), figsize=(4.2 * len(scenes), 3.6), sharey=True, squeeze=False)
    for scene, panel in zip(scenes, panels[0]):
        for name in dict.fromkeys(map(series, rows)):
            points = [(row[3].wall, row[4]) for row in rows if row[0] == scene and series(row) == name]
            if points:
                panel.loglog(*zip(*points), MARKS.get(name, "kx-"), label=name)
        panel.set(title=scene, xlabel="wall time, s")
        panel.axhline(0.01, color="0.7", linewidth=0.8)
        panel.set_xticks([1, 2, 5, 10, 20, 50], ["1", "2", "5", "10", "20", "50"])
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.grid(True, which="both", alpha=0.2)
    panels[0][0].set_ylabel("relative squared error of the caustic")
    handles = {label: handle for panel in panels[0] for handle, label in zip(*panel.get_legend_handles_labels())}
    panels[0][0].legend(handles.values(), handles.keys())
    figure.tight_layout()
    figure.savefig(path, dpi=120)
