"""What all pictures of a study share: its rows, and one page that holds them."""
import base64
import html
import io
import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = plt.get_cmap("tab10").colors


def number(row, key):
    return float(row[key]) if row.get(key) else math.nan


def whole(rows):
    """Rows with all effects that did not fail."""
    return [row for row in rows if row["purpose"] == "measure" and row["status"] == "ok" and not row["without"]]


def names(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


class Report:
    """One self-contained page, and the same pictures as files."""

    def __init__(self, folder):
        self.folder, self.parts = folder, []

    def text(self, markup):
        self.parts.append(markup)

    def figure(self, name, caption, figure):
        figure.tight_layout()
        picture = io.BytesIO()
        # Without a stamp, the same results give the same bytes.
        figure.savefig(picture, format="png", metadata={"Software": None}, dpi=min(110, 2000 / figure.get_size_inches()[0]))
        plt.close(figure)
        (self.folder / f"{name}.png").write_bytes(picture.getvalue())
        data = base64.b64encode(picture.getvalue()).decode()
        self.text(f'<h2>{html.escape(caption)}</h2>\n<img src="data:image/png;base64,{data}" alt="{html.escape(caption)}">')

    def write(self, title):
        style = ("body{font-family:sans-serif;max-width:1200px;margin:2em auto;padding:0 1em}img{max-width:100%}"
                 "table{border-collapse:collapse;font-size:12px}td,th{border:1px solid #ccc;padding:2px 6px;text-align:right}")
        page = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>'
                f"<style>{style}</style></head><body><h1>{html.escape(title)}</h1>\n" + "\n".join(self.parts) + "\n</body></html>\n")
        (self.folder / "report.html").write_text(page)
