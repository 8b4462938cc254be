#!/usr/bin/python3
"""Runs the commands of an example for a CI server: ci_example.py EXAMPLE ROOT PROGRAM FOLDER

FOLDER holds missions/suite.lua and robot/missions/suite.lua. The commands run there as they are
written, but the program is PROGRAM instead of one that is installed and built first; of `make` it is
only asked whether it knows the target. What the example keeps must be there afterwards.
"""
import glob
import os
import subprocess
import sys
import xml.etree.ElementTree

import yaml

example, root, program, folder = (os.path.abspath(path) for path in sys.argv[1:])


def commands_and_keeps(document):
    """The lines of shell, and the patterns of files to keep."""
    if 'missions' in document:  # GitLab
        job = document['missions']
        return job['script'], job['artifacts']['paths'] + [job['artifacts']['reports']['junit']]
    lines, keeps = [], []
    for step in document['jobs']['suite']['steps']:
        lines += step.get('run', '').splitlines()
        keeps += step.get('with', {}).get('path', '').split() if 'upload' in step.get('uses', '') else []
    return lines, keeps


def run(line):
    if line.startswith(('apt-get', 'git clone')):
        return
    line = line.replace('make ', 'make --dry-run ')
    done = subprocess.run(line, shell=True, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f'{example}: `{line}` ended with {done.returncode}:\n{done.stdout}{done.stderr}')


with open(example) as file:
    lines, keeps = commands_and_keeps(yaml.safe_load(file))
os.makedirs(folder + '/rubble/build')
os.symlink(root + '/Makefile', folder + '/rubble/Makefile')
os.symlink(os.path.dirname(program), folder + '/rubble/build/release')
if not any('suite' in line for line in lines):
    sys.exit(f'{example}: no command runs the suite')
for line in lines:
    run(line)
for keep in keeps:
    if not glob.glob(folder + '/' + keep, recursive=True):
        sys.exit(f'{example}: nothing to keep by {keep}')
cases = xml.etree.ElementTree.parse(folder + '/report.xml').findall('.//testcase')
if len(cases) != 1 or list(cases[0]):
    sys.exit(f'{example}: report.xml does not tell of one case that passed')
