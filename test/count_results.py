#!/usr/bin/python3
"""Adds up the JUnit files below a folder: `N passed, N failed, N skipped`, what failed, and why.

Before that, the slowest tests, of those that took a second or more, and how many tests had a
second try since the machine disturbed them.

Exit code 0 only if something passed and nothing failed. A file that cannot be read is a failure:
its tests did not end. So is a kind of files (what their names begin with) that is asked for, and
of which there is none.
"""

import pathlib
import sys
import xml.etree.ElementTree

SLOWEST = 20
SECOND_TRY = 'once more: the machine'
"""Begin of the line that again_if_disturbed() of the rostests prints."""


MOST_OF_REASON = 300
"""Characters."""


def reason(case: xml.etree.ElementTree.Element) -> str:
    """Why a test case failed: the first line of what it says."""
    said = next(each for each in case if each.tag in ('failure', 'error'))
    lines = (said.get('message') or said.text or '').strip().splitlines() or ['']
    return '{} {}'.format(said.get('type') or '', lines[0]).strip()[:MOST_OF_REASON]


def main(folder: str, *kinds: str) -> int:
    passed, failed, skipped, times, second_tries = 0, [], [], [], 0
    for kind in kinds:
        if not list(pathlib.Path(folder).rglob(kind + '-*.xml')):
            failed.append('{}: no results'.format(kind))
    for path in sorted(pathlib.Path(folder).rglob('*.xml')):
        try:
            root = xml.etree.ElementTree.parse(str(path)).getroot()
        except xml.etree.ElementTree.ParseError as error:
            failed.append('{}: {}'.format(path, error))
            continue
        second_tries += ''.join(root.itertext()).count(SECOND_TRY)
        for suite in root.iter('testsuite'):
            # One that could not be set up says so by its numbers alone.
            cases = suite.findall('testcase')
            told = sum(case.find(kind) is not None for case in cases
                       for kind in ('error', 'failure'))
            number = sum(int(suite.get(kind) or 0) for kind in ('errors', 'failures'))
            if number > told and not suite.findall('testsuite'):
                failed.append('{}: {} errors outside of tests'.format(path.stem, number - told))
        for case in root.iter('testcase'):
            name = '{} {}'.format(case.get('classname', path.stem), case.get('name'))
            times.append((float(case.get('time') or 0), name))
            if case.find('failure') is not None or case.find('error') is not None:
                failed.append('{}: {}'.format(name, reason(case)))
            elif case.find('skipped') is not None or case.get('status') == 'notrun':
                skipped.append(name)
            else:
                passed += 1
    for seconds, name in sorted(times, reverse=True)[:SLOWEST]:
        if seconds >= 1:
            print('{:6.1f} s  {}'.format(seconds, name))
    if second_tries:
        print('{} tests had a second try: the machine disturbed them'.format(second_tries))
    for title, names in (('skipped', skipped), ('FAILED', failed)):
        for name in names:
            print('{}: {}'.format(title, name))
    print('{} passed, {} failed, {} skipped'.format(passed, len(failed), len(skipped)))
    return 0 if passed and not failed else 1


if __name__ == '__main__':
    sys.exit(main(*sys.argv[1:]))
