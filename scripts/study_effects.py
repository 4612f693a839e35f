"""What each effect of a scene costs, and what it is good for."""
import html

from study_report import COLOURS, names, number, plt, whole


def kind_of(row):
    return row["problem"], row["mesh"], row["model"], row["element_order"], row["tetrahedra_asked"]


def draw_effects(report, rows):
    """Bars for each effect that was left out: the step's time that it takes, and the error that it takes away."""
    full = {kind_of(row): row for row in whole(rows)}
    found = [(row, full[kind_of(row)]) for row in rows
             if row["without"] and row["status"] == "ok" and kind_of(row) in full]
    if not found:
        return
    scenes = list(dict.fromkeys(kind_of(row) for row, _ in found))
    effects = names([row for row, _ in found], "without")
    figure, (times, errors) = plt.subplots(1, 2, figsize=(11, 1.2 + 0.55 * len(scenes)))
    for y, scene in enumerate(scenes):
        base = number(full[scene], "step_seconds_median")
        time_left, error_left = 0.0, 0.0
        for row, with_all in found:
            if row["problem"] != scene[0] or with_all is not full[scene]:
                continue
            colour = COLOURS[effects.index(row["without"]) % 10]
            added = max(0.0, 100.0 * (1.0 - number(row, "step_seconds_median") / base))
            mended = max(0.0, number(row, "error_displacement_percent") - number(with_all, "error_displacement_percent"))
            times.barh(y, added, left=time_left, color=colour)
            errors.barh(y, mended, left=error_left, color=colour)
            time_left, error_left = time_left + added, error_left + mended
    labels = [f"{s[0]} ({s[2]}, {int(s[4]):,} tets)" for s in scenes]
    times.set_yticks(range(len(scenes)), labels)
    errors.set_yticks(range(len(scenes)), [])
    times.set_xlabel("of a step's time, saved by leaving it out [%]")
    errors.set_xlabel("error in displacement, made by leaving it out [%]")
    errors.legend(handles=[plt.Rectangle((0, 0), 1, 1, color=COLOURS[i % 10], label=effect) for i, effect in enumerate(effects)],
                  fontsize=7)
    report.figure("effects", "What each effect adds in time and takes away in error", figure)
    draw_costs(report, found)


def costs_of(row):
    """Seconds and bytes by the name of the effect."""
    costs = {}
    for entry in filter(None, row["effect_costs"].split("; ")):
        name, seconds, _, size, _ = entry.split(" ")
        costs[name] = float(seconds), int(size)
    return costs


def draw_costs(report, found):
    """What each effect says that it costs, beside what the scene costs without it: as a table of the page, and
    printed as Markdown."""
    head = ["scene", "effect", "its own part of the time", "bytes per tet", "step with / without it [ms]",
            "error made without it"]
    lines = []
    for row, with_all in found:
        seconds, size = costs_of(with_all).get(row["without"], (0.0, 0))
        steps = [1e3 * number(which, "step_seconds_median") for which in (with_all, row)]
        lines.append([f"{row['problem']} (`{row['model']}`)", f"`{row['without']}`",
                      f"{100 * seconds / number(with_all, 'run_seconds'):.2g} %",
                      f"{size / number(with_all, 'tetrahedra'):.3g}", f"{steps[0]:.3g} / {steps[1]:.3g}",
                      f"{number(row, 'error_displacement_percent'):.2g} %"])
    report.text("<h2>Costs by name</h2>\n<table>" + "".join(
        "<tr>" + "".join(f"<td>{html.escape(entry)}</td>" for entry in line) + "</tr>" for line in [head, *lines]) + "</table>")
    for line in [head, ["---"] * len(head), *lines]:
        print("| " + " | ".join(line) + " |")
