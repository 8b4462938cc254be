"""Topics and services of Rubble for Python programs without ROS 2, by the package cyclonedds (pip install cyclonedds).

    rubble serve mission.lua &
    rubble info --idl > rubble.idl
    python3 examples/ros2/dds.py rubble.idl /joint_states sensor_msgs/msg/JointState

prints messages of a topic. In programs:

    node = Node("rubble.idl")
    print(node.call("/get_simulation_state", "simulation_interfaces/srv/GetSimulationState").state.state)
"""
import os
import re
import sys
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import make_idl_struct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

PRIMITIVES = {"boolean": bool, "octet": types.uint8, "int8": types.int8, "short": types.int16, "unsigned short": types.uint16,
              "long": types.int32, "unsigned long": types.uint32, "long long": types.int64, "unsigned long long": types.uint64,
              "float": types.float32, "double": types.float64, "string": str}
# As `rubble serve` does by default: this machine alone. Programs are looked for one by one, as loopback has no multicast.
LOOPBACK = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces>
<AllowMulticast>spdp</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>"""


def read_types(path):
    """Classes of the structs of `rubble info --idl`, by "package/kind/Name"."""
    with open(path, encoding="ascii") as opened:
        text = opened.read()
    found = {}

    def type_of(word):
        if word in PRIMITIVES:
            return PRIMITIVES[word]
        listed = re.fullmatch(r"sequence<(.+)>", word)
        return types.sequence[type_of(listed[1])] if listed else found[word]

    for package, kind, name, body in re.findall(r"module (\w+) \{ module (\w+) \{ module dds_ \{\s*@final struct (\w+)_ \{(.*?)\};", text, re.S):
        fields = {}
        for word, field, size in re.findall(r"\s*(.+?) (\w+)(?:\[(\d+)\])?;", body):
            fields[field] = types.array[type_of(word), int(size)] if size else type_of(word)
        whole = f"{package}::{kind}::dds_::{name}_"
        found[whole] = make_idl_struct(name, whole.replace("::", "."), fields)
    return {name.replace("::dds_::", "/").replace("::", "/")[:-1]: cls for name, cls in found.items()}


def filled(cls, values=None):
    """A message with zeros and empty texts where `values` says nothing; dictionaries for messages in it."""
    arguments = {}
    for name, kind in cls.__annotations__.items():
        value, listed = (values or {}).get(name), getattr(kind, "__metadata__", (None,))[0]
        if isinstance(listed, types.array):
            arguments[name] = value if value is not None else [0] * listed.length
        elif isinstance(listed, types.sequence):
            arguments[name] = [filled(listed.subtype, v) if isinstance(v, dict) else v for v in value or []]
        elif isinstance(kind, type) and hasattr(kind, "__idl__"):
            arguments[name] = value if value is not None and not isinstance(value, dict) else filled(kind, value)
        else:
            arguments[name] = value if value is not None else "" if kind is str else False if kind is bool else 0
    return cls(**arguments)


class Node:
    """A participant of DDS that speaks as ROS 2 does."""

    def __init__(self, idl, domain=0, configuration=LOOPBACK):
        self.types = read_types(idl)
        self.domain = Domain(domain, configuration)
        self.participant = DomainParticipant(domain)
        self.clients, self.calls = {}, 0

    def _topic(self, name, kind, suffix=""):
        return Topic(self.participant, name, self.types[kind + suffix])

    def _qos(self, latched=False, reliable=True):
        return Qos(Policy.Reliability.Reliable(duration(milliseconds=100)) if reliable else Policy.Reliability.BestEffort,
                   Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile, Policy.History.KeepLast(1000))

    def subscribe(self, topic, kind, latched=False):
        """A reader: take() gives its messages."""
        return DataReader(self.participant, self._topic("rt" + topic, kind), qos=self._qos(latched))

    def advertise(self, topic, kind):
        """A function that publishes a message, given as a dictionary."""
        writer = DataWriter(self.participant, self._topic("rt" + topic, kind), qos=self._qos())
        return lambda **values: writer.write(filled(self.types[kind], values))

    def call(self, service, kind, timeout=10.0, **values):
        """The response of a service; TimeoutError: nobody answers."""
        end = time.monotonic() + timeout
        if service not in self.clients:
            self.clients[service] = (
                DataWriter(self.participant, self._topic("rq" + service + "Request", kind, "_Request"), qos=self._qos()),
                DataReader(self.participant, self._topic("rr" + service + "Reply", kind, "_Response"), qos=self._qos()))
        writer, reader = self.clients[service]
        while not (writer.get_matched_subscriptions() and reader.get_matched_publications()):
            if time.monotonic() > end:
                raise TimeoutError("nobody serves " + service)
            time.sleep(0.02)
        self.calls += 1
        client = hash(self) & (2**63 - 1)
        writer.write(filled(self.types[kind + "_Request"], {"client_number_": client, "request_number_": self.calls, **values}))
        while time.monotonic() < end:
            for answer in reader.take(N=100):
                if (answer.client_number_, answer.request_number_) == (client, self.calls):
                    return answer
            time.sleep(0.002)
        raise TimeoutError("no answer of " + service)


def main():
    idl, topic, kind = sys.argv[1:4]
    node = Node(idl, int(os.environ.get("ROS_DOMAIN_ID", 0)))
    reader = node.subscribe(topic, kind)
    while True:
        for message in reader.take(N=100):
            print(message, flush=True)
        time.sleep(0.01)


if __name__ == "__main__":
    main()
