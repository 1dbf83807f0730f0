#!/usr/bin/python3
"""A component for tests: publishes std_msgs/String on a timer, or in answer to another topic.

Private parameters: ~output (topic), ~rate [Hz] or ~input (topic), ~delay [s] before an answer;
~variation (0 to 1), the share by which periods and delays vary at most.
"""

import random

import rospy
from std_msgs.msg import String


def main() -> None:
    rospy.init_node('talker', disable_rosout=True)
    publisher = rospy.Publisher(rospy.get_param('~output'), String, queue_size=10)
    delay = rospy.get_param('~delay', 0.0)
    variation = rospy.get_param('~variation', 0.0)

    def vary(seconds: float) -> float:
        return seconds * random.uniform(1 - variation, 1 + variation)

    def answer(_: String) -> None:
        rospy.sleep(vary(delay))
        publisher.publish('')

    if rospy.has_param('~input'):
        rospy.Subscriber(rospy.get_param('~input'), String, answer, queue_size=10)
        rospy.spin()
        return
    period = 1 / rospy.get_param('~rate')
    while not rospy.is_shutdown():
        publisher.publish('')
        rospy.sleep(vary(period))


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
