"""A Pareto front as SVG: time against error on logarithmic axes, every point with its name, no name on another."""
import html
import math

WIDTH, HEIGHT = 860, 560
LEFT, RIGHT, TOP, BOTTOM = 70, 30, 50, 60
FONT = 10
LETTER = 0.56 * FONT  # mean width of sans-serif letters; a little more than most
MARK = 4.5


class Box:
    def __init__(self, left, top, right, bottom):
        self.left, self.top, self.right, self.bottom = left, top, right, bottom

    def overlap(self, other):
        """The area that both cover."""
        wide = min(self.right, other.right) - max(self.left, other.left)
        high = min(self.bottom, other.bottom) - max(self.top, other.top)
        return max(wide, 0) * max(high, 0)


def is_on_front(point, points):
    """No other is both faster and better."""
    return not any(o["time"] <= point["time"] and o["error"] <= point["error"]
                   and (o["time"], o["error"]) != (point["time"], point["error"]) for o in points)


class Axes:
    """Whole decades, or where the times span little, halves of one."""

    def __init__(self, points, least_error):
        times = [t for p in points for t in (p["least"], p["most"])]
        self.x = (math.floor(2 * math.log10(min(times))) / 2, math.ceil(2 * math.log10(max(times))) / 2)
        self.is_cut = any(p["error"] <= least_error for p in points)
        errors = [p["error"] for p in points]
        low = math.log10(least_error if self.is_cut else min(errors))
        self.y = (math.floor(low + 1e-9), max(math.ceil(math.log10(max(errors))), math.floor(low + 1e-9) + 1))

    def place(self, time, error):
        def share(value, decades):
            return (math.log10(value) - decades[0]) / (decades[1] - decades[0])
        return (LEFT + share(time, self.x) * (WIDTH - LEFT - RIGHT),
                HEIGHT - BOTTOM - share(error, self.y) * (HEIGHT - BOTTOM - TOP))

    def drawn(self, title, time_title, error_title):
        parts = [f'<text x="{WIDTH / 2}" y="20" text-anchor="middle" font-size="15">{html.escape(title)}</text>',
                 f'<text x="{WIDTH / 2}" y="37" text-anchor="middle" font-size="11">square: event, circle: empirical; '
                 'black: none is both faster and better; bars: least and most of the rounds</text>']

        def line(x1, y1, x2, y2):
            parts.append(f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="#ccc"/>')

        for k in range(math.floor(self.x[0]), math.ceil(self.x[1]) + 1):
            for digit in (1, 2, 5):
                time = digit * 10.0 ** k
                if not self.x[0] - 1e-9 <= math.log10(time) <= self.x[1] + 1e-9:
                    continue
                x, _ = self.place(time, 1)
                line(x, TOP, x, HEIGHT - BOTTOM)
                parts.append(f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle">{time:g}</text>')
        for k in range(self.y[0], self.y[1] + 1):
            _, y = self.place(1, 10.0 ** k)
            line(LEFT, y, WIDTH - RIGHT, y)
            name = f"≤ 1e{k}" if self.is_cut and k == self.y[0] else f"1e{k}"
            parts.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{name}</text>')
        parts.append(f'<text x="{WIDTH / 2}" y="{HEIGHT - 18}" text-anchor="middle">{html.escape(time_title)}</text>')
        parts.append(f'<text x="16" y="{HEIGHT / 2}" text-anchor="middle" transform="rotate(-90 16 {HEIGHT / 2})">'
                     f'{html.escape(error_title)}</text>')
        return parts


def label_box(x, y, name):
    """Of a text whose left end and base line are given."""
    return Box(x, y - 0.8 * FONT, x + LETTER * len(name), y + 0.2 * FONT)


def candidates(x, y, name):
    """Places for a name, near ones first: left end, base line, distance."""
    wide = LETTER * len(name)
    for distance in (9, 16, 26, 38, 52, 70, 90, 115):
        for k in range(16):
            angle = math.pi * (k - 2) / 8
            dx, dy = distance * math.cos(angle), -distance * math.sin(angle)
            left = x + dx - wide / 2 * (1 - math.cos(angle))
            yield left, y + dy + 0.3 * FONT, distance


def label_places(points, marks, bars):
    """A place for each point's name, chosen one by one: off the others' names and marks and inside the frame."""
    taken = []
    places = []
    frame = Box(LEFT + 2, TOP + 2, WIDTH - 4, HEIGHT - BOTTOM - 2)
    obstacles = bars + [Box(x - MARK - 1, y - MARK - 1, x + MARK + 1, y + MARK + 1) for x, y in marks]

    def cost(candidate, name):
        left, base, distance = candidate
        box = label_box(left, base, name)
        area = (box.right - box.left) * (box.bottom - box.top)
        outside = area - box.overlap(frame)
        return (sum(box.overlap(o) for o in taken + obstacles) + 5 * outside) * 10 + distance

    for point, (x, y) in zip(points, marks):
        best = min(candidates(x, y, point["name"]), key=lambda c: cost(c, point["name"]))
        taken.append(label_box(best[0], best[1], point["name"]))
        places.append(best)
    return places, taken


def drawn_mark(point, x, y, is_front):
    fill = "black" if is_front else "white"
    if point["is_event"]:
        return f'<rect x="{x - 4:.1f}" y="{y - 4:.1f}" width="8" height="8" fill="{fill}" stroke="black"/>'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{MARK}" fill="{fill}" stroke="black"/>'


def picture(title, points, least_error, time_title, error_title):
    """Points have name, time, least, most, error and is_event. Errors below the least stand at the lower edge."""
    points = sorted(({**p, "error": max(p["error"], least_error)} for p in points), key=lambda p: (p["error"], p["time"]))
    axes = Axes(points, least_error)
    parts = axes.drawn(title, time_title, error_title)
    marks = [axes.place(p["time"], p["error"]) for p in points]
    ends = [[axes.place(p[end], p["error"])[0] for end in ("least", "most")] for p in points]
    places, boxes = label_places(points, marks, [Box(least, y - 1, most, y + 1) for (least, most), (_, y) in zip(ends, marks)])
    front = sorted((m for p, m in zip(points, marks) if is_on_front(p, points)))
    parts.append('<polyline points="' + " ".join(f"{x:.1f},{y:.1f}" for x, y in front) + '" fill="none" stroke="#888" stroke-dasharray="4 3"/>')
    for point, (x, y), (least, most), (left, base, distance), box in zip(points, marks, ends, places, boxes):
        parts.append(f'<line x1="{least:.1f}" y1="{y:.1f}" x2="{most:.1f}" y2="{y:.1f}" stroke="black"/>')
        if distance > 16:
            nearest = min(max(x, box.left), box.right)
            parts.append(f'<line x1="{x:.1f}" y1="{y:.1f}" x2="{nearest:.1f}" y2="{(box.top if base > y else box.bottom):.1f}" stroke="#aaa"/>')
        parts.append(drawn_mark(point, x, y, is_on_front(point, points)))
        parts.append(f'<text x="{left:.1f}" y="{base:.1f}" font-size="{FONT}">{html.escape(point["name"])}</text>')
    body = "\n".join(parts)
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="12">\n'
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>\n{body}\n</svg>\n')
