#!/usr/bin/env python3
"""Makes a bag of an MCAP file of ROS 1 (profile ros1), which the programs of this package read.

Needs mcap of PyPI (`pip install mcap`) and the rosbag of ROS 1. Who sent what stays known if the
file says it, in the metadata of its channels (callerid), as one does that was made of a bag.
usage: mcap_to_bag.py FILE.mcap FILE.bag
"""
import sys

import genpy.dynamic
import rosbag
import rospy
from mcap.reader import make_reader


def main() -> None:
    """Convert the file of the command line."""
    source, target = sys.argv[1:]
    kinds, headers, connections = {}, {}, {}
    with open(source, 'rb') as file, rosbag.Bag(target, 'w') as bag:
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.message_encoding != 'ros1':
                sys.exit(f'{source}: {channel.topic} is no topic of ROS 1, but of '
                         f'{channel.message_encoding}')
            if channel.id not in headers:
                text = schema.data.decode()
                kind = genpy.dynamic.generate_dynamic(schema.name, text)[schema.name]
                kinds[channel.id] = kind
                headers[channel.id] = {**channel.metadata, 'topic': channel.topic,
                                       'type': schema.name, 'md5sum': kind._md5sum,
                                       'message_definition': text}
            kind, header = kinds[channel.id], headers[channel.id]
            # rosbag keeps one connection a topic, and with it one sender, unless it is told so.
            bag._topic_connections = connections.setdefault(channel.id, {})
            bag.write(channel.topic, (schema.name, message.data, kind._md5sum, None, kind),
                      rospy.Time(message.log_time // 10**9, message.log_time % 10**9), raw=True,
                      connection_header=header)


if __name__ == '__main__':
    main()
