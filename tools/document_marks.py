"""Tables that programs write into documents, between <!-- begin NAME --> and <!-- end NAME -->."""
import os
import re
import sys

import stale_tables


def split_at_marks(path, name):
    """The text up to the first mark with it, between the marks, and from the second mark on."""
    with open(path) as file:
        found = re.fullmatch(rf"(.*<!-- begin {name} -->\n)(.*?)(<!-- end {name} -->.*)", file.read(), re.DOTALL)
    if not found:
        sys.exit(f"{path} has no marks <!-- begin {name} --> and <!-- end {name} -->")
    return found.groups()


def read_between_marks(path, name):
    return split_at_marks(path, name)[1]


def write_between_marks(path, name, text, commit=None):
    """Replaces what is between the marks; the text around them stays as it is. Where a comment states what the table was
    measured from (stale_tables.py), it states that commit from now on, or else the working tree."""
    before, old, after = split_at_marks(path, name)
    whole = before + stale_tables.stamp_again(old, commit) + text + after
    with open(f"{path}.part", "w") as file:
        file.write(whole)
    os.replace(f"{path}.part", path)
