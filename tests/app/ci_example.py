#!/usr/bin/python3
"""Runs the commands of an example for a CI server: ci_example.py EXAMPLE ROOT PROGRAM FOLDER
Prints them as one script:                          ci_example.py EXAMPLE --script

FOLDER holds missions/suite.lua and robot/missions/suite.lua. The commands run there as they are
written, but the program is PROGRAM instead of one that is built and installed first: `apt-get` is
asked only whether the files that it is to install are there, `git clone` makes a folder with the
Makefile of ROOT, `make` is asked whether it knows the target, and leaves an empty package where one is
made. What the example keeps must be there afterwards. What runs only without a cached package is
left out of the script where CACHED is set.
"""
import glob
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

import yaml

APT_GET = 'for word; do case $word in ./*) [ -e "$word" ] || { echo "apt-get: $word is not there" >&2; exit 1; } ;; esac; done\n'
GIT = ('[ "$1" = clone ] || exit 1\n'
       'for folder; do :; done\n'
       'mkdir -p "$folder/build" && ln -s ROOT/Makefile "$folder/Makefile" && ln -s BUILT "$folder/build/release"\n')
MAKE = ('/usr/bin/make --dry-run "$@" >/dev/null || exit 1\n'
        'for target; do :; done\n'
        '[ "$target" != package ] || { mkdir -p "$2/build/package" && touch "$2/build/package/rubble_0_amd64.deb"; }\n')


def script_and_keeps(document):
    """The commands, and the patterns of files to keep."""
    if 'missions' in document:  # GitLab
        job = document['missions']
        return '\n'.join(job['script']) + '\n', job['artifacts']['paths'] + [job['artifacts']['reports']['junit']]
    script, keeps = '', []
    for step in document['jobs']['suite']['steps']:
        run = step.get('run', '').strip()
        script += f'if [ -z "$CACHED" ]; then\n{run}\nfi\n' if 'cache-hit' in step.get('if', '') else run + '\n'
        keeps += step.get('with', {}).get('path', '').split() if 'upload' in step.get('uses', '') else []
    return script, keeps


def run(script, folder, root, program):
    with tempfile.TemporaryDirectory() as tools:
        for name, text in (('apt-get', APT_GET), ('git', GIT), ('make', MAKE)):
            with open(f'{tools}/{name}', 'w') as file:
                file.write('#!/bin/sh\n' + text.replace('ROOT', root).replace('BUILT', os.path.dirname(program)))
            os.chmod(file.name, 0o755)
        os.symlink(program, tools + '/rubble')
        environment = {**os.environ, 'PATH': tools + ':' + os.environ['PATH'], 'CACHED': '',
                       'RUBBLE_REPOSITORY': 'https://example.org/rubble', 'RUBBLE_VERSION': 'v0'}
        return subprocess.run(['sh', '-e', '-u', '-c', script], cwd=folder, env=environment, capture_output=True, text=True)


def main():
    with open(sys.argv[1]) as file:
        script, keeps = script_and_keeps(yaml.safe_load(file))
    if sys.argv[2:] == ['--script']:
        print(script, end='')
        return
    example, root, program, folder = (os.path.abspath(path) for path in sys.argv[1:])
    done = run(script, folder, root, program)
    if done.returncode:
        sys.exit(f'{example} ended with {done.returncode}:\n{done.stdout}{done.stderr}')
    for keep in keeps:
        if not glob.glob(folder + '/' + keep, recursive=True):
            sys.exit(f'{example}: nothing to keep by {keep}')
    cases = xml.etree.ElementTree.parse(folder + '/report.xml').findall('.//testcase')
    if len(cases) != 1 or list(cases[0]):
        sys.exit(f'{example}: report.xml does not tell of one case that passed')


if __name__ == '__main__':
    main()
