"""bad_master.py MODE PORT: a ROS 1 master that misbehaves. Prints "ready" when it listens.

garbage   answers every request with bytes that are no HTTP
closes    takes a request and closes the connection
stalls    takes a request and never answers
nested    answers with an array in an array, 200,000 deep
wrong     answers with a text where the Master API has a list of three
numbers   answers with 1, also where a list or a parameter is asked for
endless   states two gigabytes and goes on sending
attacks   is a master, and sends such an array to each node that registers
stalls-later  is a master for as long as the file "FILE" (third argument) is not there; then it stalls
"""

import os
import socket
import sys
import threading
import time
import xmlrpc.client

mode, port = sys.argv[1], int(sys.argv[2])


def read_request(connection):
    data = b""
    while b"\r\n\r\n" not in data:
        more = connection.recv(65536)
        if not more:
            return None
        data += more
    head, body = data.split(b"\r\n\r\n", 1)
    length = [int(line.split(b":")[1]) for line in head.split(b"\r\n") if line.lower().startswith(b"content-length")]
    while len(body) < length[0]:
        body += connection.recv(65536)
    return body


def http(body, length=None):
    head = "HTTP/1.1 200 OK\r\nContent-Type: text/xml\r\nContent-Length: %d\r\n\r\n" % (length or len(body))
    return head.encode() + body


def deep(around):
    inner = b"<value><array><data>" * 200000 + b"</data></array></value>" * 200000
    return b"<?xml version='1.0'?>" + around[0] + b"<params><param>" + inner + b"</param></params>" + around[1]


def attack(uri):
    body = deep((b"<methodCall><methodName>getPid</methodName>", b"</methodCall>"))
    host, port = uri.split("/")[2].split(":")
    with socket.create_connection((host, int(port))) as node:
        node.sendall(b"POST / HTTP/1.1\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
        node.settimeout(5)
        node.recv(1000)
    print("attacked", flush=True)


def proper(body):
    arguments, method = xmlrpc.client.loads(body)
    if mode == "attacks" and method == "registerPublisher":
        threading.Thread(target=attack, args=(arguments[3],), daemon=True).start()
    payload = 1
    if mode != "numbers" and method in ("registerSubscriber", "registerPublisher"):
        payload = []
    if mode != "numbers" and method == "subscribeParam":
        payload = {}
    if mode != "numbers" and method == "hasParam":
        payload = False
    status = -1 if mode != "numbers" and method == "getParam" else 1  # no parameter is set
    return http(xmlrpc.client.dumps(([status, "", payload],), methodresponse=True).encode())


def answer(connection):
    if mode == "garbage":
        connection.sendall(bytes(range(256)) * 64)
    elif mode == "nested":
        connection.sendall(http(deep((b"<methodResponse>", b"</methodResponse>"))))
    elif mode == "wrong":
        connection.sendall(http(xmlrpc.client.dumps(("no list",), methodresponse=True).encode()))
    elif mode == "endless":
        connection.sendall(http(b"<?xml version='1.0'?>", 2000000000))
        while True:
            connection.sendall(b" " * 4096)
            time.sleep(0.01)
    elif mode == "stalls":
        time.sleep(1000)


def serve(connection):
    try:
        while True:
            body = read_request(connection)
            if body is None or mode == "closes":
                break
            if mode not in ("stalls-later", "numbers", "attacks"):
                answer(connection)
                break
            while mode == "stalls-later" and os.path.exists(sys.argv[3]):
                time.sleep(1)
            connection.sendall(proper(body))
    except OSError:
        pass
    connection.close()


listener = socket.create_server(("127.0.0.1", port))
print("ready", flush=True)
while True:
    threading.Thread(target=serve, args=(listener.accept()[0],), daemon=True).start()
