"""What an organ did, as numpy arrays: heard live or read from a bag."""
import threading

import numpy


def positions_of(cloud):
    """(n, 3) float32 of a PointCloud2 whose first fields are x, y and z, as deformed_cloud's are [m]."""
    return _floats(cloud, 0, 3)


def displacements_of(cloud):
    """(n,) float32: how far each vertex of a deformed_cloud is from where it is at rest [m]."""
    offset = next(field.offset for field in cloud.fields if field.name == "displacement")
    return _floats(cloud, offset, 1)[:, 0]


def _floats(cloud, offset, count):
    rows = numpy.frombuffer(cloud.data, dtype=numpy.uint8).reshape(-1, cloud.point_step)
    return rows[:, offset:offset + 4 * count].copy().view(numpy.float32).reshape(-1, count)


class Run:
    """What tools did to an organ.

    begin: stamp that times are counted from [s]
    times: (c,) of the clouds [s]
    positions: (c, n, 3) float32, where the mesh's vertices were [m]
    forces: by tool (f, 4), time and force of the tissue on it [s, N]; none without the effect force_feedback
    probes: by name (p, 4), time and place [s, m]
    """

    def __init__(self, begin=None):
        """`begin`: None for the stamp of what is heard first."""
        self.begin = begin
        self._lock = threading.Lock()
        self._clouds, self._forces, self._probes = [], {}, {}

    @classmethod
    def from_bag(cls, path):
        """Of the clouds, probes and forces in a bag, whichever there are. Throws OSError or rosbag.ROSBagException for
        what is no bag, and ValueError if it holds none of them."""
        import rosbag

        run = cls()
        with rosbag.Bag(str(path)) as bag:
            for topic, message, _ in bag.read_messages():
                name = topic.split("/")
                if message._type == "soft_tissue_sim/Probes":
                    run.take_probes(message)
                elif message._type == "geometry_msgs/WrenchStamped" and name[-1] == "servo_cf":
                    run.take_force(name[-2] if len(name) > 1 else "", message)
                elif message._type == "sensor_msgs/PointCloud2" and name[-1] == "deformed_cloud":
                    run.take_cloud(message)
        if run.begin is None:
            raise ValueError("it holds no deformed_cloud, no probes and no TOOL/servo_cf")
        return run

    def take_cloud(self, cloud):
        with self._lock:
            self._clouds.append((self._since(cloud), positions_of(cloud)))

    def take_force(self, tool, wrench):
        f = wrench.wrench.force
        with self._lock:
            self._forces.setdefault(tool, []).append((self._since(wrench), f.x, f.y, f.z))

    def take_probes(self, probes):
        with self._lock:
            time = self._since(probes)
            for name, p in zip(probes.names, probes.positions):
                self._probes.setdefault(name, []).append((time, p.x, p.y, p.z))

    def _since(self, message):
        stamp = message.header.stamp.to_sec()
        if self.begin is None:
            self.begin = stamp
        return stamp - self.begin

    @property
    def times(self):
        with self._lock:
            return numpy.array([time for time, _ in self._clouds])

    @property
    def positions(self):
        with self._lock:
            return numpy.array([positions for _, positions in self._clouds], dtype=numpy.float32)

    @property
    def forces(self):
        return self._arrays(self._forces)

    @property
    def probes(self):
        return self._arrays(self._probes)

    def _arrays(self, rows):
        with self._lock:
            return {name: numpy.array(of_name) for name, of_name in rows.items()}
