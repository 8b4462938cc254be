"""Tables that programs write into documents, between <!-- begin NAME --> and <!-- end NAME -->."""
import os
import re
import sys


def write_between_marks(path, name, text):
    """Replaces what is between the marks; the text around them stays as it is."""
    with open(path) as file:
        whole = file.read()
    pattern = rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)"
    whole, found = re.subn(pattern, lambda marks: marks[1] + text + marks[2], whole, flags=re.DOTALL)
    if not found:
        sys.exit(f"{path} has no marks <!-- begin {name} --> and <!-- end {name} -->")
    with open(f"{path}.part", "w") as file:
        file.write(whole)
    os.replace(f"{path}.part", path)
