"""Puts the tables that a program prints between their markers on a page of docs."""
import os
import re
import sys
import tempfile

SCRIPT = os.path.basename(sys.argv[0])


def tables_in(text):
    """By name, what follows each line `table NAME`."""
    parts = re.split(r"^table (\w+)\n", text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def with_table(page, name, table):
    begin, end = f"<!-- table {name}, by bench/{SCRIPT} -->\n", f"<!-- end of table {name} -->"
    if begin not in page or end not in page:
        sys.exit(f"{SCRIPT}: the page has no markers for the table {name}")
    before, rest = page.split(begin, 1)
    return before + begin + table.strip() + "\n" + end + rest.split(end, 1)[1]


def put(path, tables):
    """Rewrites the page at once or not at all."""
    with open(path, encoding="utf-8") as file:
        page = file.read()
    for name, table in tables.items():
        page = with_table(page, name, table)
    with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=os.path.dirname(os.path.abspath(path)), delete=False) as file:
        file.write(page)
    os.chmod(file.name, 0o644)
    os.replace(file.name, path)
