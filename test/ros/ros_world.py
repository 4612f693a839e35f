"""A roscore of one's own with nodes under it, to do to them what cannot be done to those of a test's own roscore."""
import functools
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import traceback
import xmlrpc.client

import rosgraph
from roslib.packages import find_node

HEARING = """
import json, sys, rospy
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim.msg import *
from visualization_msgs.msg import MarkerArray
rospy.init_node("ear", anonymous=True, disable_signals=True, disable_rosout=True)
m = rospy.wait_for_message({topic!r}, {kind}, timeout={timeout})
print(json.dumps({what}))
"""
CALLING = """
import json, rospy
from soft_tissue_sim.srv import *
rospy.init_node("mouth", anonymous=True, disable_signals=True, disable_rosout=True)
rospy.wait_for_service({name!r}, 20)
answer = rospy.ServiceProxy({name!r}, {kind})(**json.loads({fields!r}))
print(json.dumps([answer.result.code, answer.result.message]))
"""
# Ends well once the mesher is busy. What it asks for is refused before it is begun, and keeps nobody waiting.
WATCHING = """
import rospy
from soft_tissue_sim.srv import *
from soft_tissue_sim.msg import Result
rospy.init_node("watcher", anonymous=True, disable_signals=True, disable_rosout=True)
rospy.wait_for_service({name!r}, 20)
build = rospy.ServiceProxy({name!r}, BuildMesh, persistent=True)
print("watching", flush=True)
while build(level_sections=0).result.code != Result.E_BUSY:
    rospy.rostime.wallsleep(0.01)
"""


# Volumes and meshes of claims that are not true.
HOSTILE = """
import json, math, random, rospy
from soft_tissue_sim.msg import TetMesh, Volume
rospy.init_node("enemy", anonymous=True, disable_signals=True, disable_rosout=True)
random.seed(1)
volumes = rospy.Publisher("/volume", Volume, queue_size=1000)
meshes = rospy.Publisher("/mesh", TetMesh, queue_size=1000)
while volumes.get_num_connections() == 0 or meshes.get_num_connections() == 0:
    rospy.rostime.wallsleep(0.05)
size = lambda: random.choice((0, 1, 2, 31, 65536, 2**31, 2**32 - 1))
number = lambda: random.choice((0.0, -1.0, 1e-3, 3e38, math.nan, math.inf))
for i in range({count}):
    volume, mesh = Volume(), TetMesh()
    volume.header.frame_id = mesh.header.frame_id = random.choice(("patient", "", "x" * 100000))
    volume.width, volume.height, volume.depth = size(), size(), size()
    volume.spacing.x, volume.spacing.y, volume.spacing.z = number(), number(), number()
    volume.origin.orientation.w = random.choice((1.0, number()))
    volume.encoding = random.choice(("8UC1", "64FC1", "", "%s%n" * 1000))
    volume.data = bytes(random.randrange(1000))
    count = random.randrange(30)
    mesh.vertices = [number() for _ in range(3 * count)]
    mesh.tetrahedra = [random.choice((0, 1, 2, 2**32 - 1)) for _ in range(random.randrange(40))]
    mesh.levels = bytes(random.randrange(10))
    mesh.densities = [number() for _ in range(random.choice((0, count)))]
    mesh.tet_densities = [number() for _ in range(random.randrange(10))]
    mesh.surface, mesh.parents = mesh.tetrahedra, mesh.tetrahedra
    mesh.lattice_vertices = size()
    volumes.publish(volume)
    meshes.publish(mesh)
    rospy.rostime.wallsleep(0.002)
print(json.dumps({count}))
"""


class World:
    def __init__(self):
        self.folder = tempfile.mkdtemp()
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.uri = f"http://127.0.0.1:{self.port}"
        self.env = {**os.environ, "ROS_MASTER_URI": self.uri, "ROS_IP": "127.0.0.1", "ROS_HOME": self.folder,
                    "ROS_LOG_DIR": os.path.join(self.folder, "log"), "ROSCONSOLE_STDOUT_LINE_BUFFERED": "1"}
        self.started = []
        self.core = self.start_core()

    def start(self, *command, **options):
        """A process of this world; its output is in `log_of` it."""
        log = open(os.path.join(self.folder, f"output{len(self.started)}"), "wb")
        process = subprocess.Popen(command, env={**self.env, **options.pop("env", {})}, stdout=log,
                                   stderr=subprocess.STDOUT, start_new_session=True, **options)
        process.log = log.name
        self.started.append(process)
        return process

    def start_core(self):
        core = self.start("roscore", "-p", str(self.port))
        wait_for(lambda: rosgraph.is_master_online(self.uri), 60)
        return core

    def kill_core(self):
        """roscore, and the master, which is a process of its own."""
        master = xmlrpc.client.ServerProxy(self.uri).getPid("/world")[2]
        os.killpg(self.core.pid, signal.SIGKILL)
        self.core.wait()
        os.kill(master, signal.SIGKILL)
        wait_for(lambda: not rosgraph.is_master_online(self.uri), 10)

    def launch(self, file, *arguments):
        return self.start("roslaunch", "soft_tissue_sim", file, *arguments)

    def node(self, kind, *arguments, **options):
        return self.start(program(kind), *arguments, **options)

    def process_of(self, node):
        """Its process id; None while it is not there."""
        try:
            api = rosgraph.Master("/world", master_uri=self.uri).lookupNode(node)
            return xmlrpc.client.ServerProxy(api).getPid("/world")[2]
        except (OSError, rosgraph.MasterException, xmlrpc.client.Fault):
            return None

    def address_of(self, node):
        return rosgraph.Master("/world", master_uri=self.uri).lookupNode(node)

    def hear(self, topic, kind, what, timeout=20):
        """`what` of the next message `m`."""
        return self.ask(HEARING.format(topic=topic, kind=kind, what=what, timeout=timeout), timeout)

    def call(self, name, kind, **fields):
        """Code and sentence of the result."""
        return self.ask(CALLING.format(name=name, kind=kind, fields=json.dumps(fields)), 120)

    def watcher(self, mesher):
        """A process that ends with 0 once the mesher builds; it prints `watching` once it looks."""
        return self.start(sys.executable, "-c", WATCHING.format(name=mesher + "/build_mesh"))

    def attack(self, count):
        """So many hostile volumes and meshes."""
        return self.ask(HOSTILE.format(count=count), 120)

    def ask(self, program, timeout):
        done = subprocess.run([sys.executable, "-c", program], env=self.env, capture_output=True, timeout=timeout + 30)
        if done.returncode != 0:
            raise AssertionError(done.stderr.decode()[-500:])
        return json.loads(done.stdout)

    def end(self):
        # Launchers end what they have started, and masters are processes of their own.
        for process in reversed(self.started):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                try:
                    process.wait(10)
                except subprocess.TimeoutExpired:
                    pass
        for process in self.started:
            if process.poll() is None:
                try:
                    os.killpg(process.pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass
                process.wait()


def log_of(process):
    with open(process.log, errors="replace") as log:
        return log.read()


def resident_kilobytes(pid):
    with open(f"/proc/{pid}/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))


def figure(case, what, value):
    """Keeps what a test measured of a hard case where scripts/robustness finds it."""
    if "TISSUE_FIGURES" in os.environ:
        with open(os.environ["TISSUE_FIGURES"], "a") as file:
            print(json.dumps([case, what, value]), file=file)


def program(name):
    """Where one of the package's programs is, as roslaunch finds it; rosrun passes over what lies below build/."""
    return find_node("soft_tissue_sim", name)[0]


def tells_why(set_up):
    """For setUpClass: what it throws is else in no result."""
    @functools.wraps(set_up)
    def told(*arguments):
        try:
            set_up(*arguments)
        except Exception:
            traceback.print_exc()
            raise
    return told


def wait_for(condition, seconds=30):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("what was waited for never came")
        time.sleep(0.05)
