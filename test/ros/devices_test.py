#!/usr/bin/env python3
"""Devices as their drivers speak, each through its launch file: messages of the drivers' own definitions, written
out here and played from a bag, move the tissue, and forces come back in the drivers' own types."""
import os
import subprocess
import tempfile

import rosbag
import rospy
import rostest
from genpy.dynamic import generate_dynamic
from geometry_msgs.msg import Pose, PoseStamped, Transform, TransformStamped, Vector3, WrenchStamped
from sensor_msgs.msg import JointState, Joy, PointCloud2
from soft_tissue_sim import displacements_of
from std_msgs.msg import Header

from ball_volume import CENTRE, RADIUS
from deformer_client import DeformerCase

TOP = (CENTRE + RADIUS) * 1e-3
STYLUS = 0.005
SECONDS, RATE = 4.0, 100


def defined(name, text, *parts):
    """The class of a message that is not installed."""
    for part in parts:
        text += "=" * 80 + f"\nMSG: {part._type}\n{part._full_text}\n"
    return generate_dynamic(name, text)[name]


OmniState = defined("omni_msgs/OmniState", """std_msgs/Header         header

bool                    locked

bool                    close_gripper

geometry_msgs/Pose      pose        # meters

geometry_msgs/Vector3   current     # Amperes

geometry_msgs/Vector3   velocity    # meters/s
""", Header, Pose, Vector3)
OmniButtonEvent = defined("omni_msgs/OmniButtonEvent", "int32 grey_button\nint32 white_button\n")
OmniFeedback = defined("omni_msgs/OmniFeedback", """# This is the force as estimated from the applied torques as well as the
# current end effector position of the robot arm
geometry_msgs/Vector3  force
geometry_msgs/Vector3  position
""", Vector3)
DeviceFeedback = defined("geomagic_control/DeviceFeedback", """geometry_msgs/Vector3  force
geometry_msgs/Vector3  position
bool[] lock
""", Vector3)
IgtlTransform = defined("ros_igtl_bridge/igtltransform", """#---Transform Message

string name
geometry_msgs/Transform transform
""", Transform)
OperatingState = defined("crtk_msgs/operating_state", """Header header
string state
bool is_homed
bool is_busy
""", Header)


def depth(time):
    """How far below its first touch the tool is [m]: there from the start, in within a second, and stays."""
    return -0.002 + 0.004 * min(1.0, max(0.0, time - 1.5))


def messages(time, stamp):
    """What all drivers say at an instant: topics and messages."""
    press = (CENTRE * 1e-3, CENTRE * 1e-3, TOP + STYLUS - depth(time))
    pull = (CENTRE * 1e-3, CENTRE * 1e-3, TOP + max(0.0, depth(time)))

    def pose(at, scale=1.0, frame="patient"):
        message = PoseStamped()
        message.header.stamp, message.header.frame_id = stamp, frame
        fill(message.pose, at, scale)
        return message

    def fill(target, at, scale=1.0):
        target.position.x, target.position.y, target.position.z = (scale * x for x in at)
        target.orientation.w = 1.0

    enabled = OperatingState(state="ENABLED", is_homed=True)
    enabled.header.stamp = stamp
    jaw = JointState(name=["jaw"], position=[0.0 if time > 0.4 else 0.5])
    jaw.header.stamp = stamp

    yield "/PSM1/operating_state", enabled
    yield "/PSM1/jaw/measured_js", jaw
    yield "/PSM1/measured_cp", pose(pull)

    # Before 2022 CRTK's poses were transforms.
    transform = TransformStamped()
    transform.header.stamp, transform.header.frame_id = stamp, "patient"
    transform.transform.translation = Vector3(*press)
    transform.transform.rotation.w = 1.0
    yield "/arm/operating_state", enabled
    yield "/arm/measured_cp", transform

    yield "/sigma/gripper/measured_js", jaw
    yield "/sigma/measured_cp", pose(pull)

    yield "/NDI/probe/measured_cp", pose(press)
    yield "/vrpn_client_node/probe/pose", pose(press)
    yield "/mocap_node/Robot_1/pose", pose(press)

    state = OmniState()
    state.header.stamp, state.header.frame_id = stamp, "/map"
    fill(state.pose, press, 1000.0)
    yield "/phantom/state", state
    yield "/phantom/button", OmniButtonEvent(grey_button=int(time > 1.0))

    # Its frame is "world" at first, and empty from the second pose on.
    yield "/Geomagic/pose", pose(press, 1000.0, "world" if time == 0.0 else "")

    tracked = IgtlTransform(name="needle")
    tracked.transform.translation = Vector3(*(1000.0 * x for x in press))
    tracked.transform.rotation.w = 1.0
    yield "/IGTL_TRANSFORM_IN", tracked
    other = IgtlTransform(name="reference")
    other.transform.rotation.w = 1.0
    yield "/IGTL_TRANSFORM_IN", other


class Devices(DeformerCase):
    DEVICES = ("dvrk", "sensable_phantom", "force_dimension", "ndi", "vrpn", "optitrack", "geomagic_touch",
               "ros_geomagic", "openigtlink")
    # Where drivers take forces from, and as what.
    FORCES = {"/arm/servo_cf": WrenchStamped, "/sigma/servo_cf": WrenchStamped,
              "/phantom/force_feedback": OmniFeedback, "/Geomagic/force_feedback": DeviceFeedback}

    def force_of(self, message):
        return message.wrench.force if isinstance(message, WrenchStamped) else message.force

    def test_every_driver_moves_tissue_and_is_pushed_back(self):
        moved = {device: 0.0 for device in self.DEVICES}
        felt = {topic: [] for topic in self.FORCES}
        buttons = []

        def take_cloud(cloud, device):
            furthest = displacements_of(cloud).max()
            moved[device] = max(moved[device], furthest)

        subscribers = [rospy.Subscriber(f"/{device}/deformed_cloud", PointCloud2, take_cloud, device)
                       for device in self.DEVICES]
        subscribers += [rospy.Subscriber(topic, kind, felt[topic].append) for topic, kind in self.FORCES.items()]
        subscribers.append(rospy.Subscriber("/geomagic_touch/stylus/button", Joy,
                                            lambda joy: buttons.append(joy.buttons[0])))
        self.reach(lambda: all(s.get_num_connections() > 0 for s in subscribers))
        # Whoever has a mesh shows it.
        for device in self.DEVICES:
            rospy.wait_for_message(f"/{device}/deformed_cloud", PointCloud2, timeout=60)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "drivers.bag")
            with rosbag.Bag(path, "w") as bag:
                begin = rospy.Time.now()
                for i in range(int(SECONDS * RATE)):
                    stamp = begin + rospy.Duration(i / RATE)
                    for topic, message in messages(i / RATE, stamp):
                        bag.write(topic, message, stamp)
            # A player that stalls for longer than the tools' time-out loses their grip: it plays again.
            for _ in range(5):
                subprocess.run(["rosbag", "play", "-q", "--wait-for-subscribers", path], check=True, timeout=60)
                if min(moved.values()) > 0.001:
                    break
        for device in self.DEVICES:
            self.assertGreater(moved[device], 0.001, moved)
            self.assertLess(moved[device], 0.003, moved)
        for topic, forces in felt.items():
            self.reach(lambda: forces and self.force_of(forces[-1]).z == 0.0)
            # A tool that presses is pushed up; one that pulls is pulled down.
            strongest = max((self.force_of(f).z for f in forces), key=abs)
            self.assertGreater(strongest if topic != "/sigma/servo_cf" else -strongest, 1e-3, topic)
        self.assertEqual(set(buttons), {0, 1})
        self.assertEqual(len(felt["/Geomagic/force_feedback"][-1].lock), 3)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "devices", Devices)
