#!/usr/bin/python3
"""A component for tests: publishes std_msgs/String on a timer, or in answer to another topic.

Private parameters: ~output (topic), ~rate [Hz] or ~input (topic), ~delay [s] before an answer.
"""

import rospy
from std_msgs.msg import String


def main() -> None:
    rospy.init_node('talker', disable_rosout=True)
    publisher = rospy.Publisher(rospy.get_param('~output'), String, queue_size=10)
    delay = rospy.get_param('~delay', 0.0)

    def publish(_=None) -> None:
        rospy.sleep(delay)
        publisher.publish('')

    if rospy.has_param('~input'):
        rospy.Subscriber(rospy.get_param('~input'), String, publish, queue_size=10)
        rospy.spin()
        return
    rate = rospy.Rate(rospy.get_param('~rate'))
    while not rospy.is_shutdown():
        publish()
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
