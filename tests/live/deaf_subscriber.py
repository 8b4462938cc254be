"""deaf_subscriber.py MASTER TOPIC TYPE MD5: subscribes to a topic of ROS 1, connects, and never reads what
comes. Prints "deaf" once it is connected."""

import socket
import struct
import sys
import threading
import time
import xmlrpc.client
import xmlrpc.server

master, topic, kind, md5 = sys.argv[1:]
publishers = []


class Slave:
    """What a master and publishers ask of a node."""

    def publisherUpdate(self, caller, of, uris):
        publishers.extend(uris)
        return [1, "", 0]

    def getPid(self, caller):
        return [1, "", 1]


server = xmlrpc.server.SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False)
server.register_instance(Slave())
threading.Thread(target=server.serve_forever, daemon=True).start()
uri = "http://127.0.0.1:%d/" % server.server_address[1]
found = xmlrpc.client.ServerProxy(master).registerSubscriber("/deaf", topic, kind, uri)[2]
publishers.extend(found)
while not publishers:
    time.sleep(0.02)
_, host, port = xmlrpc.client.ServerProxy(publishers[0]).requestTopic("/deaf", topic, [["TCPROS"]])[2]
fields = ["callerid=/deaf", "topic=" + topic, "type=" + kind, "md5sum=" + md5]
header = b"".join(struct.pack("<I", len(f)) + f.encode() for f in fields)
connection = socket.socket()
connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
connection.connect((host, port))
connection.sendall(struct.pack("<I", len(header)) + header)
print("deaf", flush=True)
time.sleep(1000)
