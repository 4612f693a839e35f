#!/usr/bin/env python3
"""F4, P5: a node that works for long under three tools, with a subscriber that has stalled and meshes that are built
and thrown away in between, takes no more memory than at first and answers as soon. scripts/soak: for ten minutes."""
import itertools
import os
import signal
import statistics
import subprocess
import sys
import time
import unittest
import xmlrpc.client

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from soft_tissue_sim.msg import Result, SimulationStatus
from soft_tissue_sim.srv import BuildMesh

from ros_world import figure, resident_kilobytes, wait_for

LISTENER = """
import rospy
from sensor_msgs.msg import PointCloud2
rospy.init_node("stalled", disable_signals=True)
rospy.Subscriber("/deformed_cloud", PointCloud2, lambda cloud: print("heard", flush=True))
rospy.spin()
"""


TOOLS = ("finger", "thumb", "forceps")
# A tool that touches the tissue later than the others has it factorised again [s].
LONGEST_GRIP = 8.0


def slope(values):
    """Of the least-squares line through values that are one apart."""
    middle, mean = (len(values) - 1) / 2, sum(values) / len(values)
    return (sum((i - middle) * (value - mean) for i, value in enumerate(values)) /
            sum((i - middle) ** 2 for i in range(len(values))))


class Soak(unittest.TestCase):
    def build(self, size):
        """A mesh that the deformer has taken."""
        answer = self.mesher(use_mask=True, iso_value=20.0, initial_tetrahedra=size, level_sections=3, smooth_levels=2)
        self.assertEqual(answer.result.code, Result.OK, answer.result.message)
        wait_for(lambda: self.status and self.status.mesh_uuid != self.uuid, 60)
        self.uuid = self.status.mesh_uuid
        self.since = rospy.Time.now()
        self.felt.clear()

    def settle(self, process):
        """Until all tools hold tissue, which each of them has factorised anew, and clouds show what they do now."""
        self.late, most = time.monotonic(), 0

        def is_settled():
            nonlocal most
            now = resident_kilobytes(process)
            if now > most + 1000:
                most, self.late = now, time.monotonic()
            return self.felt >= set(TOOLS) and time.monotonic() - self.late > LONGEST_GRIP

        wait_for(is_settled, 300)

    def least(self, process, seconds):
        """Of the memory that it takes and of what it has allocated [kB], the least within a time: what is on its way to
        subscribers comes and goes."""
        del self.allocated[:]
        resident = []
        while len(resident) < 10 * seconds or not self.allocated:
            rospy.rostime.wallsleep(0.1)
            resident.append(resident_kilobytes(process))
        return min(resident), min(self.allocated)

    def take_force(self, wrench, tool):
        # Those of the mesh before may still be on their way.
        if wrench.wrench.force.z != 0.0 and wrench.header.stamp > self.since:
            self.felt.add(tool)
        self.forces += tool == TOOLS[0]

    def take_cloud(self, cloud):
        self.clouds += 1
        self.width = cloud.width
        if (rospy.Time.now() - cloud.header.stamp).to_sec() > 2.0:
            self.late = time.monotonic()

    def take_status(self, status):
        self.status = status

    def take_diagnostics(self, array):
        for status in array.status:
            values = {pair.key: pair.value for pair in status.values}
            delays = values.get("poses of finger, until the force is sent, median, p99, largest [ms]")
            if delays:
                self.latencies.append(float(delays.split(",")[0]))
                self.allocated.append(int(values["allocated memory [kB]"]))

    def test_F4_memory_and_latency_stay_as_they_are(self):
        rospy.init_node("soak")
        seconds, every = int(rospy.get_param("~seconds")), int(rospy.get_param("~mesh_every"))
        self.status, self.uuid, self.latencies, self.allocated, self.felt, self.forces = None, "", [], [], set(), 0
        self.clouds, self.width, self.late, self.since = 0, 0, 0.0, rospy.Time(0)
        self.mesher = rospy.ServiceProxy("/mesher_node/build_mesh", BuildMesh)
        rospy.Subscriber("/deformer_node/status", SimulationStatus, self.take_status)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.take_diagnostics)
        rospy.Subscriber("/deformed_cloud", PointCloud2, self.take_cloud)
        for tool in TOOLS:
            rospy.Subscriber(f"/{tool}/servo_cf", WrenchStamped, self.take_force, tool)
        # Tissue has been factorised and is moved.
        wait_for(lambda: self.felt and self.status, 60)
        self.uuid = self.status.mesh_uuid
        deformer = xmlrpc.client.ServerProxy(rospy.get_master().lookupNode("/deformer_node")[2]).getPid("/soak")[2]
        stalled = subprocess.Popen([sys.executable, "-c", LISTENER], stdout=subprocess.PIPE)
        stalled.stdout.readline()
        stalled.send_signal(signal.SIGSTOP)
        try:
            # What allocators keep of a mesh that is gone is there from the first change on.
            sizes = itertools.cycle((6000, 9000))
            self.build(next(sizes))
            self.build(next(sizes))
            self.settle(deformer)
            poses, shown, meshes = self.forces, self.clouds, 0
            del self.latencies[:]
            memory = []
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                if every:
                    self.settle(deformer)
                # Of the same mesh each: those of the smaller are another thing.
                memory.append(self.least(deformer, every or 1))
                if every:
                    self.build(next(sizes))
                    self.build(next(sizes))
                    meshes += 2
        finally:
            stalled.kill()
            stalled.wait()
        a_minute = 60.0 / seconds * len(memory)
        resident, allocated = zip(*memory)
        growth = slope(allocated) * a_minute
        early, late = (statistics.median(part) for part in
                       (self.latencies[:len(self.latencies) // 2], self.latencies[len(self.latencies) // 2:]))
        print(f"soak: {seconds} s, {self.forces - poses} forces to one of three tools, {self.clouds - shown} clouds of "
              f"{self.width} vertices, {meshes} meshes; allocated {allocated[0]} kB at first, {min(allocated)} to "
              f"{max(allocated)}, slope {growth:.0f} kB/min; resident {resident[0]} kB at first, {min(resident)} to "
              f"{max(resident)}, slope {slope(resident) * a_minute:.0f} kB/min; pose to force {early:.3f} ms in the first half, {late:.3f} in the second",
              flush=True)
        figure("F4", f"memory, most above the first in {seconds} s, {meshes} meshes [kB]", max(resident) - resident[0])
        figure("F4", "pose to force, median, second half [ms]", round(late, 3))
        # What the allocator keeps of one mesh and gives to the next comes and goes by megabytes; none of it is lost.
        self.assertLess(max(resident) - resident[0], 0.05 * resident[0] if every else 5000)
        if seconds >= 600:
            self.assertGreater(min(allocated), 0)
            self.assertLess(growth, 100)
            if not every:
                self.assertLess(slope(resident) * a_minute, 100)
        self.assertLess(late, 2 * early + 0.1)
        self.assertGreater(self.clouds - shown, 5 * seconds)
        self.assertGreater(self.forces - poses, 100 * seconds)
        os.kill(deformer, 0)


if __name__ == "__main__":
    rostest.rosrun("soft_tissue_sim", "soak", Soak)
