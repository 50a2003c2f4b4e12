"""The other side of tests/bag.rs: bags by the MCAP and ROS 2 libraries of Foxglove instead of ours.

    mcap_peer.py write BAG.mcap none|lz4|zstd|unchunked    a bag as a lab's recorder leaves it, numbers known by formula
    mcap_peer.py read BAG.mcap RUN.csv                     does a bag of `smam run` hold the numbers of its CSV?

Needs Python with `mcap` and `mcap-ros2-support` (see tests/bag.rs for the versions).
"""

import csv
import math
import sys

from mcap.writer import CompressionType
from mcap.writer import Writer as PlainWriter
from mcap_ros2.reader import read_ros2_messages
from mcap_ros2.writer import Writer

HEADER = """\
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
FLOAT64 = "# One number.\nfloat64 data\n"
STRING = "string data\n"
JOINT_STATE = """\
# The state of joints, with the comments that ROS 2 has too.
std_msgs/Header header

string[] name
float64[] position
float64[] velocity
float64[] effort
""" + HEADER
WRENCH = """\
std_msgs/Header header
Wrench wrench
================================================================================
MSG: geometry_msgs/Wrench
Vector3  force
Vector3  torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
""" + HEADER
FLUID_PRESSURE = """\
std_msgs/Header header
float64 fluid_pressure        # Absolute pressure reading in Pascals.
float64 variance
""" + HEADER
# Of a lab's own making: bounds, constants, odd alignments, a list of messages.
LAB_STATE = """\
uint8 MODE_IDLE=0
uint8 mode
string<=20 label "none"
int16[3] counts
lab_msgs/Valve[] valves
float32[<=4] temperatures
bool on
int64 ticks
================================================================================
MSG: lab_msgs/Valve
string name
float64 opening
"""

BEGIN_NS = 1_700_000_000_000_000_000
MS = 1_000_000


def header(time_ns):
    return {"stamp": {"sec": time_ns // 1_000_000_000, "nanosec": time_ns % 1_000_000_000}, "frame_id": "rig"}


def messages():
    """Topic, type, definition, log time and content, in the order of time. 2 s at 100, 100, 20 and 50 Hz."""
    for i in range(200):
        # Stamped a millisecond before they are recorded.
        at = BEGIN_NS + 10 * MS * i
        joints = {
            "header": header(at - MS),
            "name": ["drive", "tip"],
            "position": [i / 64, -i / 128],
            "velocity": [],
            "effort": [i / 32, math.nan if i == 7 else i / 16],
        }
        yield "/joint_states", "sensor_msgs/msg/JointState", JOINT_STATE, at, joints
        yield "/syringe/position", "std_msgs/msg/Float64", FLOAT64, at + 5 * MS, {"data": i / 256}
        yield "/chatter", "std_msgs/msg/String", STRING, at + 5 * MS, {"data": "not a number: 7"}
        if i % 2 == 0:
            pressure = {"header": header(at - MS), "fluid_pressure": 101_325 + 1000 * i, "variance": 0.0}
            yield "/line/pressure", "sensor_msgs/msg/FluidPressure", FLUID_PRESSURE, at, pressure
        if i % 5 == 0:
            force = {"x": 1.0, "y": 2.0, "z": i / 8}
            wrench = {"header": header(at - MS), "wrench": {"force": force, "torque": {"x": 0.0, "y": i / 4, "z": 0.0}}}
            yield "/ft/wrench", "geometry_msgs/msg/WrenchStamped", WRENCH, at, wrench
            state = {
                "mode": 1,
                "label": "abc"[: i % 4],
                "counts": [1, -2, i],
                "valves": [{"name": "in", "opening": 0.5}, {"name": "outlet", "opening": i / 2}],
                "temperatures": [20.5, 21.0 + i],
                "on": True,
                "ticks": -i,
            }
            yield "/rig/state", "lab_msgs/msg/State", LAB_STATE, at - MS, state


def write(path, how):
    compression = {"lz4": CompressionType.LZ4, "zstd": CompressionType.ZSTD}.get(how, CompressionType.NONE)
    # Small chunks, so that the file has several.
    writer = Writer(path, chunk_size=8192, compression=compression)
    if how == "unchunked":
        writer._writer = PlainWriter(path, use_chunking=False)
        writer._writer.start(profile="ros2", library="mcap_peer")
    schemas = {}
    for sequence, (topic, kind, definition, at, message) in enumerate(messages()):
        if kind not in schemas:
            schemas[kind] = writer.register_msgdef(kind, definition)
        writer.write_message(topic, schemas[kind], message, log_time=at, publish_time=at, sequence=sequence)
    writer.finish()


def same(a, b):
    return a == b or (math.isnan(a) and math.isnan(b))


def read(bag, table):
    with open(table, newline="") as file:
        rows = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]
    columns = [name for name in rows[0] if name != "time_s"]
    found = {}
    for message in read_ros2_messages(bag):
        found.setdefault(message.channel.topic, []).append((message.log_time_ns, message.ros_msg))
    expected = {f"/smam/{name}" for name in columns}
    assert expected <= set(found) <= expected | {"/smam/joint_states"}, (expected, set(found))
    compared = 0
    for name in columns:
        series = found[f"/smam/{name}"]
        assert len(series) == len(rows), (name, len(series), len(rows))
        for (time_ns, message), row in zip(series, rows):
            assert time_ns == round(row["time_s"] * 1e9), (name, time_ns, row)
            assert same(message.data, row[name]), (name, message.data, row)
            compared += 1
    joints = found.get("/smam/joint_states", [])
    for time_ns, message in joints:
        assert len(message.name) == len(message.position) > 0, message
        assert message.header.stamp.sec * 10**9 + message.header.stamp.nanosec == time_ns
    print(f"equal: {compared} numbers of {len(columns)} columns; {len(joints)} joint states of {joints[0][1].name if joints else []}")


if __name__ == "__main__":
    {"write": write, "read": read}[sys.argv[1]](*sys.argv[2:])
