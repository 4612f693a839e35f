"""The nodes of an organ, as seen from a program that moves it."""
import functools
import threading

import numpy
import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim.msg import Probes, Result, TetMesh
from soft_tissue_sim.srv import BuildMesh, BuildMeshRequest, LoadScene, Reset

from .mesh import Mesh
from .run import Run, positions_of


class Refused(Exception):
    """What a node said no to, in its own sentence; `code` is one of soft_tissue_sim/Result."""

    def __init__(self, result):
        super().__init__(result.message)
        self.code = result.code


def _checked(answer):
    if answer.result.code != Result.OK:
        raise Refused(answer.result)
    return answer


class Organ:
    """mesher_node and deformer_node, wherever they run; initialises a ROS node where the program has none."""

    def __init__(self, mesher="/mesher_node", deformer="/deformer_node", timeout=30.0):
        """`timeout` [s]: how long to wait for nodes and messages; rospy.ROSException when it is over."""
        if not rospy.core.is_initialized():
            rospy.init_node("soft_tissue_client", anonymous=True, disable_signals=True)
        self._timeout = timeout
        self._build, self._load, self._reset = (
            rospy.ServiceProxy(name, kind) for name, kind in
            ((mesher + "/build_mesh", BuildMesh), (deformer + "/load_scene", LoadScene), (deformer + "/reset", Reset)))
        for service in (self._build, self._load, self._reset):
            service.wait_for_service(timeout)
        self._probes_topic = deformer + "/probes"

    def build(self, **wishes):
        """A Mesh of the mesher's volume, by the fields of BuildMesh.srv; three sections, two rounds of smoothing and a
        projected boundary unless told otherwise. Throws Refused, and TypeError for what is no field."""
        request = BuildMeshRequest(level_sections=3, smooth_levels=2, project_boundary=True, return_mesh=True)
        for name, value in wishes.items():
            if name not in BuildMeshRequest.__slots__:
                raise TypeError(f"build: BuildMesh.srv has no field '{name}'")
            setattr(request, name, value)
        return Mesh(_checked(self._build(request)).mesh)

    def mesh(self):
        """The last Mesh that the mesher made."""
        return Mesh(rospy.wait_for_message("mesh", TetMesh, timeout=self._timeout))

    def load_scene(self, yaml):
        """The deformer goes on with this scene, from rest. Throws Refused."""
        _checked(self._load(yaml=yaml, path=""))

    def reset(self):
        """Tissue at rest, tools hold nothing."""
        _checked(self._reset())

    def positions(self):
        """(n, 3) float32: where the vertices are now [m]."""
        return positions_of(rospy.wait_for_message("deformed_cloud", PointCloud2, timeout=self._timeout))

    def move(self, tool, path, topic=None, frame="patient"):
        """Moves a tool of the scene along a path (n, 8) of t x y z qx qy qz qw [s, m], in real time, and returns the
        Run. The tool waits at its first pose until the organ follows it: where tissue is factorised when a tool
        takes hold of it, that can be seconds. `topic`: where the scene listens to the tool, if not at
        TOOL/measured_cp. Throws ValueError for what is no path, and rospy.ROSException if nobody listens to the tool
        or what is heard does not come to its last pose."""
        path = numpy.asarray(path, dtype=float)
        if path.ndim != 2 or path.shape[1] != 8 or len(path) == 0:
            raise ValueError(f"move: path is {path.shape}, not (n, 8) of t x y z qx qy qz qw")
        if not numpy.isfinite(path).all() or (numpy.diff(path[:, 0]) < 0).any():
            raise ValueError("move: path is not finite, or its times fall")
        publisher = rospy.Publisher(topic or tool + "/measured_cp", PoseStamped, queue_size=10)
        self._wait_for_listener(publisher)
        self._wait_until_followed(publisher, path[0], frame)
        start = rospy.Time.now()
        last = start + rospy.Duration(path[-1, 0] - path[0, 0])
        run, heard, shown = Run(start.to_sec()), {}, threading.Event()

        def take(topic, keep, message):
            if topic != "cloud" or message.header.stamp >= start:
                keep(message)
            heard[topic] = message.header.stamp
            # Each topic comes at its own pace.
            if "cloud" in heard and min(list(heard.values())) >= last:
                shown.set()

        listeners = [rospy.Subscriber(topic, kind, functools.partial(take, name, keep)) for name, topic, kind, keep in (
            ("cloud", "deformed_cloud", PointCloud2, run.take_cloud),
            ("force", tool + "/servo_cf", WrenchStamped, functools.partial(run.take_force, tool)),
            ("probes", self._probes_topic, Probes, run.take_probes))]
        try:
            for row in path:
                due = start + rospy.Duration(row[0] - path[0, 0])
                rospy.sleep(max(due - rospy.Time.now(), rospy.Duration(0)))
                publisher.publish(self._pose(row, due, frame))
            self._stay(publisher, path[-1], frame, shown)
        finally:
            for connection in (*listeners, publisher):
                connection.unregister()
        return run

    def _wait_for_listener(self, publisher):
        deadline = rospy.Time.now() + rospy.Duration(self._timeout)
        while publisher.get_num_connections() == 0:
            if rospy.Time.now() > deadline:
                raise rospy.ROSException(f"move: nobody listens to {publisher.name}; does the scene have that tool?")
            rospy.sleep(0.01)

    def _wait_until_followed(self, publisher, row, frame):
        """Until a cloud shows one of the poses that are sent; as long as no tool has come clouds have stamps too."""
        sent, followed = set(), threading.Event()

        def take_cloud(cloud):
            if cloud.header.stamp in sent:
                followed.set()

        listener = rospy.Subscriber("deformed_cloud", PointCloud2, take_cloud)
        try:
            self._stay(publisher, row, frame, followed, sent.add)
        finally:
            listener.unregister()

    def _stay(self, publisher, row, frame, until, sent=lambda stamp: None):
        """Sends a pose again and again, as a device does that stays where it is, until an event is set."""
        deadline = rospy.Time.now() + rospy.Duration(self._timeout)
        while not until.wait(0.01):
            now = rospy.Time.now()
            if now > deadline:
                raise rospy.ROSException(f"move: no cloud showed {publisher.name} within {self._timeout} s")
            sent(now)
            publisher.publish(self._pose(row, now, frame))

    @staticmethod
    def _pose(row, stamp, frame):
        pose = PoseStamped()
        pose.header.stamp, pose.header.frame_id = stamp, frame
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = row[1:4]
        orientation = pose.pose.orientation
        orientation.x, orientation.y, orientation.z, orientation.w = row[4:8]
        return pose
