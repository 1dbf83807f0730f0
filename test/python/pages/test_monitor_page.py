"""docs/monitor.md, the report of docs/alarm.md, docs/recovery.md: typed as they are written."""
from __future__ import annotations

import re

from page_reader import Reader, blocks, types


@types('monitor.md')
@types('alarm.md', 0)
@types('recovery.md')
def test_the_monitor_its_files_and_the_recovery(reader: Reader) -> None:
    reader.learn()
    reader.type('mkdir data && cp robot.model data/')
    launch, report = blocks('monitor.md')
    reader.launch(launch, '/self_awareness/reload')
    for block in (report, blocks('alarm.md')[0]):
        file, = re.findall(r'alarm_\S+\.bag', block)
        reader.type('mkdir -p ~/.ros/self_awareness/self_awareness && rosrun self_awareness '
                    f'convert 1.bag -o ~/.ros/self_awareness/self_awareness/{file}')
        assert f'{file}: ' in reader.type(block)
        (reader.folder / 'alarm.html').unlink()
    copy, launch = blocks('recovery.md')[0].splitlines()
    reader.type(copy)
    reader.launch(launch, '/self_awareness_recovery/hold')
