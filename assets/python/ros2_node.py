#!/usr/bin/python3
"""Rows of a running Limpid as ROS 2 topics: joint states of the device, force on the proxy.

    limpid --listen lab                      # or: limpid serve lab
    python3 ros2_node.py lab

Topics: /limpid/joint_states (sensor_msgs/JointState), /limpid/contact (geometry_msgs/WrenchStamped).
It needs a ROS 2 with rclpy; Limpid's own tests do not run it.
"""

import sys

import rclpy
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import JointState

import limpid

CHANNELS = ["device/position", "device/velocity", "device/motor_torque", "contact/total_force"]


def main() -> None:
    rclpy.init()
    node = rclpy.create_node("limpid")
    states = node.create_publisher(JointState, "limpid/joint_states", 10)
    contacts = node.create_publisher(WrenchStamped, "limpid/contact", 10)
    with limpid.connect(sys.argv[1] if len(sys.argv) > 1 else "control") as loop:
        loop.follow(CHANNELS, rate=200)
        while rclpy.ok():
            for position, velocity, torque, force in loop.rows(seconds=0.02).values:
                stamp = node.get_clock().now().to_msg()
                state = JointState()
                state.header.stamp = stamp
                state.name = [f"joint_{i + 1}" for i in range(len(position))]
                state.position, state.velocity, state.effort = position, velocity, torque
                states.publish(state)
                wrench = WrenchStamped()
                wrench.header.stamp = stamp
                wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z = map(float, force)
                contacts.publish(wrench)
            rclpy.spin_once(node, timeout_sec=0)


if __name__ == "__main__":
    main()
